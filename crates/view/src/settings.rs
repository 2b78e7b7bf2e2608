//! What the user has chosen to see.

use glam::Vec3;
use sinew::scene::schema::OutputField;
use sinew_pictures::render::{Known, known};

/// What is seen and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// What colours surfaces; tissue where there is none.
    pub field: Option<OutputField>,
    /// Which of the field's numbers: 0 is the length of a vector or the first, then each by itself.
    pub component: usize,
    /// The values at the ends of the colours; those that are seen when left out.
    pub range: Option<(f32, f32)>,
    /// So many times their displacement bodies are drawn from where they rest.
    pub deformation: f32,
    /// Edges of elements.
    pub wireframe: bool,
    /// Nodes as points.
    pub nodes: bool,
    /// The shape at rest.
    pub ghost: bool,
    /// The field whose vectors are drawn as arrows.
    pub arrows: Option<OutputField>,
    /// What is fixed or moved as told.
    pub supports: bool,
    /// Elements that are gone.
    pub removed: bool,
    /// The elements that set the stable step.
    pub critical: bool,
    /// A set of the mesh whose nodes are marked.
    pub set: Option<String>,
    /// Tools.
    pub tools: bool,
    /// Fine surfaces in place of the bodies' own.
    pub skins: bool,
    /// Whether bodies are cut open.
    pub cut: bool,
    /// Which way the cut looks.
    pub cut_normal: Vec3,
    /// Where it is, from 0, where it takes all away, to 1.
    pub cut_at: f32,
    /// How wet tissue shines, 0 to 1.
    pub wet: f32,
    /// How dark shadows are, 0 to 1.
    pub shadows: f32,
    /// Dark colours.
    pub dark: bool,
    /// Whether keys do something.
    pub keys: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            field: None,
            component: 0,
            range: None,
            deformation: 1.0,
            wireframe: false,
            nodes: false,
            ghost: false,
            arrows: None,
            supports: false,
            removed: false,
            critical: false,
            set: None,
            tools: true,
            skins: true,
            cut: false,
            cut_normal: Vec3::NEG_Y,
            cut_at: 0.5,
            wet: 0.8,
            shadows: 0.85,
            dark: false,
            keys: true,
        }
    }
}

impl Settings {
    /// Where something is drawn that rests at a place and is at another (m).
    pub fn seen(&self, rest: Vec3, place: Vec3) -> Vec3 {
        rest + (place - rest) * self.deformation
    }
}

/// All fields, with their numbers.
pub const FIELDS: [OutputField; 21] = [
    OutputField::Displacement,
    OutputField::Velocity,
    OutputField::Reaction,
    OutputField::InternalForce,
    OutputField::ExternalForce,
    OutputField::VonMises,
    OutputField::Pressure,
    OutputField::CauchyStress,
    OutputField::PrincipalStresses,
    OutputField::PrincipalStretches,
    OutputField::GreenStrain,
    OutputField::VolumeRatio,
    OutputField::EnergyDensity,
    OutputField::FibreStretch,
    OutputField::HourglassShare,
    OutputField::ContactForce,
    OutputField::ContactTraction,
    OutputField::ContactPressure,
    OutputField::ContactArea,
    OutputField::ContactGap,
    OutputField::ContactSlip,
];

/// What can be seen as arrows, and what that is.
pub const ARROWS: [(OutputField, &str); 5] = [
    (OutputField::ExternalForce, "loads"),
    (OutputField::Reaction, "reactions of supports"),
    (OutputField::ContactForce, "forces of contact"),
    (OutputField::Velocity, "velocity"),
    (OutputField::Displacement, "displacement"),
];

/// What a field is called.
pub fn title(field: OutputField) -> String {
    known(field.array()).map_or_else(|| field.array().replace('_', " "), |known| known.quantity.into())
}

/// What is known of a field; all of them that have a middle have it as a whole and not by parts.
pub fn about(field: OutputField, component: usize) -> Known {
    let unknown = Known { quantity: "", unit: field.unit(), centre: None };
    let all = known(field.array()).unwrap_or(unknown);
    let unit = if all.unit == "1" { "" } else { all.unit };
    let centre = if component > 0 && field.is_of_nodes() { Some(0.0) } else { all.centre };
    Known { unit, centre, ..all }
}

/// The names of what a field's numbers can be seen as.
pub fn components(field: OutputField) -> &'static [&'static str] {
    match (field.components(), field) {
        (6, _) => &["xx", "yy", "zz", "xy", "yz", "xz"],
        (3, OutputField::PrincipalStresses | OutputField::PrincipalStretches) => &["largest", "middle", "least"],
        (3, _) => &["length", "x", "y", "z"],
        _ => &[],
    }
}

/// The number that is seen of a row of a field.
pub fn number(row: &[f32], field: OutputField, component: usize) -> f32 {
    if components(field).first() == Some(&"length") {
        return match component {
            0 => row.iter().map(|part| part * part).sum::<f32>().sqrt(),
            axis => row.get(axis - 1).copied().unwrap_or(f32::NAN),
        };
    }
    row.get(component).copied().unwrap_or(f32::NAN)
}
