//! `grab`: springs and dampers from nodes that a hand holds to where they should be. `shaders/grab.wgsl` is its twin.

use super::node_system::{Before, ForceSlopes, NodeSystem, NodesAtRest};
use super::registry::{Phase, System};
use crate::backend::Buffers;
use crate::backend::cpu::{Cpu, NodeColumns};
use crate::backend::kernel::{Fragment, Uniform, uniform};
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

/// A held node as kernels see it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct HeldRow {
    row: u32,
    stiffness: f32,
    damping: f32,
    most: f32,
    goal_x: f32,
    goal_y: f32,
    goal_z: f32,
    unused: u32,
}
uniform!(HeldRow { row, stiffness, damping, most, goal_x, goal_y, goal_z, unused });

/// The bytes of that uniform: behind the last held node come rows that no body has.
pub(crate) fn bytes_of(grabs: &Grabs) -> Vec<u8> {
    let place = |place: usize| {
        let held = grabs.held.get(place);
        let HeldNode { row, stiffness, damping, most, goal } =
            held.copied().unwrap_or(HeldNode { row: u32::MAX, ..HeldNode::default() });
        let [goal_x, goal_y, goal_z] = goal.as_vec3().to_array();
        // infinity is no number that a shader must know
        let most = (most as f32).min(f32::MAX);
        let (stiffness, damping) = (stiffness as f32, damping as f32);
        HeldRow { row, stiffness, damping, most, goal_x, goal_y, goal_z, unused: 0 }.bytes()
    };
    (0..Grabs::MOST_HELD).flat_map(place).collect()
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
            .bind_uniform::<HeldRow>("grabs", buffers.uniform(uniform_of(&label), &bytes_of(&grabs)));
        for column in [Mass::NAME, Displacement::NAME, DisplacementStep::NAME, ExternalForce::NAME] {
            stage = stage.column(column, buffers.column(body, column));
        }
        stages.push(stage.with_step(world).loaded(true));
    }
    stages
}
