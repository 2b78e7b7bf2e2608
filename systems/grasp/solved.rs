//! Grasps in implicit steps: motion that is told, of nodes that closed tools hold.

use crate::components::*;
use bevy_ecs::prelude::*;
use glam::DVec3;
use smallvec::SmallVec;

/// A node that a closed tool holds in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeldNode {
    /// Its body, and its row there.
    pub body: Entity,
    pub row: usize,
    /// Its displacement at the end of the step (m).
    pub displacement: DVec3,
    /// How far the tool goes there (m).
    tool_step: DVec3,
    /// Where its numbers begin in [`ToolHold`].
    at: usize,
    /// Whether the tool closes in this step.
    taken: bool,
    /// The force at which it slips out (N), and whether a hand feels it.
    strength: f64,
    felt: bool,
}

/// What a tool gives to a node that it holds, in a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Given {
    /// What the node gets (J).
    pub work: f64,
    /// What is lost beside where the tool closes in this step (J): it has another velocity at once.
    pub by_a_jolt: f64,
}

/// Which nodes closed tools hold in the step that begins, where signals are those of the step; notes what closes and
/// opens. Of several tools at a node the last one has it.
pub(crate) fn held_in_step(world: &mut World) -> Vec<HeldNode> {
    let Some(values) = world.get_resource::<Signals>().map(|signals| signals.values().to_vec()) else {
        return Vec::new();
    };
    let mut all = Vec::new();
    let mut bodies = world.query::<(Entity, &Grasps, &mut ToolHold, &RestPosition, &Displacement, &Mass)>();
    for (body, grasps, mut hold, rest, u, mass) in bodies.iter_mut(world) {
        for (place, (&row, &mask)) in grasps.rows.iter().zip(&grasps.masks).enumerate() {
            let row = row as usize;
            let at_rest = rest.0[row] - grasps.reference;
            let (mut last, mut held) = (None::<HeldNode>, SmallVec::<[(usize, Pose); 4]>::new());
            for (number, grasp) in grasps.grasps.iter().enumerate().filter(|(number, _)| mask >> number & 1 == 1) {
                let at = grasps.numbers() * place + grasps.numbers_a_grasp() * number;
                let [pose, change] = [0, 3].map(|slot| Pose::of_slots(&values[grasp.tool.signal + slot..]));
                let closed = values[grasp.closed][1] > 0.0 && mass.get(row) > 0.0;
                let taken = ToolHold::is_open(hold.get(at + 3));
                if !follows(grasp, &mut hold, at, closed, pose.less(&change).inverse(at_rest + u.vector(row))) {
                    continue;
                }
                let of_tool = hold.vector_at(at + 6);
                let displacement = pose.place(of_tool) - at_rest;
                let tool_step = change.place(of_tool);
                let (strength, felt) = (grasp.strength, grasps.felt);
                last = Some(HeldNode { body, row, displacement, tool_step, at, taken, strength, felt });
                held.push((at, pose));
            }
            // whom the last one lets go the others take up where it is then
            held.pop();
            for (at, pose) in held {
                let ends = last.map_or(at_rest, |last| at_rest + last.displacement);
                hold.set_vector_at(at + 6, pose.inverse(ends));
                // and bear nothing until then
                hold.set_vector_at(at, DVec3::ZERO);
            }
            all.extend(last);
        }
    }
    all
}

/// Whether a tool holds a node that is there in its frame (m) at the beginning of the step.
fn follows(grasp: &Grasp, hold: &mut ToolHold, at: usize, closed: bool, of_tool: DVec3) -> bool {
    let holds = hold.get(at + 3);
    if !closed {
        if !ToolHold::is_open(holds) {
            hold.set_vector_at(at, DVec3::ZERO);
            hold.set(at + 3, ToolHold::opened(holds));
        }
        return false;
    }
    if ToolHold::is_open(holds) {
        let within = |reach: f64| grasp.tool.geometry.distance(of_tool).0 <= reach;
        hold.set(at + 3, if grasp.reach.is_none_or(within) { ToolHold::HELD } else { ToolHold::WITHOUT });
        hold.set_vector_at(at + 6, of_tool);
    }
    let holds = hold.get(at + 3) == ToolHold::HELD;
    if !holds {
        // whom it has lost it held to the end of the last step
        hold.set_vector_at(at, DVec3::ZERO);
    }
    holds
}

/// Notes with which force (N) a tool holds a node at the end of the step, and what it gives by that; at rest by the
/// mean of its forces. Whom it takes more to hold than it can slips out in the next one: not at rest, nor where it
/// takes the node in this step, by an impulse.
pub(crate) fn note_held(world: &mut World, node: &HeldNode, force: DVec3, given: Option<Given>) {
    let moves = world.resource::<Clock>().relaxation.is_none();
    let Some(mut hold) = world.get_mut::<ToolHold>(node.body) else { return };
    let at = node.at;
    let before = hold.vector_at(at);
    let at_rest = Given { work: 0.5 * (before + force).dot(node.tool_step), by_a_jolt: 0.0 };
    let Given { work, by_a_jolt } = given.unwrap_or(at_rest);
    let lost = if node.taken { by_a_jolt } else { 0.0 };
    hold.set_vector_at(at, force);
    for (number, part) in [(at + 4, work + lost), (at + 5, lost)] {
        let sum = hold.get(number) + part;
        hold.set(number, sum);
    }
    if node.felt {
        let felt = hold.vector_at(at + HOLD_NUMBERS) + force;
        hold.set_vector_at(at + HOLD_NUMBERS, felt);
    }
    if moves && before != DVec3::ZERO && force.length() > node.strength {
        hold.set(at + 3, ToolHold::SLIPPED);
    }
}
