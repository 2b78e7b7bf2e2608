//! Finite elements: displacement gradients from nodal displacements, nodal forces from stress.
//!
//! An element is one Rust file with its WGSL twin of the same stem in `shaders/`, and one line of the list in
//! `crates/mesh/src/generators/mod.rs`.

mod hex8;
mod hex8_mean_dilatation;
mod kinds;
mod tet10;
mod tet4;
mod tet4_nodal_pressure;
mod wedge6;

pub use hex8::{Hexahedron, Parallelepiped};
pub use kinds::{
    ElementTask, averages, elements_a_patch, mass_shares, node_count, point_count, rounding, run_with_element,
};
pub(crate) use kinds::{with_element, with_element_of};

use crate::math::{Mat3, Real};
use crate::mesh::{CellKind, each_element_kind};
use glam::DVec3;

macro_rules! element_types {
    ($dollar:tt $($(#[$about:meta])* $file:ident: $kind:ident of $cell:ident, $shader:literal;)*) => {
        $(pub use $file::$kind;)*
    };
}
each_element_kind! { $ element_types }

/// Nodes of the element type that has most: kernels have room for so many.
pub const MOST_NODES: usize = 10;
/// Rest-shape numbers of the element type that has most.
pub const MOST_ROWS: usize = 32;
/// Integration points of the element type that has most.
pub const MOST_POINTS: usize = 8;

/// A kind of element.
///
/// What an element knows of its shape at rest is a column of [`ROWS`](Element::ROWS) numbers, made once in `f64`;
/// `shape` below gives them by row. Row [`VOLUME_ROW`](Element::VOLUME_ROW) is the rest volume (m³). All forces are
/// proportional to rows that removal can zero: an element whose volume and [`FORCE_ROW`](Element::FORCE_ROW) are zero
/// exerts nothing.
///
/// Forces are made in four strides: displacements are prepared, each integration point gives its gradient, stresses are
/// added point by point, and what they come to is stored corner by corner.
pub trait Element: Copy + Send + Sync + 'static {
    /// Its name in scenes, shaders and reports.
    const NAME: &'static str;
    /// The kind of its cells.
    const CELL: CellKind;
    /// How many nodes.
    const NODES: usize = Self::CELL.node_count();
    /// One over the least share of its mass that a node has: how many nodes there are where all have the same.
    const NODES_OF_LEAST_MASS: f64 = 1.0 / Self::CELL.least_share();
    /// How many integration points.
    const POINTS: usize;
    /// Points at which J is checked, the integration points first: where edges can be curved an element can be folded
    /// as a whole while none of these sees it. The others have no weight.
    const CHECKED_POINTS: usize = Self::POINTS;
    /// How many numbers describe the rest shape.
    const ROWS: usize;
    /// Which of them is the volume.
    const VOLUME_ROW: usize;
    /// Which further number forces are proportional to, if any.
    const FORCE_ROW: Option<usize>;
    /// Where the pressure comes from.
    const PRESSURE: PressureFrom;

    /// How many times as much of the residual rounding may leave as a node's stiffness says, as against elements whose
    /// points are not balanced against each other.
    const ROUNDING: f64 = 1.0;
    /// Elements of a patch: enough to be worth a task, few enough that their nodes and forces stay in a core's cache.
    const ELEMENTS_A_PATCH: usize = 224;
    /// Whether the CPU has kernels in f32 of its own for what is asked for most, beside the one that asks the law for
    /// each effect at each point. They take most of the time of compiling, so only kinds whose speed was measured with
    /// and without have them.
    const SPECIALISED: bool = false;

    /// The same element for simple shapes, of which fewer numbers need be known: what a block is made of if it
    /// [describes](Element::describes) all its elements. Itself, if there are none such.
    type Specialisation: Element;
    /// What all points need of the displacements.
    type Prepared<R: Real>: Copy;
    /// What stresses add up to before it is spread over the corners.
    type Forces<R: Real>: Copy;

    /// The rest shape from the nodes' rest positions (m); `young` is the small-strain Young's modulus (Pa) that
    /// hourglass control is scaled by.
    fn rest_shape(points: &[DVec3], young: f64) -> [f64; MOST_ROWS];

    /// Two edges at rest that frame it, or sums of its edges (m). `None` of element types that no frame is made for.
    fn frame(_points: &[DVec3]) -> Option<[DVec3; 2]> {
        None
    }

    /// Whether it can have that shape: the nodes' rest positions (m).
    fn describes(_points: &[DVec3]) -> bool {
        true
    }

    /// Makes nodal displacements (m) ready.
    fn prepare<R: Real>(u: &[[R; 3]; MOST_NODES]) -> Self::Prepared<R>;

    /// The state at an integration point.
    fn at_point<R: Real>(u: &Self::Prepared<R>, point: usize, shape: impl Fn(usize) -> R) -> PointState<R>;

    /// No forces yet.
    fn no_forces<R: Real>(like: R) -> Self::Forces<R>;

    /// Adds what the first Piola-Kirchhoff stress (Pa) at a point exerts.
    fn add_stress<R: Real>(forces: &mut Self::Forces<R>, point: usize, at: &PointState<R>, stress: &Mat3<R>);

    /// Nodal forces (N) that the element exerts against its deformation, hourglass control included.
    /// They go to `store` (corner, component, force) one component after the other: so few numbers are needed at a time
    /// that they fit into registers.
    fn store_forces<R: Real>(
        u: &Self::Prepared<R>,
        forces: &Self::Forces<R>,
        shape: impl Fn(usize) -> R,
        store: impl FnMut(usize, usize, R),
    );

    /// Energy (J) in the hourglass control, for the gradient at the only point.
    fn hourglass_energy<R: Real>(u: &Self::Prepared<R>, gradient: &Mat3<R>, shape: impl Fn(usize) -> R) -> R;

    /// Upper bound of the largest squared angular frequency (1/s²) of the free element with lumped mass.
    ///
    /// ω² ≤ (n/ρ)(λ tr G + 2μ' λ_max(G)), G = Σ g gᵀ, n as in [`NODES_OF_LEAST_MASS`](Element::NODES_OF_LEAST_MASS): no
    /// node has less than m/n; λ, μ' and ρ as [`Stiffness`] has them; plus what the hourglass control adds. Where nodes
    /// have different shares s of the mass, g/√s stands for √n g. Rigorous at rest; stretch raises the true value by
    /// about 1/σ_min(F)², and by J² times that where the volume grows.
    fn frequency_bound(shape: &[f64; MOST_ROWS], stiffness: &Stiffness) -> f64;
}

/// Where an element's pressure comes from: constraining the volume at too many points locks an element as ν → ½.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PressureFrom {
    /// From the volume at its only point.
    Point,
    /// From the mean volume over all its points.
    MeanOverPoints,
    /// From the mean volume around each of its nodes: the system `nodal_volume` has to run before.
    Nodes,
}

/// An element at one of its integration points.
#[derive(Clone, Copy, Debug)]
pub struct PointState<R> {
    /// ∇u; rows: components, columns: coordinates.
    pub gradient: Mat3<R>,
    /// det(∂X/∂ξ) (∂X/∂ξ)⁻¹ (m²), where stresses are added up in natural coordinates; else meaningless.
    pub adjugate: Mat3<R>,
    /// The point's share of the rest volume (m³), also of an element that has been removed.
    pub volume: R,
}

/// Three numbers of a rest shape, from a row on.
#[inline(always)]
fn vector<R: Real>(shape: &impl Fn(usize) -> R, row: usize) -> [R; 3] {
    [shape(row), shape(row + 1), shape(row + 2)]
}

/// What the stable step depends on.
#[derive(Clone, Copy, Debug)]
pub struct Stiffness {
    /// First Lamé modulus (Pa).
    pub lambda: f64,
    /// Shear modulus μ (Pa).
    pub shear: f64,
    /// η of all fibres (Pa).
    pub eta: f64,
    /// Density (kg/m³).
    pub density: f64,
}

impl Stiffness {
    /// 2μ + 8η/3 (Pa): of all that changes shape.
    pub fn deviatoric(&self) -> f64 {
        2.0 * self.shear + 8.0 / 3.0 * self.eta
    }
}

/// tr G and the largest eigenvalue of G = Σ g gᵀ, rigorously from above (by Frobenius norm and trace).
pub(crate) fn gradient_measure(gradients: impl Iterator<Item = DVec3>) -> (f64, f64) {
    let mut g = glam::DMat3::ZERO;
    for v in gradients {
        g += glam::DMat3::from_cols(v * v.x, v * v.y, v * v.z);
    }
    let trace = g.x_axis.x + g.y_axis.y + g.z_axis.z;
    (trace, largest_eigenvalue(&g))
}

/// Largest eigenvalue of a symmetric matrix, by the trigonometric formula (Smith 1961).
pub fn largest_eigenvalue(g: &glam::DMat3) -> f64 {
    let mean = (g.x_axis.x + g.y_axis.y + g.z_axis.z) / 3.0;
    let deviator = *g - glam::DMat3::from_diagonal(DVec3::splat(mean));
    let square = deviator.x_axis.length_squared() + deviator.y_axis.length_squared() + deviator.z_axis.length_squared();
    let p = (square / 6.0).sqrt();
    if p <= f64::MIN_POSITIVE {
        return mean;
    }
    let r = ((deviator * (1.0 / p)).determinant() / 2.0).clamp(-1.0, 1.0);
    mean + 2.0 * p * (r.acos() / 3.0).cos()
}
