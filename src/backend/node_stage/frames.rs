//! The kernels that stages can be in, and which stages share one.

use super::pass::{Pass, written};
use super::{NodeStage, PassRows, Rows};
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

/// A kernel that stages of one body share which follow one another in a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shared {
    /// How many stages it has.
    pub stages: usize,
    /// Why the next one is in another; empty behind the last.
    pub because: String,
}

/// Decides how stages of one body share kernels: as few as can be, none in which a stage reads of other nodes what
/// another writes, and none with more storage buffers than the device has for a kernel. With `fuse` false each has its
/// own.
pub fn split(stages: &[&NodeStage], fuse: bool, buffers: &mut dyn Buffers) -> Vec<Shared> {
    let mut rest = stages;
    let mut kernels = Vec::new();
    while !rest.is_empty() {
        let first = match fuse {
            true => first_together(rest, buffers),
            false => Shared { stages: 1, because: "no other system shares its pass".into() },
        };
        rest = &rest[first.stages..];
        kernels.push(first);
    }
    if let Some(last) = kernels.last_mut() {
        last.because.clear();
    }
    kernels
}

/// As many of the first stages as may share a kernel.
fn first_together(stages: &[&NodeStage], buffers: &mut dyn Buffers) -> Shared {
    let most = buffers.most_buffers();
    let mut what_parts = |count: usize| together(&stages[..count], Frame::node_pass(), most, buffers).err();
    // most often all of them
    if stages.len() < 2 || what_parts(stages.len()).is_none() {
        return Shared { stages: stages.len(), because: String::new() };
    }
    let mut parted = (2..=stages.len()).filter_map(|count| Some((count - 1, what_parts(count)?)));
    let (count, because) = parted.next().unwrap_or_default();
    Shared { stages: count.max(1), because }
}

/// The kernels of one body's stages, as it was decided how they share them.
pub fn kernels_of(
    stages: &[&NodeStage],
    shared: impl IntoIterator<Item = usize>,
    buffers: &mut dyn Buffers,
) -> Vec<Kernel> {
    let mut rest = stages;
    let of_kernel = |count: usize| {
        let (first, others) = rest.split_at(count.clamp(1, rest.len()));
        rest = others;
        node_pass(Pass::of(first, Frame::node_pass()), first, buffers)
    };
    shared.into_iter().map(of_kernel).collect()
}

/// Kernels of stages by themselves, without a plan: those of one body share as few as can be, or none with `fuse`
/// false.
pub fn node_kernels(stages: Vec<NodeStage>, fuse: bool, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let mut kernels = Vec::new();
    for of_body in by_body(&stages) {
        let shared = split(&of_body, fuse, buffers);
        kernels.extend(kernels_of(&of_body, shared.iter().map(|shared| shared.stages), buffers));
    }
    kernels
}

/// Stages body by body, in the order in which bodies come up.
pub fn by_body(stages: &[NodeStage]) -> Vec<Vec<&NodeStage>> {
    let mut bodies: Vec<Vec<&NodeStage>> = Vec::new();
    for stage in stages {
        match bodies.iter_mut().find(|of_body| of_body[0].body == stage.body) {
            Some(of_body) => of_body.push(stage),
            None => bodies.push(vec![stage]),
        }
    }
    bodies
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
    pass.into_kernel(stages, PassRows { count, first }, buffers).threads(count - first)
}

/// The kernel of [`Frame::many_steps`].
pub fn many_steps(stages: &[&NodeStage], invocations: usize, buffers: &mut dyn Buffers) -> Kernel {
    let pass = Pass::of(stages, Frame::many_steps(invocations));
    let rows = PassRows { count: stages[0].nodes, first: 0 };
    pass.into_kernel(stages, rows, buffers).threads(invocations as u32)
}

/// The kernel of [`Frame::patch_step`], of so many invocations in all.
pub fn patch_step(stages: &[&NodeStage], invocations: u32, buffers: &mut dyn Buffers) -> Kernel {
    let pass = Pass::of(stages, Frame::patch_step());
    let node = &stages[stages.len() - 1];
    let rows = PassRows { count: node.nodes, first: node.within.start };
    pass.into_kernel(stages, rows, buffers).threads(invocations)
}
