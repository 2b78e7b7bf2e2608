//! `grasp`: closed tools take nodes along. `shaders/grasp.wgsl` is its twin.

mod foreseen;
mod solved;

use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::places_within;
use super::rows::Rows;
use super::system::{Phase, System};
use super::tool_contact::{ToolNodes, tool_stage};
use crate::backend::Buffers;
use crate::backend::cpu::{Cpu, IntegrationCoefficients, NodeColumns};
use crate::backend::kernel::{Uniform, uniform};
use crate::backend::node_stage::NodeStage;
use crate::components::*;
use crate::math::SimdScalar;
use crate::shader;
use bevy_ecs::prelude::*;
pub(super) use foreseen::Grip;
use glam::{DMat3, DVec3};
pub(crate) use solved::{Given, HeldNode, held_in_step, note_held};

/// A node that a closed tool holds stays at the place in the tool's frame where it was when the tool closed: motion
/// that is prescribed by a frame. Like `tool_contact` it finds the force that takes the predicted step there, after all
/// other forces, and adds it to the loads: `integrate`, the balance of energy and the residual of a static analysis
/// need not know of it, and the stable step stays as it is. Nothing jumps when it closes; when it opens, the node keeps
/// the velocity of its last step. Its strength is tested in motion, and not in the step in which it takes the node:
/// what it takes to catch something that moves otherwise is an impulse, whose force is the larger the shorter the step.
pub fn system() -> System {
    System::built_in_nodes::<Grasps>(
        "grasp",
        Phase::Contact,
        "takes nodes along with closed tools",
        "`Grasp(...)` under `attachments`",
        |world| super::registry::count::<Grasps>(world, "body that tools may hold", "bodies that tools may hold"),
    )
    .on_nodes(stages)
}

/// What a step needs.
pub struct GraspStep {
    /// Whether a solver holds the axes of nodes.
    solved: bool,
    coefficients: IntegrationCoefficients<f64>,
    /// Whether work is counted, and nodes slip out: not on the way to rest.
    counts_work: bool,
    /// One for each grasp, and others behind.
    tools: [ToolInStep; Grasps::MOST],
}

/// A tool in a step.
#[derive(Clone, Copy)]
struct ToolInStep {
    closed: bool,
    /// Where it is at the end.
    pose: Pose,
    /// How that differs from where it was at the beginning.
    change: Pose,
}

impl NodeSystem for Grasps {
    type Columns = (
        (&'static Mass, Option<&'static InertialMass>, Option<&'static DampingCoefficient>),
        (&'static InternalForce, &'static ConstrainedAxes, &'static Displacement, &'static DisplacementIncrement),
        Option<&'static DisplacementCompensation>,
        (&'static mut ExternalForce, &'static mut ToolHold),
    );
    type Prepared = GraspStep;

    fn rows(&self) -> Rows<'_> {
        Rows::List(&self.rows)
    }

    fn prepare(&self, before: &Before<'_>) -> GraspStep {
        let values = before.signals.values();
        let nowhere = Pose { rotation: DMat3::ZERO, at: DVec3::ZERO };
        let mut tools = [ToolInStep { closed: false, pose: nowhere, change: nowhere }; Grasps::MOST];
        for (tool, grasp) in tools.iter_mut().zip(&self.grasps) {
            let [pose, change] = [0, 3].map(|slot| Pose::of_slots(&values[grasp.tool.signal + slot..]));
            *tool = ToolInStep { closed: values[grasp.closed][1] > 0.0, pose, change };
        }
        GraspStep {
            solved: before.clock.springs.is_some_and(|springs| springs.forces != SpringForces::Stepped),
            coefficients: IntegrationCoefficients::of(before.clock),
            counts_work: before.clock.relaxation.is_none(),
            tools,
        }
    }

    /// None: as contact with tools, it corrects the step to come.
    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes::NONE
    }

    fn act<T: SimdScalar>(&self, step: &GraspStep, _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        if step.solved {
            return;
        }
        let Some(holds) = nodes.holds.take() else { return };
        let own = places_within(&self.rows, nodes.first, nodes.rows());
        let count = self.numbers_a_grasp();
        for (place, (&row, &mask)) in self.rows[own.clone()].iter().zip(&self.masks[own]).enumerate() {
            let values = &mut holds.values[holds.numbers * place..holds.numbers * (place + 1)];
            // of several tools the last one has it
            let mut ends = None;
            for (number, values) in values.chunks_exact_mut(count).enumerate().rev() {
                if mask >> number & 1 == 1 {
                    ends = self.hold(step, number, (row as usize - nodes.first, ends), nodes, values);
                }
            }
        }
        nodes.holds = Some(holds);
    }
}

impl Grasps {
    /// What one tool does to one node, which others may take to a place already (m): whom these let go it takes up
    /// where it is then. Gives where the node ends, if a tool holds it.
    fn hold<T: SimdScalar>(
        &self,
        step: &GraspStep,
        number: usize,
        (row, ends): (usize, Option<DVec3>),
        nodes: &mut NodeColumns<'_, T>,
        values: &mut [T],
    ) -> Option<DVec3> {
        let (grasp, ToolInStep { closed, pose, change }) = (&self.grasps[number], &step.tools[number]);
        let open = ToolHold::is_open(values[3].to_f64());
        if open && !closed {
            return ends;
        }
        // what it bore in the step before, which is nothing where it takes the node in this one
        let bore = values[..3].iter().any(|part| *part != T::default());
        values[..3].fill(T::default());
        if !closed {
            values[3] = T::from_f64(ToolHold::opened(values[3].to_f64()));
            return ends;
        }
        if nodes.inertia()[row] <= T::default() {
            return ends;
        }
        let place = nodes.rest[row] - self.reference + nodes.exact_displacement(row);
        if open {
            let of_tool = pose.less(change).inverse(place);
            let within = |reach: f64| grasp.tool.geometry.distance(of_tool).0 <= reach;
            values[3] = T::from_f64(if grasp.reach.is_none_or(within) { ToolHold::HELD } else { ToolHold::WITHOUT });
            for (number, part) in values[6..9].iter_mut().zip(of_tool.to_array()) {
                *number = T::from_f64(part);
            }
        }
        if values[3] != T::from_f64(ToolHold::HELD) {
            return ends;
        }
        if let Some(ends) = ends {
            for (number, part) in values[6..9].iter_mut().zip(pose.inverse(ends).to_array()) {
                *number = T::from_f64(part);
            }
            return Some(ends);
        }
        let of_tool = DVec3::from_array([6, 7, 8].map(|i: usize| values[i].to_f64()));
        let foreseen = nodes.foresee(&step.coefficients, row);
        let gap = foreseen.free * (pose.place(of_tool) - place - foreseen.step);
        let force = foreseen.to_force * gap;
        // to the end of the step it holds, as others have been told
        if bore && step.counts_work && force.length() > grasp.strength {
            values[3] = T::from_f64(ToolHold::SLIPPED);
        }
        for i in 0..3 {
            values[i] = T::from_f64(force[i]);
        }
        for (i, felt) in values[HOLD_NUMBERS..].iter_mut().enumerate() {
            *felt += T::from_f64(force[i]);
        }
        if step.counts_work {
            let on_node = step.coefficients.work_factor * force.dot(0.5 * (foreseen.before + foreseen.step + gap));
            // whom it held it moved as itself, and gives to it all that it does
            let lost = match bore {
                true => 0.0,
                false => step.coefficients.work_factor * force.dot(change.place(of_tool)) - on_node,
            };
            values[4] += T::from_f64(on_node + lost);
            values[5] += T::from_f64(lost);
        }
        nodes.add_load(row, force);
        Some(place + foreseen.step + gap)
    }
}

/// How a tool holds, as kernels see it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct GripRow {
    closed: u32,
    reach: f32,
    strength: f32,
    counts_work: u32,
}
uniform!(GripRow { closed, reach, strength, counts_work });

/// How many grasps there are, and how many numbers of each.
fn counts(grasps: &Grasps) -> String {
    let (count, numbers) = (grasps.grasps.len(), grasps.numbers_a_grasp());
    format!("const GRASPS: u32 = {count}u;\nconst NUMBERS: u32 = {numbers}u;\n")
}

/// One stage for each body that tools may hold.
fn stages(world: &mut World, buffers: &mut dyn Buffers) -> Vec<NodeStage> {
    let all: Vec<(Entity, Grasps)> =
        world.query::<(Entity, &Grasps)>().iter(world).map(|(body, grasps)| (body, grasps.clone())).collect();
    all.into_iter().map(|(body, grasps)| stage(body, &grasps, world, buffers)).collect()
}

fn stage(body: Entity, grasps: &Grasps, world: &mut World, buffers: &mut dyn Buffers) -> NodeStage {
    let of = ToolNodes {
        system: "grasp",
        twin: shader!("grasp"),
        counts: counts(grasps),
        tools: grasps.grasps.iter().map(|grasp| &grasp.tool).collect(),
        reference: grasps.reference,
        rows: &grasps.rows,
        masks: &grasps.masks,
        nodes: "holdable",
        column: ToolHold::NAME,
    };
    let stage = tool_stage(body, of, world, buffers);
    let counts_work = u32::from(world.resource::<Clock>().relaxation.is_none());
    // infinity is no number that a shader must know
    let number = |number: f64| (number as f32).min(f32::MAX);
    let grip = |grasp: &Grasp| GripRow {
        closed: grasp.closed as u32,
        reach: number(grasp.reach.unwrap_or(f64::INFINITY)),
        strength: number(grasp.strength),
        counts_work,
    };
    let grips: Vec<u8> = grasps.grasps.iter().flat_map(|grasp| grip(grasp).bytes()).collect();
    stage.bind_uniform::<GripRow>("grips", buffers.uniform("grips".into(), &grips))
}
