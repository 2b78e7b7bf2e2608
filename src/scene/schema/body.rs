//! Bodies and their meshes.

use super::{ElementKind, PerCopy, Select};
use crate::mesh::CellKind;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A body: a mesh, what it is made of, where it is and how it starts.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Where the mesh comes from.
    pub mesh: MeshSource,
    /// A mesh file with the same points and elements that says where they are at rest (m), its path relative to the
    /// scene file; `mesh` is then a loaded shape, in which selections are made and places of attachments are.
    #[serde(default)]
    pub rest_shape: Option<String>,
    /// The name of the material of all elements that `regions` does not name.
    pub material: String,
    /// Parts made of another material; a later entry wins.
    #[serde(default)]
    pub regions: Vec<Region>,
    /// Cuts every element of the mesh into eight, so many times over.
    #[serde(default)]
    pub refine: u32,
    /// Multiplies all coordinates of the mesh, before anything else (1 = metres).
    #[serde(default = "one")]
    pub scale: f64,
    /// Turns the mesh about the axes x, then y, then z through the origin (degrees).
    #[serde(default)]
    pub rotate: DVec3,
    /// Moves the mesh (m), after scale and rotation.
    #[serde(default)]
    pub translate: DVec3,
    /// How many copies of the mesh there are, which share nothing: many small bodies at the cost of one large one.
    #[serde(default = "single")]
    pub copies: u32,
    /// How far each copy stands from the one before (m); they may stand in the same place.
    #[serde(default)]
    pub apart: DVec3,
    /// Parameters of its materials that differ from copy to copy, by their places under `materials`:
    /// "tissue.neo_hookean.young".
    #[serde(default)]
    pub per_copy: BTreeMap<String, PerCopy>,
    /// Velocity at the start (m/s).
    #[serde(default)]
    pub velocity: DVec3,
    /// Angular velocity at the start about the centre of mass (rad/s).
    #[serde(default)]
    pub spin: DVec3,
    /// A fine surface that the mesh carries, for pictures.
    #[serde(default)]
    pub skin: Option<SkinFile>,
    /// How the body is deformed at the start, at rest and let go; nodes keep their place along axes that are held or
    /// moved.
    #[serde(default)]
    pub start: Option<Start>,
    /// Multiplies the hourglass stiffness of one-point hexahedra, and what holds the volume at the points of ten-node
    /// tetrahedra to their mean; 0 leaves their hourglass modes free.
    #[serde(default = "one")]
    pub hourglass: f64,
}

impl Body {
    /// The names of the materials that its elements may have.
    pub fn materials(&self) -> impl Iterator<Item = &str> {
        std::iter::once(&self.material).chain(self.regions.iter().map(|region| &region.material)).map(String::as_str)
    }
}

/// A fine surface that a body's mesh carries: it stands where the mesh does, and is scaled, turned and moved with it.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct SkinFile {
    /// The file (STL, OBJ, PLY or glTF), its path relative to the scene file.
    pub file: String,
    /// What its coordinates are multiplied with to be those of the mesh.
    #[serde(default = "one")]
    pub scale: f64,
    /// A picture (PNG) that the viewer puts on it, at its texture coordinates; its path relative to the scene file.
    #[serde(default)]
    pub image: Option<String>,
    /// A further format for the skin's series, for programs that read no VTU files.
    #[serde(default)]
    pub also: Option<SkinFormat>,
}

/// A format for the series of a skin, beside VTU.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
pub enum SkinFormat {
    /// PLY files, binary, one a frame.
    Ply,
    /// OBJ files, one a frame.
    Obj,
}

impl SkinFormat {
    /// How the names of its files end.
    pub fn ending(self) -> &'static str {
        match self {
            SkinFormat::Ply => "ply",
            SkinFormat::Obj => "obj",
        }
    }
}

fn single() -> u32 {
    1
}

/// A deformation that a run starts from.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Start {
    /// The same everywhere: u = gradient·(X − center). ((0, 0, 0), (0, 0, 0), (0, 0, -1)) flattens along z.
    Affine {
        /// Rows of the displacement gradient.
        gradient: [DVec3; 3],
        /// What stays in place (m).
        #[serde(default)]
        center: DVec3,
    },
    /// Each component of each node's displacement anywhere between −amplitude and amplitude, the same in every run.
    Scrambled {
        /// The largest displacement along an axis (m).
        amplitude: f64,
        /// Another number, another disorder.
        #[serde(default)]
        seed: u64,
    },
}

/// Elements of a body made of another material.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// Which elements.
    pub on: Select,
    /// The name of their material.
    pub material: String,
}

/// A mesh file, or a generator with its parameters.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum MeshSource {
    /// A Gmsh (.msh), legacy VTK (.vtk) or VTU (.vtu) file, its path relative to the scene file.
    File {
        /// The path.
        path: String,
        /// Turn inverted elements the right way round instead of refusing the mesh.
        #[serde(default)]
        flip_inverted: bool,
        /// What tetrahedra are taken for.
        #[serde(default = "tet4")]
        tets: ElementKind,
        /// What hexahedra are taken for.
        #[serde(default = "hex8")]
        hexes: ElementKind,
    },
    /// A cuboid with one corner in the origin.
    Box {
        /// Edge lengths (m).
        size: DVec3,
        /// Cells along each edge; a cell is one hexahedron, two wedges or six tetrahedra.
        cells: (u32, u32, u32),
        /// The kind of elements.
        #[serde(default)]
        elements: ElementKind,
    },
    /// A cylinder about the z axis that stands on z = 0.
    Cylinder {
        /// Radius (m).
        radius: f64,
        /// Height (m).
        height: f64,
        /// Cells across the diameter.
        across: u32,
        /// Cells along the axis.
        along: u32,
        /// The kind of elements.
        #[serde(default)]
        elements: ElementKind,
    },
    /// An ellipsoid about the origin.
    Ellipsoid {
        /// Half-axes (m).
        radii: DVec3,
        /// Cells across each axis.
        across: u32,
        /// The kind of elements.
        #[serde(default)]
        elements: ElementKind,
    },
    /// A block with eight corners: a box mapped trilinearly.
    Hexahedron {
        /// Four corners round the bottom, counter-clockwise seen from the top, then the four above them (m).
        corners: [DVec3; 8],
        /// Cells along the edges from corner 0 to corners 1, 3 and 4.
        cells: (u32, u32, u32),
        /// The kind of elements.
        #[serde(default)]
        elements: ElementKind,
    },
    /// A thick-walled tube about the z axis that stands on z = 0, or a sector of it from the x axis on.
    Tube {
        /// Inner radius (m).
        inner: f64,
        /// Outer radius (m).
        outer: f64,
        /// Height (m).
        height: f64,
        /// How far round it goes (degrees); 360 closes the ring.
        #[serde(default = "full_turn")]
        angle: f64,
        /// Cells through the wall, around and along the axis.
        cells: (u32, u32, u32),
        /// The kind of elements.
        #[serde(default)]
        elements: ElementKind,
    },
    /// A biconvex lens about the origin, its axis along z: two spherical caps on a common circle.
    Lens {
        /// Diameter of the common circle (m).
        diameter: f64,
        /// Thickness on the axis (m).
        thickness: f64,
        /// Cells across the diameter.
        across: u32,
        /// Cells through the thickness.
        through: u32,
        /// The kind of elements.
        #[serde(default)]
        elements: ElementKind,
    },
}

impl MeshSource {
    /// What its cells are taken for: one kind of element a kind of cell.
    pub fn element_kinds(&self) -> impl Iterator<Item = ElementKind> + use<> {
        let (chosen, file) = match self {
            Self::File { tets, hexes, .. } => ([*tets, *hexes], true),
            Self::Box { elements, .. }
            | Self::Cylinder { elements, .. }
            | Self::Ellipsoid { elements, .. }
            | Self::Hexahedron { elements, .. }
            | Self::Tube { elements, .. }
            | Self::Lens { elements, .. } => ([*elements; 2], false),
        };
        // cells for which there is but one element need no word
        let others = ElementKind::ALL
            .into_iter()
            .filter(move |kind| file && ![CellKind::Tet4, CellKind::Hex8].contains(&kind.cell()));
        chosen.into_iter().take(if file { 2 } else { 1 }).chain(others)
    }

    /// What its cells of a kind are taken for; nothing where it has none.
    pub fn element_kind(&self, cell: CellKind) -> Option<ElementKind> {
        self.element_kinds().find(|kind| kind.cell() == cell)
    }
}

fn full_turn() -> f64 {
    360.0
}

fn one() -> f64 {
    1.0
}

fn tet4() -> ElementKind {
    ElementKind::Tet4
}

fn hex8() -> ElementKind {
    ElementKind::Hex8
}
