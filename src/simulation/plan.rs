//! The plan of a step: which systems share a pass, and in which order passes run, on the CPU and on a GPU. It is made
//! once, from what systems are and what they touch, never from their names; the host's passes, a GPU's kernels and
//! `explain` all follow it.

mod grouping;

use super::schedule::Scheduled;
use super::scheme::Summed;
use crate::backend::dispatch::Dispatched;
use crate::backend::kernel::Kernel;
use crate::components::{ColumnAccess, Role, Touched, column_is};
use crate::systems::{Phase, Repeat, RowSet};
use bevy_ecs::prelude::World;
use bevy_ecs::system::SystemAccess;
use grouping::Grouping;

/// A step as passes over what its systems touch.
pub(super) struct Plan {
    /// The systems, in the order of the schedule.
    pub systems: Vec<Planned>,
    on_cpu: Vec<Pass>,
    on_gpu: Vec<Pass>,
    /// Places of the passes on a GPU that sum forces of elements and that move nodes: where the second follows the
    /// first at once, and where a step is nothing else that changes anything; else what is in the way.
    elements_then_nodes: Result<[usize; 2], String>,
    nothing_else: Result<[usize; 2], String>,
    /// How the forces of elements are summed, body by body.
    pub summed: Summed,
    /// How the GPU that runs it takes each body through it; `None` where none does.
    pub dispatched: Option<Vec<Dispatched>>,
}

/// A system of a plan.
pub(super) struct Planned {
    /// Its name.
    pub name: String,
    /// Its place in the step.
    pub phase: Phase,
    /// Why it is there.
    pub because: String,
    /// For which nodes it is, where it works node by node.
    pub rows: Option<RowSet>,
    /// Whether it fetches what it reads from a device by itself.
    pub observes: bool,
    /// Whether a GPU has it.
    pub on_device: bool,
    /// Steps between two runs.
    pub every: u64,
    /// Whether it finds forces, or what those of others need: threads are looked at before all.
    pub finds_forces: bool,
    /// Names of the columns that it reads and writes.
    pub reads: Vec<&'static str>,
    pub writes: Vec<&'static str>,
}

/// Systems that run together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Pass {
    pub over: Over,
    /// Places in [`Plan::systems`], in the order in which they run.
    pub systems: Vec<usize>,
    /// Systems that nodes go through at once, and those of surfaces only in passes to come: what is between concerns
    /// these.
    pub ahead: Vec<usize>,
    /// How many passes there are between if all of them may sleep, else none: in steps in which they do, all nodes go
    /// through the systems ahead at once, and neither those passes nor the one to come is run.
    pub sleepers: usize,
    /// What of it a step repeats: on a GPU those of its kernels that say so, on the CPU its system by itself.
    pub repeat: Option<Repeat>,
}

impl Pass {
    /// What stands for the kernels of the pass on a GPU, as often as a step runs them and in that order.
    pub fn spread<T: Clone>(&self, kernels: &[Kernel], all: &[T]) -> Vec<T> {
        self.repeat.as_ref().map_or_else(|| all.to_vec(), |repeat| repeat.spread(kernels, all))
    }
}

/// What a pass goes over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Over {
    /// Whatever its one system does.
    Itself,
    /// Nodes: a task takes some rows through all systems.
    Nodes,
    /// Patches of elements, whose forces the first system finds; nodes inside a patch go through the other systems
    /// while they are in the core's cache, all others afterwards.
    Elements,
    /// Nodes of surfaces, which have waited.
    Shared,
}

/// Marks what is before forces and makes, for the step that it is in, what one that finds forces reads.
fn mark_what_forces_need(systems: &mut [Planned]) {
    let is_scratch = |column: &ColumnAccess| column.role == Role::Scratch;
    let finders = systems.iter().filter(|system| system.finds_forces);
    let needed: Vec<&str> =
        finders.flat_map(|system| &system.reads).copied().filter(|name| column_is(name, is_scratch)).collect();
    for system in systems.iter_mut().filter(|system| system.phase <= Phase::Boundary) {
        system.finds_forces |= system.writes.iter().any(|column| needed.contains(column));
    }
}

impl Plan {
    /// Of a schedule, whose systems touch so much. Without `fuse` each system has a pass of its own.
    pub fn of(schedule: &[Scheduled<'_>], access: &[SystemAccess], fuse: bool, world: &mut World) -> Self {
        let row_set = |of: &Scheduled<'_>| Some(of.system.host.nodes()?.row_set(world));
        let rows: Vec<Option<RowSet>> = schedule.iter().map(row_set).collect();
        let world = &*world;
        let planned = |((scheduled, access), rows): ((&Scheduled<'_>, &SystemAccess), Option<RowSet>)| {
            let Scheduled { system, because, every, .. } = scheduled;
            let touched = Touched(access);
            let names = |columns: Vec<ColumnAccess>| columns.into_iter().map(|column| column.name).collect();
            Planned {
                name: system.name.clone(),
                phase: system.phase,
                because: because.clone(),
                rows,
                observes: system.observes,
                on_device: scheduled.on_device,
                every: *every,
                finds_forces: system.phase > Phase::Boundary && system.phase < Phase::Integrate,
                reads: names(touched.read_columns(world)),
                writes: names(touched.written_columns(world)),
            }
        };
        let passes = |on_gpu: bool| -> Vec<Pass> {
            let grouping = Grouping { schedule, access, on_gpu };
            let groups = if fuse { grouping.groups() } else { (0..schedule.len()).map(|place| vec![place]).collect() };
            let pass = |systems: Vec<usize>| Pass {
                over: grouping.over(&systems),
                repeat: grouping.repeat(&systems, world),
                systems,
                ahead: Vec::new(),
                sleepers: 0,
            };
            let passes = groups.into_iter().map(pass).collect();
            if fuse && !on_gpu { grouping.ahead(passes, world) } else { passes }
        };
        let (on_cpu, on_gpu) = (passes(false), passes(true));
        let gpu = Grouping { schedule, access, on_gpu: true };
        let mut systems: Vec<Planned> = schedule.iter().zip(access).zip(rows).map(planned).collect();
        mark_what_forces_need(&mut systems);
        Self {
            systems,
            elements_then_nodes: gpu.elements_then_nodes(&on_gpu),
            nothing_else: gpu.nothing_but_elements_then_nodes(&on_gpu),
            on_cpu,
            on_gpu,
            summed: Summed::default(),
            dispatched: None,
        }
    }

    /// The passes of a backend, in the order in which they run.
    pub fn passes(&self, on_gpu: bool) -> &[Pass] {
        if on_gpu { &self.on_gpu } else { &self.on_cpu }
    }

    /// Places on a GPU of the pass of element forces and of that over nodes which moves them at once; else what is in
    /// the way of moving nodes as soon as the forces on them are known.
    pub fn elements_then_nodes(&self) -> Result<[usize; 2], &str> {
        self.elements_then_nodes.as_ref().copied().map_err(String::as_str)
    }

    /// The same where a step is nothing else that changes anything; else what is in the way of taking steps one after
    /// the other in a kernel.
    pub fn nothing_but_elements_then_nodes(&self) -> Result<[usize; 2], &str> {
        self.nothing_else.as_ref().copied().map_err(String::as_str)
    }

    /// The systems of a pass.
    pub fn systems_of<'a>(&'a self, pass: &'a Pass) -> impl Iterator<Item = &'a Planned> {
        pass.systems.iter().map(|&place| &self.systems[place])
    }
}

/// Names, each once.
pub(super) fn each_once(all: impl IntoIterator<Item = &'static str>) -> Vec<&'static str> {
    let mut names: Vec<&'static str> = Vec::new();
    for name in all {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}
