//! A load: wind that blows above a height.

use sinew::prelude::*;
use sinew::systems::{Before, Cpu, ForceSlopes, NodeColumns, NodeSystem, NodesAtRest, SimdScalar};

/// What the scene says under `parameters`.
#[derive(Component, Clone, serde::Deserialize, serde::Serialize)]
#[serde(crate = "sinew::serde", deny_unknown_fields)]
pub struct Wind {
    /// Of what is in it (m/s²).
    acceleration: DVec3,
    /// Half of it blows there, all of it at twice the height (m).
    height: f64,
}

pub fn system() -> System {
    System::of_nodes::<Wind>("wind", Phase::Loads, "blows above a height")
        .on_each_body::<Wind>()
        .with_shader::<Wind>("tests/extend/wind.wgsl", include_str!("wind.wgsl"))
}

impl NodeSystem for Wind {
    type Columns = (&'static RestPosition, &'static Displacement, &'static Mass, &'static mut ExternalForce);
    type Prepared = ();

    fn prepare(&self, _: &Before<'_>) {}

    /// Where it blows harder with height.
    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes { stiffness: self.acceleration.length() / (2.0 * self.height), damping: 0.0 }
    }

    fn act<T: SimdScalar>(&self, _: &(), _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        for row in 0..nodes.rows() {
            let share = (nodes.place(row).z / (2.0 * self.height)).clamp(0.0, 1.0);
            nodes.add_load(row, nodes.mass()[row].to_f64() * share * self.acceleration);
        }
    }
}
