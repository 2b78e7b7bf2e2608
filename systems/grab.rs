//! `grab`: springs and dampers from nodes that a hand holds to where they should be. `shaders/grab.wgsl` is its twin.

use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, MiddleOfStep, NodesAtRest};
use super::rows::Rows;
use super::stage::Stage;
use super::system::{Phase, System};
use crate::backend::cpu::{Cpu, NodeColumns};
use crate::backend::kernel::{Uniform, uniform};
use crate::components::*;
use crate::math::SimdScalar;
use crate::shader;
use bevy_ecs::prelude::*;

/// Pulls each held node by itself: the forces of a hand on the nodes of a face then sum up to that of a spring at the
/// point that was grabbed, and no node has to know where the others are. A inactive node is not pulled.
pub fn system() -> System {
    System::built_in_nodes::<Grabs>(
        "grab",
        Phase::Loads,
        "pulls nodes that a program holds to where it wants them",
        "`grabs` in the program's options",
        |world| super::registry::count::<Grabs>(world, "body that can be grabbed", "bodies that can be grabbed"),
    )
    .with_twin::<Grabs>("grab", shader!("grab"), |_, stage| stage)
}

impl NodeSystem for Grabs {
    type Columns = (&'static Displacement, &'static DisplacementIncrement, &'static Mass, &'static mut ExternalForce);
    /// What turns the last step into a velocity (1/s).
    type Prepared = f64;

    fn rows(&self) -> Rows<'_> {
        Rows::Changing
    }

    fn stages(&self, body: Entity, world: &World) -> Vec<Stage> {
        let label = world.get::<Label>(body).map_or("", |label| label.0.as_str());
        let most = format!("const MOST_HELD: u32 = {}u;\n", Grabs::MOST_HELD);
        let stage = Stage::default().text("generated: nodes that can be held", most);
        vec![stage.rewritten::<HeldRow>("grabs", uniform_of(label), bytes_of(self))]
    }

    fn prepare(&self, before: &Before<'_>) -> f64 {
        before.clock.rate()
    }

    fn act<T: SimdScalar>(&self, &rate: &f64, _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        let place = |bound: usize| self.held.partition_point(|held| (held.row as usize) < bound);
        for held in &self.held[place(nodes.first)..place(nodes.first + nodes.rows())] {
            let row = held.row as usize - nodes.first;
            let mass = nodes.mass()[row];
            if mass > T::default() {
                let step = glam::DVec3::from_array([0, 1, 2].map(|i| nodes.increments()[3 * row + i].to_f64()));
                nodes.add_load(row, held.force(nodes.displacement(row), step * rate, mass.to_f64()));
            }
        }
    }

    fn energy(&self, nodes: &MiddleOfStep<'_>) -> Option<f64> {
        let of_node = |held: &HeldNode| {
            let row = held.row as usize;
            let mass = nodes.mass.get(row);
            if mass > 0.0 { held.energy(nodes.displacement(row), mass) } else { 0.0 }
        };
        (!self.held.is_empty()).then(|| self.held.iter().map(of_node).sum())
    }

    /// Whatever the nodes' masses are by now: see [`HeldNode`].
    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        let of_node = |nodes: &[HeldNode]| nodes.iter().map(slopes_of).fold(ForceSlopes::NONE, ForceSlopes::and);
        let all = self.held.chunk_by(|one, next| one.row == next.row).map(of_node);
        all.fold(ForceSlopes::NONE, ForceSlopes::larger)
    }

    fn slopes_by_row(&self, _: &NodesAtRest<'_>, each: &mut dyn FnMut(usize, ForceSlopes)) {
        self.held.iter().for_each(|held| each(held.row as usize, slopes_of(held)));
    }
}

/// Of one spring and damper: the same in all directions.
fn slopes_of(held: &HeldNode) -> ForceSlopes {
    ForceSlopes { stiffness: held.stiffness_over_mass, damping: held.damping_over_mass }
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
    stiffness_over_mass: f32,
    damping_over_mass: f32,
    unused_1: u32,
    unused_2: u32,
    unused_3: u32,
}
uniform!(HeldRow {
    row,
    stiffness,
    damping,
    most,
    goal_x,
    goal_y,
    goal_z,
    stiffness_over_mass,
    damping_over_mass,
    unused_1,
    unused_2,
    unused_3
});

/// The bytes of that uniform: behind the last held node come rows that no body has.
pub(crate) fn bytes_of(grabs: &Grabs) -> Vec<u8> {
    let place = |place: usize| {
        let held = grabs.held.get(place);
        let held = held.copied().unwrap_or(HeldNode { row: u32::MAX, ..HeldNode::default() });
        let [goal_x, goal_y, goal_z] = held.goal.as_vec3().to_array();
        // infinity is no number that a shader must know
        let number = |number: f64| (number as f32).min(f32::MAX);
        HeldRow {
            row: held.row,
            stiffness: number(held.stiffness),
            damping: number(held.damping),
            most: number(held.most),
            goal_x,
            goal_y,
            goal_z,
            stiffness_over_mass: number(held.stiffness_over_mass),
            damping_over_mass: number(held.damping_over_mass),
            unused_1: 0,
            unused_2: 0,
            unused_3: 0,
        }
        .bytes()
    };
    (0..Grabs::MOST_HELD).flat_map(place).collect()
}
