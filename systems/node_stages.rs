//! What a node system of one's own is on a GPU: a stage of the kernels of nodes, put together from what the system
//! touches and what the scene gave as its parameters.

mod parameters;

use super::node_shares::ShareOf;
use super::node_system::{NodeRows, NodeSystem};
use crate::backend::Buffers;
use crate::backend::cpu::NodeShare;
use crate::backend::kernel::Fragment;
use crate::backend::node_stage::{NodeStage, rows_of};
use crate::components::*;
use bevy_ecs::prelude::*;
use parameters::Parameters;
use std::fmt::Write;

/// One stage for each entity that calls for the system.
pub(super) fn derived_stages<S: NodeSystem + serde::Serialize>(
    name: &str,
    shader: &Fragment,
    world: &mut World,
    buffers: &mut dyn Buffers,
) -> Vec<NodeStage> {
    let access = NodeRows::of::<S>().touches().initialize(world);
    let touched = Touched(&access);
    let rest = world.component_id::<RestPosition>().is_some_and(|rest| touched.reads(rest));
    let written: Vec<&str> = touched.written_columns(world).iter().map(|column| column.name).collect();
    // a column that shares its buffer has no name of its own there
    let alone = |column: &ColumnAccess| column.buffer == column.name && column.name != OwnNumbers::NAME;
    let columns: Vec<ColumnAccess> = touched.read_columns(world).into_iter().filter(alone).collect();
    let callers: Vec<(Entity, Parameters, NodeShare)> = world
        .query::<(Entity, &S, Option<&OfBody>, Option<&ShareOf<S>>)>()
        .iter(world)
        .map(|(entity, system, of, share)| {
            let parameters = Parameters::of(system).unwrap_or_else(|wrong| {
                debug_assert!(false, "not refused when the simulation was made: {wrong}");
                Parameters::default()
            });
            (of.map_or(entity, |of| of.0), parameters, share.map(|share| share.share).unwrap_or_default())
        })
        .collect();
    let mut stages = Vec::new();
    for (body, parameters, share) in callers {
        let Parameters { mut declared, bytes } = parameters;
        let rows = rows_of(body, world);
        let (call, chosen) = if_chosen(name, share);
        let mut stage = NodeStage::new(name.to_string(), call, body, rows, shader.clone());
        if let Some(chosen) = chosen {
            stage = stage.own(chosen).column(ChosenBy::NAME, buffers.column(body, ChosenBy::NAME));
        }
        if let Some(own) = own_numbers(share, rows, body, world) {
            stage = stage.own(own).column(OwnNumbers::NAME, buffers.column(body, OwnNumbers::NAME));
        }
        let mut loaded = false;
        for ColumnAccess { name, word, .. } in columns.iter().filter(|column| (column.bytes)(world, body).is_some()) {
            stage = stage.column(name, buffers.column(body, name));
            loaded |= *name == ExternalForce::NAME;
            // forces are in registers where the kernel makes and uses them: functions know where
            if ![InternalForce::NAME, ExternalForce::NAME].contains(name) {
                let access = if written.contains(name) { "read_write" } else { "read" };
                let _ = writeln!(declared, "@group(0) @binding(0) var<storage, {access}> {name}: array<{word}>;");
            }
        }
        if let (true, Some(at_rest)) = (rest, world.get::<RestPosition>(body)) {
            let points: Vec<[f32; 3]> = at_rest.0.iter().map(|x| x.as_vec3().to_array()).collect();
            declared += "@group(0) @binding(0) var<storage, read> rest_position: array<f32>;\n";
            let points = buffers.constants("rest_position".into(), bytemuck::cast_slice(&points));
            stage = stage.bind("rest_position", points);
        }
        if !bytes.is_empty() {
            stage = stage.bind("parameters", buffers.uniform(format!("parameters of {name}"), &bytes));
        }
        stage = S::READS_ELSEWHERE.iter().fold(stage, |stage, column| stage.reads_elsewhere(column));
        let declared = Fragment::new(format!("generated: what {name} touches"), declared);
        let stage = stage.own(declared).with_step(world).loaded(loaded);
        stages.push(match (S::SUMS_FORCES, S::MOVES_NODES) {
            (true, _) => stage.that_sums_forces(),
            (false, true) => stage.that_moves_nodes(false),
            (false, false) => stage,
        });
    }
    stages
}

/// Whether a shader can have what the scene gave a system as its parameters.
///
/// # Errors
/// What it cannot have, by name.
pub(super) fn check_parameters<S: NodeSystem + serde::Serialize>(world: &mut World) -> Result<(), String> {
    world.query::<&S>().iter(world).try_for_each(|system| Parameters::of(system).map(|_| ()))
}

/// The function that kernels call: the system's own, or one that asks first whether it has chosen a node.
fn if_chosen(name: &str, share: NodeShare) -> (String, Option<Fragment>) {
    if share.bit == 0 {
        return (name.to_string(), None);
    }
    let (call, chosen, bit) = (format!("{name}_if_chosen"), ChosenBy::NAME, share.bit);
    let text = format!(
        "@group(0) @binding(0) var<storage, read> {chosen}: array<u32>;\nfn {call}(node: u32) {{\n    \
         if ({chosen}[node] & {bit}u) != 0u {{ {name}(node); }}\n}}\n"
    );
    (call, Some(Fragment::new(format!("generated: nodes that {name} has chosen"), text)))
}

/// Declares what gives a system the numbers that it keeps, where it has some.
fn own_numbers(share: NodeShare, rows: u32, body: Entity, world: &World) -> Option<Fragment> {
    let NodeShare { first, numbers, .. } = share;
    let all = world.get::<OwnNumbers>(body).filter(|_| numbers > 0)?.len() / (rows as usize).max(1);
    let own = OwnNumbers::NAME;
    let text = format!(
        "@group(0) @binding(0) var<storage, read_write> {own}: array<f32>;\n\
         fn own(node: u32, i: u32) -> f32 {{\n    return {own}[{all}u * node + {first}u + i];\n}}\n\
         fn set_own(node: u32, i: u32, value: f32) {{\n    {own}[{all}u * node + {first}u + i] = value;\n}}\n"
    );
    Some(Fragment::new("generated: numbers of a system's own", text))
}
