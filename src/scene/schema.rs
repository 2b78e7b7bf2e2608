//! The words of a scene file: one Rust type for each, read by serde. SI units throughout (m, kg, s, Pa).

pub use crate::mesh::ElementKind;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A whole scene.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// What the scene shows, in a few words.
    #[serde(default)]
    pub title: String,
    /// Simulated time (s).
    pub duration: f64,
    /// The bodies, by name.
    pub bodies: BTreeMap<String, Body>,
    /// The materials, by name.
    pub materials: BTreeMap<String, Material>,
    /// What holds or moves nodes.
    #[serde(default)]
    pub constraints: Vec<Constraint>,
    /// What pushes and pulls.
    #[serde(default)]
    pub loads: Vec<Load>,
    /// Which elements go, and when.
    #[serde(default)]
    pub removal: Vec<Removal>,
    /// What to observe, by name.
    #[serde(default)]
    pub probes: BTreeMap<String, Probe>,
    /// The time step and how it is taken.
    #[serde(default)]
    pub integration: Integration,
    /// Systems in the order they run in each step; left out, it is derived from what the scene contains.
    #[serde(default)]
    pub schedule: Option<Vec<String>>,
    /// Parameters of custom systems, by the system's name.
    #[serde(default)]
    pub parameters: BTreeMap<String, ron::Value>,
    /// What is written, and how often.
    #[serde(default)]
    pub output: Output,
    /// How `sinew render` draws the scene.
    #[serde(default)]
    pub picture: Picture,
}

/// A body: a mesh, what it is made of, where it is and how it starts.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Where the mesh comes from.
    pub mesh: MeshSource,
    /// The name of the material of all elements that `regions` does not name.
    pub material: String,
    /// Parts made of another material; a later entry wins.
    #[serde(default)]
    pub regions: Vec<Region>,
    /// Multiplies all coordinates of the mesh, before anything else (1 = metres).
    #[serde(default = "one")]
    pub scale: f64,
    /// Turns the mesh about the axes x, then y, then z through the origin (degrees).
    #[serde(default)]
    pub rotate: DVec3,
    /// Moves the mesh (m), after scale and rotation.
    #[serde(default)]
    pub translate: DVec3,
    /// Velocity at the start (m/s).
    #[serde(default)]
    pub velocity: DVec3,
    /// Angular velocity at the start about the centre of mass (rad/s).
    #[serde(default)]
    pub spin: DVec3,
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
    },
    /// A cuboid with one corner in the origin.
    Box {
        /// Edge lengths (m).
        size: DVec3,
        /// Cells along each edge; a cell is one hexahedron or six tetrahedra.
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

/// A material: a density and the effects it has. An effect that is not named does not exist.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Density at rest (kg/m³).
    pub density: f64,
    /// Isotropic elasticity; every material needs an elastic law, and this is the one there is.
    #[serde(default)]
    pub neo_hookean: Option<NeoHookean>,
    /// Fibres in one direction (transverse isotropy).
    #[serde(default)]
    pub fibres: Option<Fibres>,
    /// Viscosity of the isochoric stress.
    #[serde(default)]
    pub prony: Option<Prony>,
    /// Mass-proportional damping: rate c of the force -c M v (1/s).
    #[serde(default)]
    pub damping: Option<f64>,
}

/// Moduli of the neo-Hookean law, as one of two pairs.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum NeoHookean {
    /// Young's modulus (Pa) and Poisson's ratio, both of small strains.
    Young {
        /// Young's modulus (Pa).
        young: f64,
        /// Poisson's ratio, below 1/2.
        poisson: f64,
    },
    /// Shear modulus and bulk modulus.
    Moduli {
        /// Shear modulus μ (Pa).
        shear: f64,
        /// Bulk modulus κ (Pa).
        bulk: f64,
    },
}

/// Fibres: Ψ = η/2 (Ī₄ − 1)², the η of Comas et al. 2008 (other codes mean 2η by the same letter).
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Fibres {
    /// Stiffness η (Pa).
    pub eta: f64,
    /// The direction at rest.
    pub direction: Direction,
    /// Whether fibres push back when compressed (as in the paper), or only pull.
    #[serde(default)]
    pub tension_only: bool,
}

/// A direction in the body at rest; its length does not matter.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Direction {
    /// The same everywhere.
    Along(f64, f64, f64),
    /// Around an axis through a point: circular fibres.
    Around {
        /// A point on the axis (m).
        #[serde(default)]
        center: DVec3,
        /// The direction of the axis.
        axis: DVec3,
    },
    /// One direction an element, from the cell data of that name in the mesh file.
    Field(String),
}

/// Viscosity: relaxation of the isochoric stress in exponentials.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Prony {
    /// The terms: share α of the instantaneous stress that relaxes with time τ (s).
    pub terms: Vec<PronyTerm>,
    /// How the history is carried on.
    #[serde(default)]
    pub integrator: ViscousIntegrator,
}

/// One exponential of a [`Prony`] series.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct PronyTerm {
    /// Share of the instantaneous stress that relaxes, 0 ≤ α; all together below 1.
    pub alpha: f64,
    /// Relaxation time τ (s).
    pub tau: f64,
}

/// How viscous history is carried from step to step.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
pub enum ViscousIntegrator {
    /// Exact for a stress that is linear within a step; second order.
    #[default]
    Exact,
    /// The paper's eq. 4; first order.
    BackwardEuler,
}

/// What holds or moves nodes.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Constraint {
    /// Nodes that do not move along the given axes.
    Fixed {
        /// The body; may be left out when there is one only.
        #[serde(default)]
        body: Option<String>,
        /// Which nodes.
        on: Select,
        /// Along which axes.
        #[serde(default = "all_axes")]
        axes: Vec<Axis>,
    },
    /// Nodes that move as told along the given axes:
    /// displacement + gradient·(X − center) + (R(rotation) − 1)(X − center), all three multiplied by the curve
    /// (of the rotation its angle).
    Prescribed {
        /// The body; may be left out when there is one only.
        #[serde(default)]
        body: Option<String>,
        /// Which nodes.
        on: Select,
        /// Along which axes.
        #[serde(default = "all_axes")]
        axes: Vec<Axis>,
        /// A common displacement (m).
        #[serde(default)]
        displacement: DVec3,
        /// Rows of a displacement gradient.
        #[serde(default)]
        gradient: [DVec3; 3],
        /// A rotation about `center`: axis times angle (degrees).
        #[serde(default)]
        rotation: DVec3,
        /// The fixed point of gradient and rotation (m).
        #[serde(default)]
        center: DVec3,
        /// Course in time.
        #[serde(default)]
        curve: Curve,
    },
}

/// A coordinate axis.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Axis {
    X,
    Y,
    Z,
}

/// What pushes and pulls.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Load {
    /// Gravity on one body, or on all.
    Gravity {
        /// The body; left out: all.
        #[serde(default)]
        body: Option<String>,
        /// Acceleration (m/s²).
        acceleration: DVec3,
        /// Course in time.
        #[serde(default)]
        curve: Curve,
    },
    /// A force on nodes.
    NodalForce {
        /// The body; may be left out when there is one only.
        #[serde(default)]
        body: Option<String>,
        /// Which nodes.
        on: Select,
        /// Force (N).
        force: DVec3,
        /// Whether each node gets the force, or all together.
        #[serde(default)]
        share: Share,
        /// Course in time.
        #[serde(default)]
        curve: Curve,
    },
    /// A pressure that follows the surface and pushes inwards.
    Pressure {
        /// The body; may be left out when there is one only.
        #[serde(default)]
        body: Option<String>,
        /// Which faces of the surface.
        on: Select,
        /// Pressure (Pa), positive inwards.
        pressure: f64,
        /// Course in time.
        #[serde(default)]
        curve: Curve,
    },
    /// A dead load: force per rest area in a fixed direction.
    Traction {
        /// The body; may be left out when there is one only.
        #[serde(default)]
        body: Option<String>,
        /// Which faces of the surface.
        on: Select,
        /// Force per rest area (Pa).
        traction: DVec3,
        /// Course in time.
        #[serde(default)]
        curve: Curve,
    },
}

/// How a force is shared among nodes.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
pub enum Share {
    /// Each node gets it.
    #[default]
    Each,
    /// All nodes together get it, in equal parts.
    Total,
}

/// A factor over time; what it multiplies is said where it is used.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Curve {
    /// 1 from `start` until `end`, else 0 (s).
    Step {
        /// First instant (s).
        #[serde(default)]
        start: f64,
        /// From then on 0 again (s).
        #[serde(default)]
        end: Option<f64>,
    },
    /// A straight line from 0 at `start` to 1 at `end`, held after (s).
    Ramp {
        /// 0 until then (s).
        #[serde(default)]
        start: f64,
        /// 1 from then on (s).
        end: f64,
    },
    /// As `Ramp`, by the 3-4-5 polynomial 10s³ − 15s⁴ + 6s⁵: no jump of velocity or acceleration.
    Smooth {
        /// 0 until then (s).
        #[serde(default)]
        start: f64,
        /// 1 from then on (s).
        end: f64,
    },
    /// Straight lines through (time (s), factor), held before the first and after the last.
    Table(Vec<(f64, f64)>),
}

impl Default for Curve {
    fn default() -> Self {
        Curve::Step { start: 0.0, end: None }
    }
}

/// Which nodes, faces or elements of a body at rest, by place, name or number. Faces count when all their nodes do,
/// elements when their centroid does.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum Select {
    /// Everything.
    All,
    /// A named set of the mesh (a physical group).
    Set(String),
    /// The plane of all points with normal·X = at.
    Plane {
        /// The plane's normal; its length does not matter.
        normal: DVec3,
        /// Distance from the origin along the normal (m).
        at: f64,
        /// How far off the plane a point may lie (m); 1e-6 of the body's size when left out.
        #[serde(default)]
        tolerance: Option<f64>,
    },
    /// An axis-parallel box, its walls included.
    Box {
        /// Lower corner (m).
        min: DVec3,
        /// Upper corner (m).
        max: DVec3,
    },
    /// A ball, its surface included.
    Sphere {
        /// Centre (m).
        center: DVec3,
        /// Radius (m).
        radius: f64,
    },
    /// Faces of the surface whose outward normal at rest lies within an angle of a direction, and their nodes.
    Surface {
        /// The direction; left out: the whole surface.
        #[serde(default)]
        normal: Option<DVec3>,
        /// The largest angle (degrees).
        #[serde(default = "thirty")]
        within: f64,
    },
    /// Nodes by the author's numbers.
    Nodes(Vec<u64>),
    /// Elements by the author's numbers.
    Elements(Vec<u64>),
    /// What is in all of these.
    And(Vec<Select>),
    /// What is in any of these.
    Or(Vec<Select>),
    /// What is not in this.
    Not(Box<Select>),
}

/// Elements to be removed.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Removal {
    /// The body; may be left out when there is one only.
    #[serde(default)]
    pub body: Option<String>,
    /// Which elements may go.
    #[serde(default = "everything")]
    pub on: Select,
    /// When they go.
    pub when: When,
}

/// When elements are removed.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum When {
    /// All at one time (s).
    At(f64),
    /// One after the other between two times (s), those nearest to the selection's centroid first.
    During {
        /// The first goes (s).
        start: f64,
        /// The last has gone (s).
        end: f64,
    },
    /// Each as soon as its largest principal stretch exceeds this.
    StretchAbove(f64),
    /// Each as soon as its volume ratio J falls below this.
    VolumeRatioBelow(f64),
    /// Each as soon as its volume ratio J exceeds this.
    VolumeRatioAbove(f64),
    /// Each as soon as its strain energy per rest volume exceeds this (J/m³).
    EnergyDensityAbove(f64),
}

/// One thing to observe: what, where, how often (s; every output of fields when left out).
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// The body; may be left out when there is one only.
    #[serde(default)]
    pub body: Option<String>,
    /// What to observe.
    pub what: Quantity,
    /// On which nodes or elements.
    pub on: Select,
    /// Time between observations (s).
    #[serde(default)]
    pub every: Option<f64>,
}

/// What a probe observes.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
pub enum Quantity {
    /// Mean displacement of the nodes (m).
    Displacement,
    /// Mean position of the nodes (m).
    Position,
    /// Mean velocity of the nodes (m/s), in the middle of the step that led there.
    Velocity,
    /// What holds the nodes: the sum of internal less external forces (N).
    Reaction,
    /// Volume mean of the Cauchy stress of the elements: xx, yy, zz, xy, yz, xz (Pa).
    Stress,
    /// Volume mean of the volume ratio J of the elements.
    VolumeRatio,
}

/// The time step and how it is taken.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Integration {
    /// The step (s); left out: the stable step times `safety`.
    pub step: Option<f64>,
    /// Share of the stable step that is taken.
    pub safety: f64,
    /// Take a `step` beyond the stable one all the same.
    pub beyond_stable_step: bool,
    /// Sum displacements with compensation: three numbers a node more, and f32 keeps the digits that plain sums lose.
    pub compensated: bool,
}

impl Default for Integration {
    fn default() -> Self {
        Self { step: None, safety: 0.9, beyond_stable_step: false, compensated: true }
    }
}

/// What is written, and how often.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Time between VTU files (s); a twentieth of the duration when left out.
    pub fields_every: Option<f64>,
    /// Time between rows of `energy.csv` (s). Naming it also books the work of all forces in every step.
    pub energies_every: Option<f64>,
}

/// How a scene is drawn.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Picture {
    /// The field that gives the colour.
    pub field: Field,
    /// Where the eye stands, seen from the middle of the scene.
    pub from: DVec3,
    /// Width and height (pixels).
    pub size: (u32, u32),
}

impl Default for Picture {
    fn default() -> Self {
        Self { field: Field::Displacement, from: DVec3::new(1.0, -2.0, 0.8), size: (960, 720) }
    }
}

/// A field to colour by.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
pub enum Field {
    /// Length of the displacement (m).
    Displacement,
    /// Length of the velocity (m/s).
    Speed,
    /// von Mises stress (Pa).
    VonMises,
    /// Pressure, the negative mean stress (Pa).
    Pressure,
    /// Volume ratio J.
    VolumeRatio,
}

fn one() -> f64 {
    1.0
}

fn thirty() -> f64 {
    30.0
}

fn all_axes() -> Vec<Axis> {
    vec![Axis::X, Axis::Y, Axis::Z]
}

fn everything() -> Select {
    Select::All
}

impl Scene {
    /// Time between outputs of fields (s).
    pub fn fields_every(&self) -> f64 {
        self.output.fields_every.unwrap_or(self.duration / 20.0)
    }
}
