//! A bond of chosen nodes to where they are: a spring that slips where it is drawn too far, so that it has to remember
//! where it holds by now, and tells what energy it holds.

use sinew::prelude::*;
use sinew::systems::{Before, Cpu, ForceSlopes, MiddleOfStep, NodeColumns, NodeSystem, NodesAtRest, SimdScalar};

/// What the scene says under `parameters`.
#[derive(Component, Clone, serde::Deserialize, serde::Serialize)]
#[serde(crate = "sinew::serde", deny_unknown_fields)]
pub struct Bond {
    /// It has nodes that are at least so high at rest (m).
    height: f64,
    /// Force over mass and length (1/s²).
    stiffness: f64,
    /// It slips where it is longer (m).
    slip: f64,
}

pub fn system() -> System {
    System::of_nodes::<Bond>("bond", Phase::Loads, "holds what is high up")
        .on_each_body::<Bond>()
        .with_shader::<Bond>("tests/extend/bond.wgsl", include_str!("bond.wgsl"))
}

impl NodeSystem for Bond {
    type Columns = (&'static Displacement, &'static Mass, &'static mut ExternalForce);
    type Prepared = ();
    /// Where it holds a node by now: a displacement (m).
    const OWN_NUMBERS: usize = 3;

    fn prepare(&self, _: &Before<'_>) {}

    fn choose(&self, nodes: &NodesAtRest<'_>) -> Option<Vec<u32>> {
        let is_high = |(_, rest): &(u32, &DVec3)| rest.z >= self.height;
        Some((0..).zip(&nodes.rest.0).filter(is_high).map(|(row, _)| row).collect())
    }

    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes { stiffness: self.stiffness, damping: 0.0 }
    }

    fn energy(&self, nodes: &MiddleOfStep<'_>) -> Option<f64> {
        let of_node = |row: usize| {
            let held = DVec3::from_array([0, 1, 2].map(|i| nodes.own(row, i)));
            0.5 * self.stiffness * nodes.mass.get(row) * (nodes.displacement(row) - held).length_squared()
        };
        Some(nodes.chosen().map(of_node).sum())
    }

    fn act<T: SimdScalar>(&self, _: &(), _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        for row in nodes.chosen() {
            let mut held = DVec3::from_array([0, 1, 2].map(|i| nodes.own(row)[i].to_f64()));
            let drawn = nodes.displacement(row) - held;
            if drawn.length() > self.slip {
                held = nodes.displacement(row) - drawn * (self.slip / drawn.length());
                let own = nodes.own(row);
                held.to_array().iter().zip(own).for_each(|(from, to)| *to = T::from_f64(*from));
            }
            let pull = self.stiffness * nodes.mass()[row].to_f64();
            nodes.add_load(row, pull * (held - nodes.displacement(row)));
        }
    }
}
