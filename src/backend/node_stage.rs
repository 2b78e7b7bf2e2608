//! Systems that work node by node: each in a kernel of its own, or neighbours of a step in one. Of small bodies the
//! element forces come into that kernel, too, which then takes many steps.

mod fused;
mod items;

use super::Buffers;
use super::kernel::{BufferId, Fragment, Kernel, Layout, MostBuffers, Uniform, uniform};
use super::step::{step_fragments, step_in_a_uniform};
use crate::components::{Column, Displacement, ElementForce, GROUP_ROWS, Mass};
use crate::shader;
use bevy_ecs::prelude::*;
use fused::Fused;
pub(crate) use items::renamed;
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
    shared: Vec<Fragment>,
    columns: Vec<(&'static str, BufferId)>,
    bindings: Vec<(Cow<'static, str>, BufferId)>,
    layouts: Vec<(Cow<'static, str>, Layout)>,
    elsewhere: Vec<&'static str>,
    loaded: bool,
    forces: Forces,
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
    /// A part of what moves the nodes in several kernels: its text asks for forces.
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
            shared: Vec::new(),
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
        let fragments = kernel.fragments.into_iter().filter(|fragment| *fragment != frame);
        let (shared, own) = fragments.partition(|fragment| step.contains(fragment));
        let column = |name: &str| [Displacement::NAME, ElementForce::NAME].into_iter().find(|column| *column == name);
        let columns = kernel.bindings.iter().filter_map(|(name, buffer)| Some((column(name)?, *buffer))).collect();
        let bindings = kernel.bindings.iter().filter(|(name, _)| column(name).is_none()).cloned().collect();
        let stage = Self::new("element_forces", "sum_patch", body, rows_of(body, world), frame);
        Self { rows: Rows::Patch, own, shared, columns, bindings, layouts: kernel.layouts, ..stage }
    }

    /// The same for some of the body's nodes, one after the other; `None` where there is nothing to do for them.
    pub(super) fn within(&self, nodes: Range<u32>) -> Option<Self> {
        match &self.rows {
            Rows::Some(rows) if !rows.iter().any(|row| nodes.contains(row)) => None,
            _ if nodes.is_empty() => None,
            _ => Some(Self { within: nodes, ..self.clone() }),
        }
    }

    /// The same for nodes inside a patch, in the kernel of that patch: forces are at hand.
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

    /// Calls `finish(place in the workgroup, node)` afterwards, in all invocations.
    pub fn finish(mut self, finish: &'static str) -> Self {
        self.finish = Some(finish);
        self
    }

    /// Adds a piece of WGSL that may name things as it likes: what another stage calls the same is renamed.
    pub fn own(mut self, fragment: Fragment) -> Self {
        self.own.push(fragment);
        self
    }

    /// Adds a piece of WGSL that other stages may have too, and share.
    pub fn shared(mut self, fragment: Fragment) -> Self {
        self.shared.push(fragment);
        self
    }

    /// Adds what declares `step` for a world's signals.
    pub fn with_step(self, world: &World) -> Self {
        step_fragments(world).into_iter().fold(self, Self::shared)
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
    pub fn bind_uniform<U: Uniform>(mut self, variable: &'static str, buffer: BufferId) -> Self {
        self.layouts.push((variable.into(), U::LAYOUT));
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
struct NodePass {
    count: u32,
    first: u32,
}
uniform!(NodePass { count, first });

/// Kernels of stages that follow one another in a step. Those of one body share as few kernels as can be: none in which
/// a stage reads of other nodes what another writes, and none with more storage buffers than the device has for a
/// kernel. With `fuse` false each has its own.
pub fn node_kernels(stages: Vec<NodeStage>, fuse: bool, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let mut bodies: Vec<Entity> = Vec::new();
    for stage in &stages {
        if !bodies.contains(&stage.body) {
            bodies.push(stage.body);
        }
    }
    let mut kernels = Vec::new();
    for body in bodies {
        let mut waiting: Vec<&NodeStage> = Vec::new();
        for stage in stages.iter().filter(|stage| stage.body == body) {
            waiting.push(stage);
            if waiting.len() == 1 || (fuse && why_apart(&waiting, buffers.most_buffers()).is_none()) {
                continue;
            }
            let before = &waiting[..waiting.len() - 1];
            kernels.push(node_pass(before, buffers));
            waiting = vec![stage];
        }
        if !waiting.is_empty() {
            kernels.push(node_pass(&waiting, buffers));
        }
    }
    kernels
}

/// Buffers of a kernel that several stages share, however many the device allows: what more loads gain is little.
pub(super) const MOST_SHARED: MostBuffers = MostBuffers::new(32, 32);

/// Why not all may run in one kernel, where nodes go their way independently of each other, if so.
pub(super) fn why_apart(stages: &[&NodeStage], most: MostBuffers) -> Option<String> {
    let fused = Fused::of(stages);
    let looks =
        |stage: &&&NodeStage| stage.elsewhere.iter().any(|name| fused.written().any(|written| written == *name));
    if let Some(stage) = stages.iter().find(looks) {
        return Some(format!("`{}` looks at other nodes than its own, which must not have moved", stage.system));
    }
    let (storage, uniform) = (fused.storage(), fused.uniforms());
    MOST_SHARED.exceeded_by(storage, uniform).or_else(|| most.exceeded_by(storage, uniform))
}

/// A kernel of stages that may run in one, an invocation a node.
fn node_pass(stages: &[&NodeStage], buffers: &mut dyn Buffers) -> Kernel {
    let Range { start, end } = stages[0].within;
    let rows = match (stages, &stages[0].rows) {
        // places among the rows
        ([_], Rows::Some(rows)) => [start, end].map(|bound| rows.partition_point(|&row| row < bound) as u32),
        _ => [start, end],
    };
    let [first, count] = rows;
    let kernel = Fused::of(stages).into_kernel("node_pass", stages, NodePass { count, first }, buffers);
    kernel.fragment(shader!("row")).fragment(shader!("node_pass")).threads(count - first)
}

/// The same in one workgroup of so many invocations (a multiple of 128), for all steps of a submission: the stages of a
/// whole step.
pub(super) fn many_steps(stages: &[&NodeStage], invocations: usize, buffers: &mut dyn Buffers) -> Kernel {
    let width = format!("const INVOCATIONS: u32 = {invocations}u;\n");
    let rows = NodePass { count: stages[0].nodes, first: 0 };
    let mut kernel = Fused::of(stages).into_kernel("many_steps", stages, rows, buffers);
    // many_steps.wgsl says where `step` is
    kernel.fragments.retain(|fragment| *fragment != step_in_a_uniform());
    kernel
        .fragment(shader!("many_steps"))
        .fragment(Fragment::new("generated: how large the workgroup is", width))
        .threads(invocations as u32)
}

/// The kernel of a block's patches, of so many invocations in all, that moves the nodes inside each of them: the stages
/// of a whole step of these nodes.
pub(super) fn patch_step(stages: &[&NodeStage], invocations: u32, buffers: &mut dyn Buffers) -> Kernel {
    let least = format!("const LEAST_INSIDE: u32 = {GROUP_ROWS}u;\n");
    let node = &stages[stages.len() - 1];
    let rows = NodePass { count: node.nodes, first: node.within.start };
    Fused::of(stages)
        .into_kernel("patch_step", stages, rows, buffers)
        .fragment(shader!("patch_step"))
        .fragment(Fragment::new("generated: the least nodes inside a patch", least))
        .threads(invocations)
}
