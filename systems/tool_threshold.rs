//! `tool_threshold`: chooses the elements that tools take because of how they are deformed.

use super::element_removal::{CRITERION_STEPS, measure};
use super::system::{Phase, System};
use super::tool_removal::in_reach;
use crate::backend::cpu::{BlockLaw, Cpu};
use crate::components::*;
use crate::evaluation::BlockView;
use bevy_ecs::prelude::*;
use std::borrow::Cow;

/// Elements whose centroids are in a tool's reach and that pass its threshold are due at once, `burst` of them at most
/// at a time, those nearest to the mouth first. It is looked for them as often as [`ToolLooks`] says, while the course
/// of the removal is above 0. On a GPU this runs on the host.
pub fn system() -> System {
    let system = System::built_in(
        "tool_threshold",
        Phase::Removal,
        "chooses the elements in tools that pass a threshold",
        "`InTool(threshold: ...)` under `removal`",
        |world| {
            let mut query = world.query::<&ToolRemovals>();
            let takers = query.iter(world).flat_map(|removals| &removals.all);
            match takers.filter(|removal| removal.threshold.is_some()).count() {
                0 => None,
                1 => Some("1 tool with a threshold".into()),
                count => Some(format!("{count} tools with thresholds")),
            }
        },
        tool_threshold,
    );
    System { every: CRITERION_STEPS, ..system }
}

type BodyQuery<'a> = (&'a ToolRemovals, &'a Authoring, &'a RestPosition, &'a Displacement);

type BlockQuery<'a> = (
    &'a Block,
    &'a Connectivity,
    &'a RestShape,
    &'a Alive,
    &'a mut RemovalStep,
    &'a BlockLaw<f64>,
    Option<&'a FibreDirection>,
    (Option<&'a MemoryBefore>, Option<&'a ViscousMemory>),
    Option<&'a NodalVolumeChange>,
);

fn tool_threshold(
    clock: Res<Clock>,
    cpu: Res<Cpu>,
    signals: Res<Signals>,
    bodies: Query<BodyQuery>,
    mut blocks: Query<BlockQuery>,
) {
    for (removals, authoring, rest, displacement) in &bodies {
        let place = |node: u32| rest.0[node as usize] - removals.reference + displacement.vector(node as usize);
        for removal in removals.all.iter().filter(|removal| signals.values()[removal.rate][0] > 0.0) {
            let Some((what, limit)) = removal.threshold else { continue };
            let pose = removal.pose_in(&signals);
            let mut found = Vec::new();
            for (&entity, numbers) in authoring.blocks.iter().zip(&removal.numbers) {
                let Ok((block, connectivity, shape, alive, due, law, fibres, memory, means)) = blocks.get(entity)
                else {
                    continue;
                };
                let view = BlockView {
                    block,
                    connectivity,
                    shape,
                    displacement,
                    law,
                    fibre_direction: fibres.map(|f| &f.0),
                    memory: memory.0.map(|m| &m.0).or(memory.1.map(|m| &m.0)),
                    nodal_volume_change: means.map(|means| Cow::Borrowed(&means.0)),
                };
                let of_block = (entity, (block, connectivity, shape, alive, due));
                let near = in_reach(removal, &pose, of_block, numbers, (&cpu, clock.step), place);
                found.extend(near.into_iter().filter(|&(_, _, _, row, _)| measure(what, row, &view) > limit));
            }
            found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            for (_, _, entity, row, _) in found.into_iter().take(removal.burst as usize) {
                if let Ok((_, _, _, _, mut due, ..)) = blocks.get_mut(entity) {
                    due[row] = u32::try_from(clock.step).unwrap_or(u32::MAX);
                }
            }
        }
    }
}
