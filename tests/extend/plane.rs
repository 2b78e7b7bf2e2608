//! A contact plane: a floor that pushes back what has sunk into it, as a spring and a damper that only push.

use sinew::prelude::*;
use sinew::systems::{Before, Cpu, ForceSlopes, NodeColumns, NodeSystem, NodesAtRest, SimdScalar};

/// What the scene says under `parameters`.
#[derive(Component, Clone, serde::Deserialize, serde::Serialize)]
#[serde(crate = "sinew::serde", deny_unknown_fields)]
pub struct Plane {
    /// z of the floor (m).
    height: f64,
    /// Force over mass and depth (1/s²).
    stiffness: f64,
    /// Force over mass and speed (1/s).
    damping: f64,
}

pub fn system() -> System {
    System::of_nodes::<Plane>("plane", Phase::Loads, "pushes back what sinks into the floor")
        .on_each_body::<Plane>()
        .with_shader::<Plane>("tests/extend/plane.wgsl", include_str!("plane.wgsl"))
}

impl NodeSystem for Plane {
    type Columns = (
        &'static RestPosition,
        &'static Displacement,
        &'static DisplacementIncrement,
        &'static Mass,
        &'static mut ExternalForce,
    );
    /// What turns the last step into a velocity (1/s).
    type Prepared = f64;

    fn prepare(&self, before: &Before<'_>) -> f64 {
        before.clock.rate()
    }

    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes { stiffness: self.stiffness, damping: self.damping }
    }

    fn act<T: SimdScalar>(&self, &rate: &f64, _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        for row in 0..nodes.rows() {
            let depth = self.height - nodes.place(row).z;
            if depth > 0.0 {
                let speed = rate * nodes.increments()[3 * row + 2].to_f64();
                let push = (self.stiffness * depth - self.damping * speed).max(0.0);
                nodes.add_load(row, DVec3::Z * (nodes.mass()[row].to_f64() * push));
            }
        }
    }
}
