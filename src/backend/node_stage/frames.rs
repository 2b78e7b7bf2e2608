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
        let of_body: Vec<&NodeStage> = stages.iter().filter(|stage| stage.body == body).collect();
        let mut rest = of_body.as_slice();
        while !rest.is_empty() {
            let (count, pass) = if fuse { first_together(rest, buffers) } else { (1, alone(rest[0])) };
            kernels.push(node_pass(pass, &rest[..count], buffers));
            rest = &rest[count..];
        }
    }
    kernels
}

/// As many of the first stages as may share a kernel.
fn first_together(stages: &[&NodeStage], buffers: &mut dyn Buffers) -> (usize, Pass) {
    let most = buffers.most_buffers();
    let mut together = |count: usize| together(&stages[..count], Frame::node_pass(), most, buffers).ok();
    // most often all of them
    if let Some(pass) = together(stages.len()).filter(|_| stages.len() > 1) {
        return (stages.len(), pass);
    }
    let fitting = (2..stages.len()).map_while(|count| Some((count, together(count)?)));
    fitting.last().unwrap_or_else(|| (1, alone(stages[0])))
}

fn alone(stage: &NodeStage) -> Pass {
    Pass::of(&[stage], Frame::node_pass())
}

/// Stages in one kernel, where nodes go their way independently of each other; or why they cannot be.
pub fn together(
    stages: &[&NodeStage],
    frame: Frame,
    most: MostBuffers,
    buffers: &mut dyn Buffers,
) -> Result<Pass, String> {
    let pass = Pass::of(stages, frame);
    let kernel = pass.kernel();
    let composed = buffers.compose(kernel).map_err(|error| format!("they make no kernel together: {error}"))?;
    let Some(entry) = composed.entry(kernel.entry) else { return Err(format!("there is no `{}`", kernel.entry)) };
    let written = written(&composed, entry);
    if let Some(stage) = stages.iter().find(|stage| stage.elsewhere.iter().any(|name| written.contains(name))) {
        return Err(format!("`{}` reads other nodes than its own, which must not have moved", stage.system));
    }
    let storage = composed.storage_buffers(entry);
    let uniform = entry.uses.len() - storage;
    match MOST_SHARED.exceeded_by(storage, uniform).or_else(|| most.exceeded_by(storage, uniform)) {
        Some(reason) => Err(reason),
        None => Ok(pass),
    }
}

/// A kernel of stages with an invocation a node.
fn node_pass(pass: Pass, stages: &[&NodeStage], buffers: &mut dyn Buffers) -> Kernel {
    let Range { start, end } = stages[0].within;
    let rows = match (stages, &stages[0].rows) {
        // places among the rows
        ([_], Rows::Some(rows)) => [start, end].map(|bound| rows.partition_point(|&row| row < bound) as u32),
        _ => [start, end],
    };
    let [first, count] = rows;
    pass.into_kernel(stages, NodePass { count, first }, buffers).threads(count - first)
}

/// The kernel of [`Frame::many_steps`].
pub fn many_steps(stages: &[&NodeStage], invocations: usize, buffers: &mut dyn Buffers) -> Kernel {
    let pass = Pass::of(stages, Frame::many_steps(invocations));
    let rows = NodePass { count: stages[0].nodes, first: 0 };
    pass.into_kernel(stages, rows, buffers).threads(invocations as u32)
}

/// The kernel of [`Frame::patch_step`], of so many invocations in all.
pub fn patch_step(stages: &[&NodeStage], invocations: u32, buffers: &mut dyn Buffers) -> Kernel {
    let pass = Pass::of(stages, Frame::patch_step());
    let node = &stages[stages.len() - 1];
    let rows = NodePass { count: node.nodes, first: node.within.start };
    pass.into_kernel(stages, rows, buffers).threads(invocations)
}
