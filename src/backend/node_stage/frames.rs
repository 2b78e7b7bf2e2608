//! The kernels that stages can be in, and which stages share one.

use super::pass::{Pass, written};
use super::{NodePass, NodeStage, Rows};
use crate::backend::Buffers;
use crate::backend::kernel::{Fragment, Kernel, MostBuffers};
use crate::backend::patch_lists::BATCH_GROUPS;
use crate::backend::step::{step_in_a_uniform, step_in_a_workgroup};
use crate::components::GROUP_ROWS;
use crate::math::LANES;
use crate::shader;
use bevy_ecs::prelude::*;
use std::ops::Range;

/// A kernel that calls stages, but for them.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Its entry point.
    pub(super) entry: &'static str,
    /// Invocations of a workgroup.
    pub(super) invocations: usize,
    /// Declares `step`.
    pub(super) step: Fragment,
    /// What it declares for stages of nodes, too.
    pub(super) common: Option<Fragment>,
    pub(super) own: Vec<Fragment>,
    /// Whether the first stage is of patches and stands in the frame itself, which goes on with what it declares.
    pub(super) has_patch: bool,
}

impl Frame {
    /// An invocation a node.
    pub fn node_pass() -> Self {
        Self {
            entry: "node_pass",
            invocations: 64,
            step: step_in_a_uniform(),
            common: None,
            own: vec![shader!("row"), shader!("node_pass")],
            has_patch: false,
        }
    }

    /// One workgroup of so many invocations (a multiple of 128), for all steps of a submission: the stages of a whole
    /// step.
    pub fn many_steps(invocations: usize) -> Self {
        Self {
            entry: "many_steps",
            invocations,
            step: step_in_a_workgroup(),
            common: None,
            own: vec![shader!("many_steps")],
            has_patch: false,
        }
    }

    /// The kernel of a block's patches that moves the nodes inside each of them: the stages of a whole step of these
    /// nodes.
    pub fn patch_step() -> Self {
        let force = "var<private> force_of_patch: vec3<f32>;\n";
        let least = format!("const LEAST_INTERIOR: u32 = {GROUP_ROWS}u;\n");
        Self {
            entry: "patch_step",
            invocations: BATCH_GROUPS * LANES,
            step: step_in_a_uniform(),
            common: Some(Fragment::new("generated: the force that a patch has on a node (N)", force)),
            own: vec![shader!("patch_step"), Fragment::new("generated: the least nodes inside a patch", least)],
            has_patch: true,
        }
    }
}

/// Buffers of a kernel that several stages share, however many the device allows: what more loads gain is little.
pub const MOST_SHARED: MostBuffers = MostBuffers::new(32, 32);

/// How the stages of a body are shared among kernels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shared {
    body: Entity,
    /// How many stages each kernel has, in their order.
    stages: Vec<usize>,
}

/// How stages that follow one another in a step share kernels. Those of one body are in as few as can be: none in which
/// a stage reads of other nodes what another writes, and none with more storage buffers than the device has for a
/// kernel. With `fuse` false each has its own.
pub fn shared(stages: &[NodeStage], fuse: bool, buffers: &mut dyn Buffers) -> Vec<Shared> {
    let mut all: Vec<Shared> = Vec::new();
    for stage in stages {
        if !all.iter().any(|shared| shared.body == stage.body) {
            all.push(Shared { body: stage.body, stages: Vec::new() });
        }
    }
    for shared in &mut all {
        let of_body = of_body(shared.body, stages);
        let mut rest = of_body.as_slice();
        while !rest.is_empty() {
            let count = if fuse { first_together(rest, buffers) } else { 1 };
            shared.stages.push(count);
            rest = &rest[count..];
        }
    }
    all
}

/// Kernels of stages, shared as it was decided.
pub fn kernels_as_shared(stages: &[NodeStage], shared: &[Shared], buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let mut kernels = Vec::new();
    for Shared { body, stages: counts } in shared {
        let of_body = of_body(*body, stages);
        let mut rest = of_body.as_slice();
        for &count in counts {
            let (together, others) = rest.split_at(count.min(rest.len()));
            if !together.is_empty() {
                kernels.push(node_pass(together, buffers));
            }
            rest = others;
        }
    }
    kernels
}

/// Kernels of stages that follow one another in a step: see [`shared`].
pub fn node_kernels(stages: Vec<NodeStage>, fuse: bool, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let shared = shared(&stages, fuse, buffers);
    kernels_as_shared(&stages, &shared, buffers)
}

fn of_body(body: Entity, stages: &[NodeStage]) -> Vec<&NodeStage> {
    stages.iter().filter(|stage| stage.body == body).collect()
}

/// How many of the first stages may share a kernel.
fn first_together(stages: &[&NodeStage], buffers: &mut dyn Buffers) -> usize {
    let most = buffers.most_buffers();
    let mut fit = |count: &usize| may_share(&stages[..*count], Frame::node_pass(), most, buffers).is_ok();
    // most often all of them
    if stages.len() > 1 && fit(&stages.len()) {
        return stages.len();
    }
    (2..stages.len()).take_while(fit).last().unwrap_or(1)
}

/// Looks whether stages may be in one kernel, where nodes go their way independently of each other; or why not.
pub fn may_share(
    stages: &[&NodeStage],
    frame: Frame,
    most: MostBuffers,
    buffers: &mut dyn Buffers,
) -> Result<(), String> {
    let pass = Pass::of(stages, frame);
    let kernel = pass.kernel();
    let composed = buffers.compose(kernel).map_err(|error| format!("they make no kernel together: {error}"))?;
    let Some(entry) = composed.entry(kernel.entry) else { return Err(format!("there is no `{}`", kernel.entry)) };
    let written = written(&composed, entry);
    if let Some(stage) = stages.iter().find(|stage| stage.elsewhere.iter().any(|name| written.contains(name))) {
        return Err(format!("`{}` looks at other nodes than its own, which must not have moved", stage.system));
    }
    let storage = composed.storage_buffers(entry);
    let uniform = entry.uses.len() - storage;
    match MOST_SHARED.exceeded_by(storage, uniform).or_else(|| most.exceeded_by(storage, uniform)) {
        Some(reason) => Err(reason),
        None => Ok(()),
    }
}

/// A kernel of stages with an invocation a node.
fn node_pass(stages: &[&NodeStage], buffers: &mut dyn Buffers) -> Kernel {
    let Range { start, end } = stages[0].within;
    let rows = match (stages, &stages[0].rows) {
        // places among the rows
        ([_], Rows::Some(rows)) => [start, end].map(|bound| rows.partition_point(|&row| row < bound) as u32),
        _ => [start, end],
    };
    let [first, count] = rows;
    let pass = Pass::of(stages, Frame::node_pass());
    pass.into_kernel(stages, NodePass { count, first }, buffers).threads(count - first)
}

/// The kernel of [`Frame::many_steps`].
pub fn many_steps(stages: &[&NodeStage], invocations: usize, buffers: &mut dyn Buffers) -> Kernel {
    let rows = NodePass { count: stages[0].nodes, first: 0 };
    let pass = Pass::of(stages, Frame::many_steps(invocations));
    pass.into_kernel(stages, rows, buffers).threads(invocations as u32)
}

/// The kernel of [`Frame::patch_step`], of so many invocations in all.
pub fn patch_step(stages: &[&NodeStage], invocations: u32, buffers: &mut dyn Buffers) -> Kernel {
    let pass = Pass::of(stages, Frame::patch_step());
    let node = &stages[stages.len() - 1];
    let rows = NodePass { count: node.nodes, first: node.within.start };
    pass.into_kernel(stages, rows, buffers).threads(invocations)
}
