//! What a program has to know to read the outputs of a run: names behind numbers, columns, units, values of the scene.

use crate::observation::{self, Heading};
use crate::output::nodes;
use crate::scene::schema::{OutputField, Scene};
use serde::Serialize;
use std::collections::BTreeMap;

/// Who has which number in the files, and what their columns are.
#[derive(Clone, Debug, Default, Serialize, PartialEq)]
pub struct Names {
    /// The bodies: `body` in VTU files is a place in this list, counted from 0.
    pub bodies: Vec<String>,
    /// The materials: `material` likewise.
    pub materials: Vec<String>,
    /// The arrays of VTU files that hold fields.
    pub fields: Vec<FieldName>,
    /// The columns of each table: name and unit, `1` of a plain number.
    pub columns: BTreeMap<String, Vec<(String, String)>>,
}

/// A field in VTU files.
#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct FieldName {
    /// Its word in the scene's `output.fields`.
    pub field: OutputField,
    /// The array's name; of a second family of fibres it ends in `_2`.
    pub array: &'static str,
    /// `nodes` or `elements`.
    pub of: &'static str,
    /// The unit, `1` of a plain number.
    pub unit: &'static str,
    /// Numbers a node or element: 1, 3, or 6 (xx, yy, zz, xy, yz, xz).
    pub components: usize,
}

impl Names {
    /// Those of a scene.
    pub fn of(scene: &Scene) -> Self {
        let field = |&field: &OutputField| FieldName {
            field,
            array: field.array(),
            of: if field.is_of_nodes() { "nodes" } else { "elements" },
            unit: field.unit(),
            components: field.components(),
        };
        let pair = |name: &str, unit: &str| (name.to_string(), unit.to_string());
        let with_units = |header: Vec<Heading>| header.iter().map(|of| pair(of.name, of.unit)).collect::<Vec<_>>();
        let mut columns: BTreeMap<String, Vec<(String, String)>> = scene
            .probes
            .iter()
            .map(|(name, probe)| (format!("probe_{name}.csv"), with_units(observation::header(&probe.what))))
            .collect();
        if scene.output.energies_every.is_some() {
            let header = observation::energy_header(scene.is_static(), scene.is_implicit(), scene.touches());
            columns.insert("energy.csv".into(), with_units(header));
        }
        if scene.is_static() {
            columns.insert("convergence.csv".into(), observation::CONVERGENCE.map(|name| pair(name, "1")).to_vec());
        }
        if scene.follows_path() {
            let mut all: Vec<(String, String)> =
                observation::PATH.iter().map(|(name, unit)| pair(name, unit)).collect();
            for (name, probe) in &scene.probes {
                let of_probe = observation::columns_of_probe(&probe.what).into_iter();
                all.extend(of_probe.map(|of| pair(&format!("{name}: {}", of.name), of.unit)));
            }
            columns.insert("path.csv".into(), all);
        }
        let of_nodes: Vec<(String, String)> = nodes::COLUMNS.iter().map(|(name, unit)| pair(name, unit)).collect();
        for name in scene.bodies.keys() {
            columns.insert(nodes::file_name(name, scene.bodies.len()), of_nodes.clone());
        }
        Self {
            bodies: scene.bodies.keys().cloned().collect(),
            materials: scene.materials.keys().cloned().collect(),
            fields: scene.output.fields().iter().map(field).collect(),
            columns,
        }
    }
}

/// The values of a scene as JSON; as text in RON, where systems of one's own have parameters that JSON cannot hold.
pub fn parameters(scene: &Scene) -> serde_json::Value {
    serde_json::to_value(scene)
        .unwrap_or_else(|_| ron::to_string(scene).map_or(serde_json::Value::Null, serde_json::Value::from))
}

/// Units of the summary's numbers that are no counts; `*` stands for any name.
pub const UNITS: &[(&str, &str)] = &[
    ("stable_step", "s"),
    ("stability.bound.time_step", "s"),
    ("stability.bound.usual", "s"),
    ("stability.bound.worst.bound", "s"),
    ("stability.bound.worst.cost", "1"),
    ("stability.bound.worst.gain", "1"),
    ("stability.beyond", "s"),
    ("stability.by_nodes", "s"),
    ("stability.limit", "s"),
    ("stability.stable_step", "s"),
    ("stability.step", "s"),
    ("time_step", "s"),
    ("share_of_limit", "1"),
    ("step_history.smallest", "s"),
    ("step_history.largest", "s"),
    ("step_history.seconds", "s"),
    ("step_history.beyond_since", "s"),
    ("step_history.added_mass", "kg"),
    ("step_history.added_share", "1"),
    ("step_history.added_energy", "J"),
    ("resumed_at", "s"),
    ("simulated", "s"),
    ("setup_seconds", "s"),
    ("run_seconds", "s"),
    ("solving_seconds", "s"),
    ("writing_seconds", "s"),
    ("real_time_factor", "1"),
    ("frames.longest", "s"),
    ("frames.percentile_99", "s"),
    ("seconds_a_step", "s"),
    ("nanoseconds_an_element_and_step", "ns"),
    ("systems.seconds", "s"),
    ("traffic.seconds", "s"),
    ("equilibrium.residual", "1"),
    ("equilibrium.rounding", "1"),
    ("equilibrium.tolerance", "1"),
    ("equilibrium.scale", "N"),
    ("equilibrium.remaining_motion", "1"),
    ("equilibrium.worst", "N"),
    ("preload.seconds", "s"),
    ("preload.equilibrium.residual", "1"),
    ("preload.equilibrium.rounding", "1"),
    ("preload.equilibrium.tolerance", "1"),
    ("preload.equilibrium.scale", "N"),
    ("preload.equilibrium.remaining_motion", "1"),
    ("preload.equilibrium.worst", "N"),
    ("energies.kinetic", "J"),
    ("energies.strain", "J"),
    ("energies.hourglass", "J"),
    ("energies.held", "J"),
    ("energies.removed", "J"),
    ("energies.load_work", "J"),
    ("energies.damping_loss", "J"),
    ("energies.scheme_loss", "J"),
    ("energies.contact_loss", "J"),
    ("implicit.largest_residual_left", "1"),
    ("implicit.smallest_step", "s"),
    ("implicit.largest_step", "s"),
    ("energies.constraint_work", "J"),
    ("energies.internal_work", "J"),
    ("mass", "kg"),
    ("removed_mass", "kg"),
    ("removed_momentum", "kg m/s"),
    ("tools.*.force", "N"),
    ("tools.*.suction", "N"),
    ("tools.*.torque", "N m"),
    ("tools.*.place", "m"),
    ("tools.*.penetration", "m"),
    ("tools.*.work", "J"),
    ("tools.*.loss", "J"),
    ("tools.*.waiting", "m³"),
    ("tools.*.free.mass", "kg"),
    ("tools.*.free.center", "m"),
    ("tools.*.free.velocity", "m/s"),
    ("tools.*.free.spin", "rad/s"),
    ("tools.*.free.angular_momentum", "kg m²/s"),
    ("tools.*.free.kinetic", "J"),
    ("tools.*.free.potential", "J"),
    ("tools.*.free.damping_loss", "J"),
    ("contacts.*.force", "N"),
    ("contacts.*.penetration", "m"),
    ("contacts.*.loss", "J"),
    ("surface_contact.points_near", "1"),
    ("surface_contact.contacts", "1"),
    ("surface_contact.seconds", "s"),
    ("surface_contact.share", "1"),
    ("surface_contact.nanoseconds_a_near_point", "ns"),
    ("surface_contact.builds_a_second", "1/s"),
    ("surface_contact.build_seconds", "s"),
    ("surface_contact.deepest", "m"),
    ("attachments.*.force", "N"),
    ("attachments.*.length", "m"),
    ("attachments.*.energy", "J"),
    ("attachments.*.loss", "J"),
    ("attachments.*.broke_at", "s"),
    ("real_time.waited", "s"),
    ("guards.rounding", "J"),
    ("guards.at_start", "J"),
    ("guards.scale", "J"),
    ("guards.imbalance", "1"),
    ("guards.scheme_loss", "J"),
    ("guards.least_scheme_loss", "J"),
    ("guards.turned_over", "J"),
    ("guards.longest_step", "s"),
    ("guards.peaks.*", "J"),
    ("guards.hourglass.*", "1"),
    ("guards.least_volume_ratio.value", "1"),
    ("guards.least_volume_ratio.time", "s"),
    ("guards.fastest_node.value", "m/s"),
    ("guards.fastest_node.time", "s"),
    ("guards.warnings.time", "s"),
    ("failure.time", "s"),
    ("failure.good_until", "s"),
];
