//! Systems that work node by node: each in a kernel of its own, or neighbours of a step in one. Of small bodies the
//! element forces come into that kernel, too, which then takes many steps.

mod frames;
mod pass;

use super::Buffers;
use super::kernel::{BufferId, Fragment, Kernel, Layout, Link, Uniform, uniform};
use super::step::{step_fragments, step_record};
use crate::components::{Column, Displacement, ElementForce, Mass};
use crate::shader;
use bevy_ecs::prelude::*;
pub use frames::node_kernels;
pub(super) use frames::{Frame, MOST_SHARED, Shared, by_body, kernels_of, many_steps, patch_step, split, together};
use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

/// Describes what a system does to nodes, body by body, bound to buffers.
pub type DescribeStages = Arc<dyn Fn(&mut World, &mut dyn Buffers) -> Vec<NodeStage> + Send + Sync>;

/// What a system does to the nodes of one body: a WGSL function of a row, which kernels call.
#[derive(Clone, Debug)]
pub struct NodeStage {
    body: Entity,
    system: Cow<'static, str>,
    /// The WGSL function: of a node, of a place in `rows` and the node there, or of a patch and an invocation.
    call: Cow<'static, str>,
    /// Called by all invocations of a workgroup after that, with their place in it and their row.
    finish: Option<&'static str>,
    nodes: u32,
    /// Those of the body's nodes that it is for.
    within: Range<u32>,
    rows: Rows,
    own: Vec<Fragment>,
    calls: Vec<Called>,
    /// What declares the step's record, but for where it is.
    step: Option<[Fragment; 2]>,
    columns: Vec<(&'static str, BufferId)>,
    bindings: Vec<(Cow<'static, str>, BufferId)>,
    layouts: Vec<(Cow<'static, str>, Layout)>,
    elsewhere: Vec<&'static str>,
    loaded: bool,
    forces: Forces,
}

/// A function that a stage calls and that somebody else has written, who may name things as the stage does.
#[derive(Clone, Debug)]
struct Called {
    /// What it is called by the stage, which declares it with a body that stands for it.
    function: Cow<'static, str>,
    /// What it is called by who has written it.
    name: Cow<'static, str>,
    own: Vec<Fragment>,
}

/// What a stage does with the forces on nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Forces {
    /// It adds to them, or has nothing to do with them.
    Adds,
    /// It sums those of elements and clears the loads of the last step.
    Sums,
    /// It uses them up, by moving the nodes.
    UsesUp,
    /// Its text asks for forces: a part of what moves the nodes in several kernels, or what foresees where they go.
    AsksFor,
}

/// What a stage's function is called for.
#[derive(Clone, Debug)]
enum Rows {
    All,
    Some(Vec<u32>),
    /// A patch of elements, before the nodes' turn.
    Patch,
}

impl NodeStage {
    /// For each of the body's nodes calls `call(node)`, which `fragment` declares.
    pub fn new(
        system: impl Into<Cow<'static, str>>,
        call: impl Into<Cow<'static, str>>,
        body: Entity,
        nodes: u32,
        fragment: Fragment,
    ) -> Self {
        Self {
            body,
            system: system.into(),
            call: call.into(),
            finish: None,
            nodes,
            within: 0..nodes,
            rows: Rows::All,
            own: vec![fragment],
            calls: Vec::new(),
            step: None,
            columns: Vec::new(),
            bindings: Vec::new(),
            layouts: Vec::new(),
            elsewhere: Vec::new(),
            loaded: false,
            forces: Forces::Adds,
        }
    }

    /// Only for some nodes, ascending: calls `call(i, node)` for each place `i` in `rows` and the node that is there.
    pub fn of_rows(mut self, rows: Vec<u32>) -> Self {
        self.rows = Rows::Some(rows);
        self
    }

    /// The kernel of a block's patches, but for its frame: forces that others in the same kernel can go on with.
    pub(crate) fn of_patch(kernel: Kernel, body: Entity, world: &World) -> Self {
        let (step, frame) = (step_fragments(world), shader!("patch_pass"));
        let calls = kernel.links.iter().flat_map(|Link { function, calls }| {
            calls.iter().map(|(unit, name)| Called {
                function: function.clone(),
                name: name.clone(),
                own: kernel.units[unit.0].own.clone(),
            })
        });
        let calls = calls.collect();
        let not_declared_by_all = |fragment: &Fragment| *fragment != frame && !step.contains(fragment);
        let own: Vec<Fragment> = kernel.fragments.into_iter().filter(not_declared_by_all).collect();
        let column = |name: &str| [Displacement::NAME, ElementForce::NAME].into_iter().find(|column| *column == name);
        let columns = kernel.bindings.iter().filter_map(|(name, buffer)| Some((column(name)?, *buffer))).collect();
        let bindings = kernel.bindings.iter().filter(|(name, _)| column(name).is_none()).cloned().collect();
        let stage = Self::new("element_forces", "sum_patch", body, rows_of(body, world), frame).with_step(world);
        Self { rows: Rows::Patch, own, calls, columns, bindings, layouts: kernel.layouts, ..stage }
    }

    /// The same for some of the body's nodes, one after the other; `None` where there is nothing to do for them.
    pub(super) fn within(&self, nodes: Range<u32>) -> Option<Self> {
        match &self.rows {
            Rows::Some(rows) if !rows.iter().any(|row| nodes.contains(row)) => None,
            _ if nodes.is_empty() => None,
            _ => Some(Self { within: nodes, ..self.clone() }),
        }
    }

    /// The same for nodes inside a patch, in the kernel of that patch: forces are in workgroup memory.
    pub(super) fn in_patch(self) -> Self {
        if !self.sums_forces() {
            return self;
        }
        let columns = self.columns.into_iter().filter(|(name, _)| *name != ElementForce::NAME).collect();
        Self { own: vec![shader!("patch_gather")], bindings: Vec::new(), columns, ..self }
    }

    /// Whether it sums the forces of elements.
    pub(super) fn sums_forces(&self) -> bool {
        self.forces == Forces::Sums
    }

    /// The body.
    pub fn body(&self) -> Entity {
        self.body
    }

    /// The system that it is of.
    pub fn system(&self) -> &str {
        &self.system
    }

    /// Calls `finish(place in the workgroup, node)` afterwards, in all invocations.
    pub fn finish(mut self, finish: &'static str) -> Self {
        self.finish = Some(finish);
        self
    }

    /// Adds a piece of WGSL. It may name things as it likes, whatever other stages call the same.
    pub fn own(mut self, fragment: Fragment) -> Self {
        self.own.push(fragment);
        self
    }

    /// Calls a function of somebody else's: the stage declares `function` with an empty body, and `own` the function
    /// `name`, which takes and gives the same. They do not see each other's names.
    pub fn calling(mut self, function: &'static str, name: impl Into<Cow<'static, str>>, own: Vec<Fragment>) -> Self {
        self.calls.push(Called { function: function.into(), name: name.into(), own });
        self
    }

    /// Adds what declares `step` for a world's signals.
    pub fn with_step(self, world: &World) -> Self {
        Self { step: Some(step_record(world)), ..self }
    }

    /// Binds a column of the body, or of a block of it, that other stages may use under the same name.
    pub fn column(mut self, name: &'static str, buffer: BufferId) -> Self {
        self.columns.push((name, buffer));
        self
    }

    /// Binds what no other stage uses.
    pub fn bind(mut self, variable: impl Into<Cow<'static, str>>, buffer: BufferId) -> Self {
        self.bindings.push((variable.into(), buffer));
        self
    }

    /// Binds a `var<uniform>`.
    pub fn bind_uniform<U: Uniform>(self, variable: &'static str, buffer: BufferId) -> Self {
        self.bind_laid_out(variable, Some(U::LAYOUT), buffer)
    }

    /// The same where its layout may be known.
    pub fn bind_laid_out(mut self, variable: &'static str, layout: Option<Layout>, buffer: BufferId) -> Self {
        self.layouts.extend(layout.map(|layout| (variable.into(), layout)));
        self.bind(variable, buffer)
    }

    /// Says that it reads a column of other nodes than its own: who writes that must not share a kernel with it.
    pub fn reads_elsewhere(mut self, name: &'static str) -> Self {
        self.elsewhere.push(name);
        self
    }

    /// Says that it sums the forces of elements and clears the loads of the last step.
    pub fn that_sums_forces(self) -> Self {
        Self { forces: Forces::Sums, ..self }
    }

    /// Says that it uses up forces by moving the nodes; or, where that takes `several` kernels, that it is a part of
    /// it.
    pub fn that_moves_nodes(self, several: bool) -> Self {
        Self { forces: if several { Forces::AsksFor } else { Forces::UsesUp }, ..self }
    }

    /// Says that it asks for forces that others have summed, and adds to them.
    pub(crate) fn that_asks_for_forces(self) -> Self {
        Self { forces: Forces::AsksFor, ..self }
    }

    /// Says whether the body has loads: whether there is a column of external forces.
    pub fn loaded(mut self, loaded: bool) -> Self {
        self.loaded = loaded;
        self
    }
}

/// How many nodes a body has.
pub fn rows_of(body: Entity, world: &World) -> u32 {
    world.get::<Mass>(body).map_or(0, |mass| mass.len()) as u32
}

/// The rows of a kernel of nodes: where they end, and where they begin.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct PassRows {
    count: u32,
    first: u32,
}
uniform!(PassRows { count, first });
