//! Meshes made from a few numbers: one file a shape.
//!
//! All of them deform a grid of cells; a cell is one hexahedron, two wedges or six tetrahedra. Points run along x
//! fastest, then y, then z; middles of edges follow them, in the order of the elements. The elements of a cell follow
//! each other.

mod r#box;
mod cylinder;
mod ellipsoid;
mod grid;
mod hexahedron;
mod lens;
mod round;
mod tube;

pub use r#box::box_mesh;
pub use cylinder::cylinder_mesh;
pub use ellipsoid::ellipsoid_mesh;
pub use hexahedron::hexahedron_mesh;
pub use lens::lens_mesh;
#[doc(hidden)]
pub use tube::cells_around;
pub use tube::tube_mesh;

use super::{CellKind, MeshError};
use serde::{Deserialize, Serialize};

/// Hands the list of element types to a macro, behind a `$` for macros that make macros: stem of its file, name, kind
/// of cells, and stem of the shader.
#[doc(hidden)]
#[macro_export]
macro_rules! each_element_kind {
    ($dollar:tt $then:ident) => {
        $then! {
            $dollar
            /// Four-node tetrahedra: quick, and stiff near incompressibility (locking).
            #[default]
            tet4: Tet4 of Tet4, "tet4";
            /// Four-node tetrahedra with averaged nodal pressure: they hardly lock.
            tet4_nodal_pressure: Tet4NodalPressure of Tet4, "tet4";
            /// Eight-node hexahedra with one point and hourglass control: quick, and they do not lock.
            hex8: Hex8 of Hex8, "hex8";
            /// Eight-node hexahedra with eight points and mean dilatation: accurate, and slower.
            hex8_mean_dilatation: Hex8MeanDilatation of Hex8, "hex8_mean_dilatation";
            /// Six-node wedges with six points and mean dilatation: what meshes of layers are made of.
            wedge6: Wedge6 of Wedge6, "wedge6";
            /// Ten-node tetrahedra with four points and mean dilatation: accurate on meshes of tetrahedra.
            tet10: Tet10 of Tet10, "tet10";
        }
    };
}

macro_rules! element_kinds {
    ($dollar:tt $($(#[$about:meta])* $file:ident: $kind:ident of $cell:ident, $shader:literal;)*) => {
        /// Kinds of elements. Generators make six tetrahedra, two wedges or one hexahedron of a cell.
        #[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq, PartialOrd, Ord)]
        pub enum ElementKind {
            $($(#[$about])* $kind,)*
        }

        impl ElementKind {
            /// All kinds.
            pub const ALL: [ElementKind; [$(ElementKind::$kind),*].len()] = [$(ElementKind::$kind),*];

            /// Its word in scenes.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$kind => stringify!($kind),)*
                }
            }

            /// The kind of its cells.
            pub const fn cell(self) -> CellKind {
                match self {
                    $(Self::$kind => CellKind::$cell,)*
                }
            }
        }
    };
}
each_element_kind! { $ element_kinds }

impl ElementKind {
    /// How many of them generators make of a cell of their grid; none where they cannot.
    pub fn a_cell(self) -> Option<u32> {
        let parts = self.cell().topology().solid.map_or(0, |solid| solid.in_cube.len());
        (parts > 0).then_some(parts as u32)
    }
}

/// Refuses a length that is not a positive number.
fn positive(name: &'static str, parameter: &'static str, value: f64) -> Result<(), MeshError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    let allowed = "it must be a finite length above 0 m".to_string();
    Err(MeshError::Parameter { name, parameter, value: format!("{value}"), allowed })
}
