//! `island_removal`: crumbs that tools have cut off go at once.

use super::element_removal::CRITERION_STEPS;
use super::system::{Phase, System};
use crate::components::*;
use crate::elements::node_count;
use crate::error::{Error, missing};
use crate::evaluation::rest_volume;
use crate::math::lane_place;
use crate::mesh::{Cells, NO_PIECE};
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;

/// An island is a piece that no shared node ties to the largest of what it was one piece with at the start. One that is
/// smaller than a tool's crumb, with an element in the tool's reach, goes as a whole; its volume is taken from what the
/// tool has taken in, which has to catch up before the next element goes: no volume is gone but what came through the
/// tool's mouth. Islands with elements that the tool may not take stay.
///
/// It is looked for them as often as [`ToolLooks`] says; what is a piece with what is found anew only where elements
/// have gone. On a GPU this runs on the host.
pub fn system() -> System {
    let system = System::built_in(
        "island_removal",
        Phase::Removal,
        "chooses what tools have cut off and is too small to stay",
        "`InTool(...)` under `removal`, but for a `crumb` of 0",
        |world| {
            let mut query = world.query::<&ToolRemovals>();
            let takers = query.iter(world).flat_map(|removals| &removals.all);
            match takers.filter(|removal| removal.crumb > 0.0).count() {
                0 => None,
                1 => Some("1 tool that takes crumbs".into()),
                count => Some(format!("{count} tools that take crumbs")),
            }
        },
        island_removal,
    );
    System { every: CRITERION_STEPS, ..system }
}

type BodyQuery<'a> =
    (&'a ToolRemovals, &'a mut Islands, &'a mut ToolIntake, &'a Authoring, &'a RestPosition, &'a Displacement);

type BlockQuery<'a> = (&'a Block, &'a Connectivity, &'a RestShape, &'a Alive, &'a mut RemovalStep);

fn island_removal(
    clock: Res<Clock>,
    signals: Res<Signals>,
    mut bodies: Query<BodyQuery>,
    mut blocks: Query<BlockQuery>,
) -> Result<(), Error> {
    for (removals, mut islands, mut intake, authoring, rest, displacement) in &mut bodies {
        let mut going: Vec<(u32, u32)> = Vec::new();
        {
            let of_body: Vec<_> = authoring.blocks.iter().filter_map(|&block| blocks.get(block).ok()).collect();
            if of_body.len() != authoring.blocks.len() {
                return Err(missing("a column of a block"));
            }
            let is_there = |&(block, row): &(u32, u32)| {
                let (.., alive, due) = &of_body[block as usize];
                alive[row as usize] == 1 && u64::from(due[row as usize]) > clock.step
            };
            let volume = |&(block, row): &(u32, u32)| {
                let (block, _, shape, ..) = &of_body[block as usize];
                rest_volume(block, row as usize, shape)
            };
            let there: Vec<bool> = authoring.element_rows.iter().map(is_there).collect();
            islands.renew(there, &authoring.cells, |element| volume(&authoring.element_rows[element]));
            let place = |node: u32| rest.0[node as usize] - removals.reference + displacement.vector(node as usize);
            let centroid = |&(block, row): &(u32, u32)| {
                let (block, connectivity, ..) = &of_body[block as usize];
                let nodes = node_count(block.kind);
                let corners = (0..nodes).map(|corner| place(connectivity[lane_place(row as usize, nodes, corner)]));
                corners.sum::<DVec3>() / nodes as f64
            };
            for island in &islands.all {
                let rows: Vec<(u32, u32)> =
                    island.elements.iter().map(|&element| authoring.element_rows[element as usize]).collect();
                let takes = |removal: &ToolRemoval| {
                    let pose = removal.pose_in(&signals);
                    let may = |(block, row): &(u32, u32)| removal.numbers[*block as usize][*row as usize] != u32::MAX;
                    let reached = |at: &(u32, u32)| removal.mouth.distance(pose.inverse(centroid(at))) <= removal.reach;
                    island.volume < removal.crumb
                        && signals.values()[removal.rate][0] > 0.0
                        && rows.iter().all(may)
                        && rows.iter().any(reached)
                };
                let Some(number) = removals.all.iter().position(takes) else { continue };
                if removals.all[number].threshold.is_none() {
                    let at = INTAKE_NUMBERS * number;
                    let left = intake.get(at) - island.volume;
                    intake.set(at, left);
                }
                going.extend(rows);
            }
        }
        for (block, row) in going {
            if let Ok((.., mut due)) = blocks.get_mut(authoring.blocks[block as usize]) {
                due[row as usize] = u32::try_from(clock.step).unwrap_or(u32::MAX);
            }
        }
    }
    Ok(())
}

impl Islands {
    /// Finds the islands where others are there than when they were last found.
    fn renew(&mut self, there: Vec<bool>, cells: &Cells, volume: impl Fn(usize) -> f64) {
        if self.there == there {
            return;
        }
        let mut of_piece: BTreeMap<u32, Island> = BTreeMap::new();
        for (element, piece) in cells.pieces(self.points, |element| there[element]).into_iter().enumerate() {
            if piece != NO_PIECE {
                let island = of_piece.entry(piece).or_default();
                island.volume += volume(element);
                island.elements.push(element as u32);
            }
        }
        // of what was one piece at the start the largest part is no island
        let mut largest: BTreeMap<u32, (f64, u32)> = BTreeMap::new();
        for (&piece, island) in &of_piece {
            let most = largest.entry(self.at_start[island.elements[0] as usize]).or_insert((island.volume, piece));
            if island.volume > most.0 {
                *most = (island.volume, piece);
            }
        }
        let stays = |piece: u32| largest.values().any(|most| most.1 == piece);
        self.all = of_piece.into_iter().filter(|(piece, _)| !stays(*piece)).map(|(_, island)| island).collect();
        self.there = there;
    }
}
