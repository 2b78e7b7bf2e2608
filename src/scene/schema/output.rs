//! What a run writes.

use serde::{Deserialize, Serialize};

/// What is written, and how often.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Time between VTU files (s); a twentieth of the duration when left out, in a static analysis all of it.
    pub fields_every: Option<f64>,
    /// Which fields VTU files hold; displacement, velocity, J, von Mises stress, pressure and Cauchy stress when left
    /// out.
    pub fields: Option<Vec<OutputField>>,
    /// Write elements that have been removed, too, with an array `alive` that tells them from the others.
    pub removed_elements: bool,
    /// Time between rows of `energy.csv` (s). Naming it also counts the work of all forces in every step.
    pub energies_every: Option<f64>,
    /// Time between snapshots (s), from which `sinew run --resume` goes on; none when left out.
    pub snapshots_every: Option<f64>,
}

/// A field of VTU files. Those of elements are volume means over the integration points.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
pub enum OutputField {
    /// Displacement of each node (m).
    Displacement,
    /// Velocity of each node (m/s), in the middle of the step that led there.
    Velocity,
    /// What holds each node along axes that are fixed or moved as told: internal less external force (N) at the
    /// beginning of the step that led there; 0 along free axes.
    Reaction,
    /// F of M ü = R − F (N): what it takes to hold each node against its deformed elements.
    InternalForce,
    /// Sum R of all loads on each node (N), at the beginning of the step that led there.
    ExternalForce,
    /// What tools, other bodies and the body itself do to each node where they touch it (N), at the beginning of the
    /// step that led there.
    ContactForce,
    /// The same over the area of the surface around each node (Pa).
    ContactTraction,
    /// The part of that force into the surface, over the area that it presses on (Pa).
    ContactPressure,
    /// The area that what touches a node presses on (m²): its share of the exposed faces around it that are turned to
    /// it; 0 where nothing touches it.
    ContactArea,
    /// How far each node is outside of the face of another body, or of its own, that it faces (m); negative inside. The
    /// mean length of an edge of its surface where none is near.
    ContactGap,
    /// The length that each node has slid along bodies and tools since the start (m).
    ContactSlip,
    /// Volume ratio J.
    VolumeRatio,
    /// Cauchy stress (Pa): xx, yy, zz, xy, yz, xz.
    CauchyStress,
    /// von Mises stress (Pa).
    VonMises,
    /// Pressure, the negative mean stress (Pa).
    Pressure,
    /// Principal Cauchy stresses (Pa), the largest first.
    PrincipalStresses,
    /// Principal stretches, the largest first.
    PrincipalStretches,
    /// Green-Lagrange strain E = ½(FᵀF − 1): xx, yy, zz, xy, yz, xz.
    GreenStrain,
    /// Elastic energy per rest volume (J/m³), as of an instantaneous deformation.
    EnergyDensity,
    /// Stretch along each family of fibres.
    FibreStretch,
    /// Share of hourglass control in an element's energy.
    HourglassShare,
}

impl OutputField {
    /// What is written when a scene names none.
    pub const USUAL: [OutputField; 6] = [
        OutputField::Displacement,
        OutputField::Velocity,
        OutputField::VolumeRatio,
        OutputField::VonMises,
        OutputField::Pressure,
        OutputField::CauchyStress,
    ];

    /// Whether it has a value a node, and not one an element.
    pub fn is_of_nodes(self) -> bool {
        use OutputField::*;
        matches!(
            self,
            Displacement
                | Velocity
                | Reaction
                | InternalForce
                | ExternalForce
                | ContactForce
                | ContactTraction
                | ContactPressure
                | ContactArea
                | ContactGap
                | ContactSlip
        )
    }

    /// Whether it is of what touches nodes.
    pub fn is_of_contact(self) -> bool {
        use OutputField::*;
        matches!(self, ContactForce | ContactTraction | ContactPressure | ContactArea | ContactGap | ContactSlip)
    }

    /// The array's name in VTU files, by which `sinew render` finds it; of a second family of fibres with `_2`.
    pub fn array(self) -> &'static str {
        match self {
            OutputField::Displacement => "displacement",
            OutputField::Velocity => "velocity",
            OutputField::Reaction => "reaction",
            OutputField::InternalForce => "internal_force",
            OutputField::ExternalForce => "external_force",
            OutputField::ContactForce => "contact_force",
            OutputField::ContactTraction => "contact_traction",
            OutputField::ContactPressure => "contact_pressure",
            OutputField::ContactArea => "contact_area",
            OutputField::ContactGap => "contact_gap",
            OutputField::ContactSlip => "contact_slip",
            OutputField::VolumeRatio => "J",
            OutputField::CauchyStress => "stress",
            OutputField::VonMises => "von_mises",
            OutputField::Pressure => "pressure",
            OutputField::PrincipalStresses => "principal_stresses",
            OutputField::PrincipalStretches => "principal_stretches",
            OutputField::GreenStrain => "green_strain",
            OutputField::EnergyDensity => "energy_density",
            OutputField::FibreStretch => "fibre_stretch",
            OutputField::HourglassShare => "hourglass_share",
        }
    }

    /// The SI unit; 1 of a plain number.
    pub fn unit(self) -> &'static str {
        use OutputField::*;
        match self {
            Displacement | ContactGap | ContactSlip => "m",
            ContactArea => "m²",
            Velocity => "m/s",
            Reaction | InternalForce | ExternalForce | ContactForce => "N",
            ContactTraction | ContactPressure | CauchyStress | VonMises | Pressure | PrincipalStresses => "Pa",
            EnergyDensity => "J/m³",
            VolumeRatio | PrincipalStretches | GreenStrain | FibreStretch | HourglassShare => "1",
        }
    }

    /// Numbers a node or element: 1, 3 (a vector, or three from the largest to the smallest) or 6 (xx, yy, zz, xy, yz,
    /// xz).
    pub fn components(self) -> usize {
        use OutputField::*;
        match self {
            CauchyStress | GreenStrain => 6,
            PrincipalStresses | PrincipalStretches => 3,
            ContactPressure | ContactArea | ContactGap | ContactSlip => 1,
            field if field.is_of_nodes() => 3,
            _ => 1,
        }
    }
}

impl Output {
    /// The fields that VTU files hold.
    pub fn fields(&self) -> &[OutputField] {
        self.fields.as_deref().unwrap_or(&OutputField::USUAL)
    }
}
