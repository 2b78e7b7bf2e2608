//! `integrate`: moves the nodes. `shaders/integrate.wgsl` is its twin.

use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::system::{Phase, System};
use crate::backend::Buffers;
use crate::backend::cpu::{Cpu, IntegrationCoefficients, NodeColumns, move_nodes};
use crate::backend::kernel::Fragment;
use crate::backend::node_stage::NodeStage;
use crate::components::*;
use crate::math::SimdScalar;
use crate::shader;
use bevy_ecs::prelude::*;
use std::sync::atomic::Ordering;

/// Central differences in velocity form, damping centred: with a = cΔt/(2m),
/// d ← ((1 − a) d + Δt² (R − F)/m)/(1 + a), u ← u + d.
///
/// The first step starts half way, d ← (1 − a) d + ½Δt² (R − F)/m with d = v₀Δt, so that free fall is exact. Stable iff
/// ωΔt ≤ 2 for any damping. The classical form with three coefficients loses 2 to 10 % in f32, this one 1e-6; with
/// [`DisplacementCompensation`] the sum of steps is as good as in f64. Where Δt changes, d is scaled to the new one
/// beforehand, and forces act over the mean of both, (Δt + Δt')/2 in place of Δt in the push and in a. Constrained axes
/// take the step that `boundary` wrote; nodes without mass are inactive.
///
/// In a static analysis the same recursion relaxes: the mass is [`InertialMass`], a is one number for all nodes, and
/// forces are multiplied with a force scale ([`Relaxation`]).
pub fn system() -> System {
    System::built_in_nodes::<Body>(
        "integrate",
        Phase::Integrate,
        "moves the nodes by one step of central differences",
        "bodies",
        |world| match world.contains_resource::<TrialForces>() {
            // the solver moves them
            true => None,
            false => super::registry::count::<Displacement>(world, "body", "bodies"),
        },
    )
    .on_nodes(stages)
}

impl NodeSystem for Body {
    type Columns = (
        (&'static Mass, Option<&'static InertialMass>, Option<&'static DampingCoefficient>),
        (&'static InternalForce, Option<&'static ExternalForce>, &'static ConstrainedAxes),
        (&'static mut Displacement, &'static mut DisplacementIncrement, Option<&'static mut DisplacementCompensation>),
        (Option<&'static mut Work>, Option<&'static mut InternalWork>, Option<&'static PreviousPrescribedIncrement>),
        &'static mut FirstNonFinite,
    );
    type Prepared = Clock;
    const MOVES_NODES: bool = true;

    fn prepare(&self, before: &Before<'_>) -> Clock {
        *before.clock
    }

    /// None: it adds no forces.
    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes::NONE
    }

    fn act<T: SimdScalar>(&self, clock: &Clock, cpu: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        // the formula above a register full at a time (`register` in `node_kernel.rs`); fixed axes keep their step of 0
        if let Some(row) = move_nodes(cpu, nodes, &IntegrationCoefficients::of(clock)) {
            nodes.non_finite.fetch_min(row, Ordering::Relaxed);
        }
    }
}

/// One stage for each body, of what the body has columns for; two where that is more than a kernel may have.
fn stages(world: &mut World, buffers: &mut dyn Buffers) -> Vec<NodeStage> {
    let mut query = world.query::<(Entity, &Mass, Has<ExternalForce>, Has<DampingCoefficient>, Has<Work>)>();
    let bodies: Vec<_> = query.iter(world).map(|(body, mass, e, d, w)| (body, mass.len() as u32, [e, d, w])).collect();
    let mut stages = Vec::new();
    for (body, count, optional) in bodies {
        let relaxed = world.get_resource::<Clock>().is_some_and(|clock| clock.relaxation.is_some());
        let guarded = world.get::<InternalWork>(body).map(|_| place_in_buffer::<InternalWork>(body, world));
        let previous = world.get::<PreviousPrescribedIncrement>(body);
        let previous = previous.map(|_| place_in_buffer::<PreviousPrescribedIncrement>(body, world));
        let inertial = world.get::<InertialMass>(body).is_some();
        let compensated = world.get::<DisplacementCompensation>(body).is_some();
        let [external, damped, worked] = optional;
        let most = buffers.most_buffers().storage;
        let mut stage = |call: &'static str, columns: &[&'static str]| {
            let stage = NodeStage::new("integrate", call, body, count, shader!("integrate"))
                .with_step(world)
                .that_moves_nodes(call != "integrate");
            let stage =
                with_optional(stage, [damped, worked], compensated, relaxed, (guarded, previous)).loaded(external);
            let stage = columns.iter().fold(stage, |stage, &name| {
                let column = match name {
                    Mass::NAME if inertial => InertialMass::NAME,
                    FirstNonFinite::BUFFER => FirstNonFinite::NAME,
                    _ => name,
                };
                stage.column(name, buffers.column(body, column))
            });
            if guarded.is_some() && call != "integrate_move" { stage.finish("add_up_internal_work") } else { stage }
        };
        let mut push = vec![Mass::NAME, InternalForce::NAME, ConstrainedAxes::NAME, DisplacementIncrement::NAME];
        push.extend(external.then_some(ExternalForce::NAME));
        push.extend(damped.then_some(DampingCoefficient::NAME));
        push.extend(worked.then_some(Work::NAME));
        let mut displace = vec![Displacement::NAME, FirstNonFinite::BUFFER];
        let compensation = compensated.then_some(DisplacementCompensation::NAME);
        if push.len() + displace.len() + usize::from(compensated) <= most {
            push.extend(displace);
            push.extend(compensation);
            stages.push(stage("integrate", &push));
        } else {
            displace.extend([DisplacementIncrement::NAME, ConstrainedAxes::NAME]);
            push.extend(guarded.map(|_| InternalWork::BUFFER));
            push.extend(compensation);
            displace.extend(compensation);
            stages.push(stage("integrate_push", &push));
            stages.push(stage("integrate_move", &displace));
        }
    }
    stages
}

/// What declares `damped`: what is left of a push.
pub(super) fn damping_fragment(damped: bool, relaxed: bool) -> Fragment {
    match (damped, relaxed) {
        (true, _) => shader!("damping_coefficient"),
        (false, true) => shader!("relaxation"),
        (false, false) => Fragment::new(
            "generated: no damping",
            "fn damped(node: u32, before: vec3<f32>, pushed: vec3<f32>, per_mass: f32) -> vec3<f32> {\n    return \
             pushed;\n}\n",
        ),
    }
}

/// Fragments of the columns a body has, and a line for each that it has not.
fn with_optional(
    stage: NodeStage,
    [damped, worked]: [bool; 2],
    compensated: bool,
    relaxed: bool,
    (guarded, previous): (Option<usize>, Option<usize>),
) -> NodeStage {
    let mut without = String::new();
    let mut fragments = Vec::new();
    fragments.push(damping_fragment(damped, relaxed));
    if worked {
        fragments.push(shader!("work"));
        if !damped {
            without += "fn coefficient_of(node: u32) -> f32 {\n    return 0.0;\n}\n";
        }
    } else {
        without += "fn accumulate_work(node: u32, before: vec3<f32>, after: vec3<f32>, constrained: vec3<bool>, \
                    inner: vec3<f32>, outer: vec3<f32>) {}\n";
    }
    if let Some(at) = guarded {
        fragments.push(shader!("internal_work"));
        without += &format!("const INTERNAL_WORK_AT: u32 = {at}u;\nconst GROUP_ROWS: u32 = {GROUP_ROWS}u;\n");
        without += "fn step_before(node: u32) -> vec3<f32> {\n";
        without += &match previous {
            None => "    return vec3<f32>(0.0);\n}\n".to_string(),
            Some(at) => {
                let word = |i: usize| format!("bitcast<f32>(atomicLoad(&node_diagnostics[{}u + 3u * node]))", at + i);
                format!("    return vec3<f32>({}, {}, {});\n}}\n", word(0), word(1), word(2))
            }
        };
    } else {
        without += "fn add_internal_work(node: u32, before: vec3<f32>, after: vec3<f32>, constrained: vec3<bool>, inner: vec3<f32>) {}\n";
    }
    if compensated {
        fragments.push(shader!("displacement_compensation"));
    } else {
        without += "fn add_to_step(node: u32, before: vec3<f32>, change: vec3<f32>) -> vec3<f32> {\n    \
                    return before + change;\n}\nfn forget_step(node: u32) {}\n\
                    fn add_step(node: u32, u: vec3<f32>, d: vec3<f32>, constrained: vec3<bool>) -> vec3<f32> {\n    \
                    return u + d;\n}\n";
    }
    let stage = fragments.into_iter().fold(stage, NodeStage::own);
    stage.own(Fragment::new("generated: what the body has and lacks", without))
}
