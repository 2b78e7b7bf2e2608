//! Loads that a scene has in WGSL alone (`systems` in the scene): each a system of its own name, which adds the force
//! that its function gives to every node. On the CPU a program translated from the text runs over registers of nodes;
//! on a GPU `shaders/own_load.wgsl` calls the text itself.

use super::node_system::{NodeRows, NodeSystem};
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::places_within;
use super::rows::Rows;
use super::stage::Stage;
use super::system::{Phase, System};
use crate::backend::cpu::{Asked, Cpu, NodeColumns};
use crate::backend::kernel::Fragment;
use crate::backend::user_law::callable_fragments_of_load;
use crate::components::*;
use crate::materials::program::Program;
use crate::math::{LANES, Real, SimdScalar};
use crate::shader;
use bevy_ecs::prelude::*;
use glam::DVec3;
use pulp::{Simd, WithSimd};
use serde::Serialize;

/// The system of a scene's own `name`, by its number among them; `what` it is, in a few words.
pub(super) fn system(name: &str, number: usize, what: String) -> System {
    System::of_scene(
        name,
        Phase::Loads,
        NodeRows::of::<OwnLoad>().of_system(number),
        "adds what a function of the scene's own gives to the external forces",
        "an entry under `systems`",
        what,
    )
    .with_twin::<OwnLoad>("own_load", shader!("own_load"), |_, stage| stage)
}

/// Nodes of each body at which slopes are taken, evenly from all; the lightest node is one more.
const TRIED: usize = 1000;
/// Times at which they are taken, evenly from the start to the end.
const TIMES: usize = 5;
/// Length of the differences, as a share of the body's size.
const LENGTH: f64 = 1e-6;

/// What is the same for all nodes in a step.
pub struct InStep {
    /// The curve.
    curve: f64,
    /// At the beginning of the step (s).
    time: f64,
    /// Δt (s).
    time_step: f64,
    /// What turns the last step into a velocity (1/s).
    rate: f64,
}

impl NodeSystem for OwnLoad {
    type Columns = (
        &'static RestPosition,
        &'static Displacement,
        &'static DisplacementIncrement,
        &'static Mass,
        &'static mut ExternalForce,
    );
    type Prepared = InStep;

    fn rows(&self) -> Rows<'_> {
        self.rows.as_deref().map_or(Rows::All, Rows::List)
    }

    fn stages(&self, _: Entity, world: &World) -> Vec<Stage> {
        let LoadText { name, path, text, uniform, .. } = &*self.text;
        let moves = world.resource::<Clock>().relaxation.is_none();
        let load = InKernels { signal: self.signal, velocity_factor: moves.into() };
        let arguments = if self.rows.is_some() { "i: u32, node: u32" } else { "node: u32" };
        let call = format!("fn own_load({arguments}) {{\n    own_load_on(node);\n}}\n");
        let mut own = callable_fragments_of_load();
        own.push(Fragment::new(path.clone(), text.clone()));
        let stage = Stage::of(self.rows()).uniform("load", &load).fragment(shader!("node_state"));
        let stage = stage.text(format!("generated: {name} on a node"), call);
        vec![stage.calling("force_on", name.clone(), own, uniform)]
    }

    fn prepare(&self, before: &Before<'_>) -> InStep {
        let Before { clock, signals, .. } = before;
        let curve = signals.values()[self.signal][0];
        InStep { curve, time: clock.time(), time_step: clock.time_step, rate: clock.rate() }
    }

    /// Differences at nodes at rest, at some times, with the curve at 1, or at the largest that an input has been.
    fn slopes(&self, nodes: &NodesAtRest<'_>) -> ForceSlopes {
        let rest = &nodes.rest.0;
        let moves = |row: &usize| nodes.moves(*row);
        let rows: Vec<usize> = match &self.rows {
            Some(rows) => rows.iter().map(|&row| row as usize).filter(moves).collect(),
            None => (0..rest.len()).filter(moves).collect(),
        };
        let (low, high) =
            rest.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
        let length = LENGTH * (high - low).max_element();
        let lightest = rows.iter().copied().min_by(|&a, &b| nodes.mass.get(a).total_cmp(&nodes.mass.get(b)));
        let every = rows.len().div_ceil(TRIED).max(1);
        let curve = nodes.signals.map_or(1.0, |signals| signals.largest_input(self.signal));
        let mut largest = ForceSlopes::default();
        for row in rows.iter().copied().step_by(every).chain(lightest) {
            for number in 0..TIMES {
                let time = nodes.duration * number as f64 / (TIMES - 1) as f64;
                let node = NodeAtRest { rest_position: rest[row], mass: nodes.mass.get(row), curve, time };
                let [stiffness, damping] = self.text.slopes(&node, length).map(|slope| slope / node.mass);
                // what is no number is the guards' business
                largest = largest.larger(ForceSlopes { stiffness, damping });
            }
        }
        largest
    }

    fn act<T: SimdScalar>(&self, step: &InStep, cpu: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        let (first, count) = (nodes.first, nodes.rows());
        nodes.reads(Asked::Displacement);
        nodes.reads(Asked::DisplacementIncrement);
        nodes.writes(Asked::ExternalForce);
        let mass = nodes.mass();
        let Some(external) = nodes.external.as_deref_mut() else { return };
        cpu.dispatch(Push {
            program: &self.text.program,
            in_step: step,
            first,
            count,
            rows: self.rows.as_ref().map(|rows| &rows[places_within(rows, first, count)]),
            rest: nodes.rest,
            u: &*nodes.u,
            step: &*nodes.step,
            mass,
            external,
        });
    }
}

struct Push<'a, T> {
    program: &'a Program,
    in_step: &'a InStep,
    /// The body's row of the first of these nodes, and how many they are.
    first: usize,
    count: usize,
    /// The body's rows of those that the load is for, where it is not for all.
    rows: Option<&'a [u32]>,
    rest: &'a [DVec3],
    u: &'a [T],
    step: &'a [T],
    mass: &'a [T],
    external: &'a mut [T],
}

/// Numbers of `Node` that differ from node to node: the first ones.
const OF_A_NODE: usize = LoadText::MASS + 1;

impl<T: SimdScalar> WithSimd for Push<'_, T> {
    type Output = ();

    /// A register full of nodes at a time; what a node gets does not depend on its place there. Only what the program
    /// reads is gathered.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let width = T::width::<S>();
        let splat = |number: f64| T::splat(simd, T::from_f64(number));
        let Push { program, in_step, first, count, rows, rest, u, step, mass, external } = self;
        let InStep { curve, time, time_step, rate } = *in_step;
        let rate = T::from_f64(rate);
        let mut inputs = [splat(0.0); LoadText::NUMBERS];
        inputs[OF_A_NODE..].copy_from_slice(&[splat(curve), splat(time), splat(time_step)]);
        let reads: [bool; OF_A_NODE] = std::array::from_fn(|number| program.reads(number));
        let all = rows.map_or(count, <[u32]>::len);
        for from in (0..all).step_by(width) {
            let lanes = width.min(all - from);
            // the row among these nodes of one of those that the load is for
            let row = |lane| rows.map_or(from + lane, |rows| rows[from + lane] as usize - first);
            for i in 0..3 {
                if reads[i] {
                    inputs[i] = gathered(simd, lanes, |lane| T::from_f64(rest[row(lane)][i]));
                }
                if reads[3 + i] {
                    inputs[3 + i] = gathered(simd, lanes, |lane| u[3 * row(lane) + i]);
                }
                if reads[6 + i] {
                    inputs[6 + i] = gathered(simd, lanes, |lane| step[3 * row(lane) + i] * rate);
                }
            }
            // what has lost all its elements bears nothing
            let there = gathered(simd, lanes, |lane| mass[row(lane)]);
            inputs[LoadText::MASS] = there;
            let force: [T::Vector<S>; 3] = program.run(inputs);
            let mut added = [T::default(); 3 * LANES];
            for (i, force) in force.into_iter().enumerate() {
                let mut numbers = [T::default(); LANES];
                T::store(there.if_positive(force, splat(0.0)), &mut numbers);
                for (to, number) in added.iter_mut().skip(i).step_by(3).zip(numbers) {
                    *to = number;
                }
            }
            for (lane, added) in added.chunks_exact(3).enumerate().take(lanes) {
                for (external, added) in external[3 * row(lane)..][..3].iter_mut().zip(added) {
                    *external += *added;
                }
            }
        }
    }
}

/// A register of what some lanes have; zeros in the others.
#[inline(always)]
fn gathered<T: SimdScalar, S: Simd>(simd: S, lanes: usize, of_lane: impl Fn(usize) -> T) -> T::Vector<S> {
    let mut numbers = [T::default(); LANES];
    for (lane, number) in numbers.iter_mut().enumerate().take(lanes) {
        *number = of_lane(lane);
    }
    T::load(simd, &numbers)
}

#[derive(Serialize)]
struct InKernels {
    /// Slot of the curve.
    signal: usize,
    /// 1; 0 in a static analysis, whose steps are no motion.
    velocity_factor: f32,
}
