//! Loads of a benchmark: gravity, and the same as users add it, in Rust and in WGSL alone.

use bevy_ecs::prelude::*;
use serde::{Deserialize, Serialize};
use sinew::backend::cpu::{Cpu, NodeColumns};
use sinew::components::{ExternalForce, Mass};
use sinew::glam::DVec3;
use sinew::math::SimdScalar;
use sinew::systems::{Before, ForceSlopes, NodeSystem, NodesAtRest, Phase, Registry, System};

/// What pulls at the cube.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Load {
    /// Nothing.
    None,
    /// The engine's gravity.
    #[default]
    Gravity,
    /// The same as a node system of a program's own.
    Rust,
    /// The same as a function in WGSL that the scene names.
    Wgsl,
}

/// Acceleration of all of them (m/s²).
const ACCELERATION: f64 = -2.0;
/// The function in WGSL, and the name of its file.
pub(super) const TEXT: (&str, &str) = ("weight.wgsl", include_str!("weight.wgsl"));

impl Load {
    /// As in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Gravity => "gravity",
            Self::Rust => "rust",
            Self::Wgsl => "wgsl",
        }
    }

    /// What a scene says of it.
    pub(super) fn in_scene(self) -> String {
        match self {
            Self::None => String::new(),
            Self::Gravity => format!("loads: [Gravity(acceleration: (0, 0, {ACCELERATION}))]"),
            Self::Rust => format!("parameters: {{\"weight\": (acceleration: {ACCELERATION})}}"),
            Self::Wgsl => format!(
                "systems: {{\"weight\": (file: \"{}\", parameters: {{\"acceleration\": {ACCELERATION}}})}}",
                TEXT.0
            ),
        }
    }

    /// The systems that are known.
    pub(super) fn registry(self) -> Registry {
        match self {
            Self::Rust => Registry::default().with(
                System::of_nodes::<Weight>("weight", Phase::Loads, "pulls all nodes down")
                    .on_each_body::<Weight>()
                    .with_shader::<Weight>("weight_stage.wgsl", include_str!("weight_stage.wgsl")),
            ),
            _ => Registry::default(),
        }
    }
}

/// Mass times acceleration along z, as anybody would write it.
#[derive(Component, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Weight {
    acceleration: f64,
}

impl NodeSystem for Weight {
    type Columns = (&'static Mass, &'static mut ExternalForce);
    type Prepared = ();

    fn prepare(&self, _: &Before<'_>) {}

    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes::NONE
    }

    fn act<T: SimdScalar>(&self, (): &(), _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        for row in 0..nodes.rows() {
            nodes.add_load(row, DVec3::new(0.0, 0.0, nodes.mass()[row].to_f64() * self.acceleration));
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::bench::{Case, Effects};
    use sinew::mesh::ElementKind;

    /// What is timed is the same load three times, and nothing else once.
    #[test]
    fn loads_of_ones_own_move_the_cube_as_gravity_does() {
        let moved = |load| {
            let case = Case {
                element: ElementKind::Hex8,
                effects: Effects::None,
                backend: "cpu".into(),
                precision: "f64".into(),
                threads: 1,
                instructions: "widest".into(),
                scheme: "patches".into(),
                cells: 3,
                fuse: true,
                load,
            };
            let mut simulation = case.simulation().unwrap();
            simulation.advance(20).unwrap();
            simulation.displacements("cube").unwrap()
        };
        let gravity = moved(Load::Gravity);
        let far = gravity.iter().fold(0.0_f64, |most, u| most.max(u.length()));
        assert!(far > 1e-4, "{far} m");
        for load in [Load::Rust, Load::Wgsl] {
            let apart = gravity.iter().zip(moved(load)).fold(0.0_f64, |most, (a, b)| most.max((*a - b).length()));
            assert!(apart <= 1e-12 * far, "{load:?}: {apart} m of {far} m");
        }
        assert!(moved(Load::None).iter().all(|u| u.length() == 0.0));
    }
}
