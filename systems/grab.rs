//! `grab`: springs and dampers from nodes that a hand holds to where they should be. `shaders/grab.wgsl` is its twin.

use super::node_system::{Before, ForceSlopes, NodeSystem, NodesAtRest};
use super::registry::{Phase, System};
use crate::backend::Buffers;
use crate::backend::cpu::{Cpu, NodeColumns};
use crate::backend::kernel::Fragment;
use crate::backend::node_stage::{NodeStage, rows_of};
use crate::components::*;
use crate::math::SimdScalar;
use crate::shader;
use bevy_ecs::prelude::*;

/// Pulls each held node by itself: the forces of a hand on the nodes of a face then sum up to that of a spring at the
/// point that was grabbed, and no node has to know where the others are. A parked node is not pulled.
pub fn system() -> System {
    System::built_in_nodes::<Grabs>(
        "grab",
        Phase::Loads,
        "pulls nodes that a program holds to where it wants them",
        "`grabs` in the program's options",
        |world| super::registry::count::<Grabs>(world, "body that can be grabbed", "bodies that can be grabbed"),
    )
    .on_nodes(stages)
}

impl NodeSystem for Grabs {
    type Columns = (&'static Displacement, &'static DisplacementStep, &'static Mass, &'static mut ExternalForce);
    /// What turns the last step into a velocity (1/s).
    type Prepared = f64;

    fn prepare(&self, before: &Before<'_>) -> f64 {
        before.clock.rate()
    }

    fn act<T: SimdScalar>(&self, &rate: &f64, _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        let place = |bound: usize| self.held.partition_point(|held| (held.row as usize) < bound);
        for held in &self.held[place(nodes.first)..place(nodes.first + nodes.rows())] {
            let row = held.row as usize - nodes.first;
            if nodes.mass[row] > T::default() {
                let step = glam::DVec3::from_array([0, 1, 2].map(|i| nodes.step[3 * row + i].to_f64()));
                nodes.add_load(row, held.force(nodes.displacement(row), step * rate));
            }
        }
    }

    fn slopes(&self, nodes: &NodesAtRest<'_>) -> ForceSlopes {
        let mut largest = ForceSlopes::default();
        for held in &self.held {
            let mass = nodes.mass.get(held.row as usize);
            if mass > 0.0 {
                let of_node = self.held.iter().filter(|other| other.row == held.row);
                // the same in all directions
                let sum = of_node.fold((0.0, 0.0), |sum, held| (sum.0 + held.stiffness, sum.1 + held.damping));
                largest = largest.larger(ForceSlopes { stiffness: sum.0 / mass, damping: sum.1 / mass });
            }
        }
        largest
    }
}

/// The name of the uniform that holds a body's held nodes.
pub(crate) fn uniform_of(body: &str) -> String {
    format!("grabs of {body}")
}

/// The bytes of that uniform: how many there are, then each on 32 bytes; see `shaders/grab.wgsl`.
pub(crate) fn bytes_of(grabs: &Grabs) -> Vec<u8> {
    let mut bytes = vec![0; 16 + 32 * Grabs::MOST_HELD];
    bytes[..4].copy_from_slice(&(grabs.held.len() as u32).to_le_bytes());
    for (held, place) in grabs.held.iter().zip(bytes[16..].chunks_exact_mut(32)) {
        let numbers = [held.stiffness, held.damping, held.most, held.goal.x, held.goal.y, held.goal.z];
        // infinity is no number that a shader must know
        let number = |number: f64| (number as f32).min(f32::MAX).to_bits();
        let words = std::iter::once(held.row).chain(numbers.map(number));
        for (word, bytes) in words.zip(place.as_chunks_mut::<4>().0) {
            *bytes = word.to_le_bytes();
        }
    }
    bytes
}

/// One stage for each body that can be grabbed.
fn stages(world: &mut World, buffers: &mut dyn Buffers) -> Vec<NodeStage> {
    let all: Vec<(Grabs, Entity)> =
        world.query::<(&Grabs, &OfBody)>().iter(world).map(|(grabs, body)| (grabs.clone(), body.0)).collect();
    let mut stages = Vec::new();
    for (grabs, body) in all {
        let label = world.get::<Label>(body).map(|label| label.0.clone()).unwrap_or_default();
        let most = Fragment::new(
            "generated: nodes that can be held",
            format!("const MOST_HELD: u32 = {}u;\n", Grabs::MOST_HELD),
        );
        let mut stage = NodeStage::new("grab", "grab", body, rows_of(body, world), shader!("grab"))
            .own(most)
            .bind("grabs", buffers.uniform(uniform_of(&label), &bytes_of(&grabs)));
        for column in [Mass::NAME, Displacement::NAME, DisplacementStep::NAME, ExternalForce::NAME] {
            stage = stage.column(column, buffers.column(body, column));
        }
        stages.push(stage.with_step(world).loaded(true));
    }
    stages
}
