//! Kernels of tools at nodes.

use super::super::surface_contact::note_farther;
use super::{ToolNodes, tool_stage};
use crate::backend::Buffers;
use crate::backend::kernel::{Uniform, uniform};
use crate::backend::node_stage::NodeStage;
use crate::components::*;
use crate::shader;
use bevy_ecs::prelude::*;

/// What is the same for all tools of a body.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Limits {
    edge: f32,
    settling: f32,
    counts_work: u32,
}
uniform!(Limits { edge, settling, counts_work });

/// How many tools there are, and how many numbers of each.
fn counts(contacts: &ToolContacts) -> String {
    let (tools, numbers) = (contacts.tools.len(), contacts.numbers_a_tool());
    format!("const TOOLS: u32 = {tools}u;\nconst NUMBERS: u32 = {numbers}u;\n")
}

/// One stage for each body that tools may touch.
pub(super) fn stages(world: &mut World, buffers: &mut dyn Buffers) -> Vec<NodeStage> {
    let all: Vec<(Entity, ToolContacts)> =
        world.query::<(Entity, &ToolContacts)>().iter(world).map(|(body, contacts)| (body, contacts.clone())).collect();
    all.into_iter().map(|(body, contacts)| stage(body, &contacts, world, buffers)).collect()
}

fn stage(body: Entity, contacts: &ToolContacts, world: &mut World, buffers: &mut dyn Buffers) -> NodeStage {
    let of = ToolNodes {
        system: "tool_contact",
        twin: shader!("tool_contact"),
        counts: counts(contacts),
        tools: contacts.tools.iter().collect(),
        reference: contacts.reference,
        rows: &contacts.rows,
        masks: &contacts.masks,
        nodes: "touchable",
        column: ToolTouch::NAME,
    };
    let stage = tool_stage(body, of, world, buffers);
    let counts_work = u32::from(world.resource::<Clock>().relaxation.is_none());
    let limits = Limits { edge: contacts.edge as f32, settling: contacts.settling as f32, counts_work };
    let stage = stage.own(shader!("contact_spring"));
    let (text, columns) = note_farther(body, world);
    let stage = text.into_iter().fold(stage, NodeStage::own);
    let stage = columns.iter().fold(stage, |stage, column| stage.column(column, buffers.column(body, column)));
    stage.bind_uniform::<Limits>("limits", buffers.uniform("tool contact".into(), &limits.bytes()))
}
