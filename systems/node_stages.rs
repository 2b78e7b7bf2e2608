//! What a node system is on a GPU: stages of the kernels of nodes, put together from what the system touches, what the
//! scene gave as its parameters, and what it has beside ([`Stage`]).

mod parameters;

use super::node_shares::ShareOf;
use super::node_system::{NodeRows, NodeSystem};
use super::stage::Stage;
use crate::backend::Buffers;
use crate::backend::cpu::NodeShare;
use crate::backend::kernel::Fragment;
use crate::backend::node_stage::{NodeStage, rows_of};
use crate::components::*;
use bevy_ecs::prelude::*;
pub(super) use parameters::Parameters;
use std::fmt::Write;

/// The twin of a node system: what is the same for all its stages.
pub(super) struct Twin<S> {
    /// The system.
    pub name: String,
    /// The function of `shader` that kernels call.
    pub call: String,
    pub shader: Fragment,
    /// Only what is for this one of several systems calls for it.
    pub of: Option<OfSystem>,
    /// What the component itself adds to a stage.
    pub component: fn(&S, Stage) -> Stage,
}

impl<S: NodeSystem> Twin<S> {
    /// What calls for the system: the body, which nodes are chosen, and the stages.
    fn callers(&self, world: &mut World) -> Vec<(Entity, NodeShare, Vec<Stage>)> {
        let mut callers = world.query::<(Entity, &S, Option<&OfBody>, Option<&OfSystem>, Option<&ShareOf<S>>)>();
        let world: &World = world;
        let of_this = callers.iter(world).filter(|caller| caller.3.copied() == self.of);
        let stages = of_this.map(|(entity, system, of, _, share)| {
            let body = of.map_or(entity, |of| of.0);
            let stages = system.stages(body, world).into_iter().map(|stage| (self.component)(system, stage));
            (body, share.map(|share| share.share).unwrap_or_default(), stages.collect())
        });
        stages.collect()
    }

    /// Whether a shader can have what calls for the system in a world.
    ///
    /// # Errors
    /// What it cannot have, by name.
    pub fn check(&self, world: &mut World) -> Result<(), String> {
        self.callers(world).iter().flat_map(|(.., stages)| stages).try_for_each(Stage::check)
    }

    /// The stages of all that calls for the system.
    pub fn stages(&self, world: &mut World, buffers: &mut dyn Buffers) -> Vec<NodeStage> {
        let access = NodeRows::of::<S>().touches().initialize(world);
        let touched = Touched(&access);
        let rest = world.component_id::<RestPosition>().is_some_and(|rest| touched.reads(rest));
        let written: Vec<&str> = touched.written_columns(world).iter().map(|column| column.name).collect();
        // a column that shares its buffer has no name of its own there
        let alone = |column: &ColumnAccess| column.buffer == column.name && column.name != OwnNumbers::NAME;
        let columns: Vec<ColumnAccess> = touched.read_columns(world).into_iter().filter(alone).collect();
        let mut all = Vec::new();
        for (body, share, stages) in self.callers(world) {
            let nodes = rows_of(body, world);
            for of in stages.into_iter().filter(|stage| stage.rows.as_ref().is_none_or(|rows| !rows.is_empty())) {
                let (call, chosen) = if_chosen(&self.call, share, of.rows.is_some());
                let mut stage = NodeStage::new(self.name.clone(), call, body, nodes, self.shader.clone());
                if let Some(chosen) = chosen {
                    stage = stage.own(chosen).column(ChosenBy::NAME, buffers.column(body, ChosenBy::NAME));
                }
                if let Some(own) = own_numbers(share, nodes, body, world) {
                    stage = stage.own(own).column(OwnNumbers::NAME, buffers.column(body, OwnNumbers::NAME));
                }
                let (mut declared, mut loaded) = (String::new(), false);
                let there = columns.iter().filter(|column| (column.bytes)(world, body).is_some());
                for ColumnAccess { name, word, .. } in there {
                    stage = stage.column(name, buffers.column(body, name));
                    loaded |= *name == ExternalForce::NAME;
                    // forces are in registers where the kernel makes and uses them: functions know where
                    if ![InternalForce::NAME, ExternalForce::NAME].contains(name) {
                        let access = if written.contains(name) { "read_write" } else { "read" };
                        let _ =
                            writeln!(declared, "@group(0) @binding(0) var<storage, {access}> {name}: array<{word}>;");
                    }
                }
                if let (true, Some(at_rest)) = (rest, world.get::<RestPosition>(body)) {
                    let points: Vec<[f32; 3]> = at_rest.0.iter().map(|x| x.as_vec3().to_array()).collect();
                    declared += "@group(0) @binding(0) var<storage, read> rest_position: array<f32>;\n";
                    let points = buffers.constants("rest_position".into(), bytemuck::cast_slice(&points));
                    stage = stage.bind("rest_position", points);
                }
                let declared = Fragment::new(format!("generated: what {} touches", self.name), declared);
                stage = of.put_to(stage.own(declared), &self.name, buffers).with_step(world).loaded(loaded);
                stage = S::READS_ELSEWHERE.iter().fold(stage, |stage, column| stage.reads_elsewhere(column));
                all.push(match (S::SUMS_FORCES, S::MOVES_NODES) {
                    (true, _) => stage.that_sums_forces(),
                    (false, true) => stage.that_moves_nodes(false),
                    (false, false) => stage,
                });
            }
        }
        all
    }
}

/// The function that kernels call: the system's own, or one that asks first whether it has chosen a node.
fn if_chosen(function: &str, share: NodeShare, of_list: bool) -> (String, Option<Fragment>) {
    if share.bit == 0 {
        return (function.to_string(), None);
    }
    let (call, chosen, bit) = (format!("{function}_if_chosen"), ChosenBy::NAME, share.bit);
    let (declared, given) = if of_list { ("i: u32, node: u32", "i, node") } else { ("node: u32", "node") };
    let text = format!(
        "@group(0) @binding(0) var<storage, read> {chosen}: array<u32>;\nfn {call}({declared}) {{\n    \
         if ({chosen}[node] & {bit}u) != 0u {{ {function}({given}); }}\n}}\n"
    );
    (call, Some(Fragment::new(format!("generated: nodes that {function} has chosen"), text)))
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
