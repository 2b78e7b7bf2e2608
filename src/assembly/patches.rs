//! Cutting blocks into patches, and where element forces stand.

use crate::backend::cpu::ROWS_A_CHUNK;
use crate::components::*;
use crate::elements::node_count;
use crate::math::LANES;
use crate::math::lane_place;
use crate::mesh::ElementKind;
use bevy_ecs::prelude::*;

/// Neighbours of a block, patch by patch, in the order in which they are stored: the lanes of a group come from all
/// over the patch, so that they seldom share a node and need not wait for each other's sums.
pub fn strided(mut elements: Vec<u32>, kind: ElementKind) -> Vec<u32> {
    for patch in elements.chunks_mut(patch_length(kind)) {
        let groups = patch.len().div_ceil(LANES);
        let mut order: Vec<usize> = (0..patch.len()).collect();
        order.sort_by_key(|&place| (place % groups, place / groups));
        let strided: Vec<u32> = order.into_iter().map(|place| patch[place]).collect();
        patch.copy_from_slice(&strided);
    }
    elements
}

/// The patches of a block's elements.
pub fn cut(kind: ElementKind, connectivity: &[u32]) -> Patches {
    let corners_a_patch = patch_length(kind) * node_count(kind);
    let mut patches = Patches { starts: vec![0], ..Patches::default() };
    for corners in connectivity.chunks(corners_a_patch) {
        let mut nodes = corners.to_vec();
        nodes.sort_unstable();
        nodes.dedup();
        // at most 4096 of them: there are no more corners
        let place = |node: &u32| nodes.partition_point(|other| other < node) as u16;
        patches.connectivity.extend(corners.iter().map(place));
        patches.nodes.extend(&nodes);
        patches.starts.push(patches.nodes.len() as u32);
    }
    patches
}

/// Gives a body its element forces, the gather's map and each block its place among the forces, as a scheme has them.
/// It may be called again for another scheme.
pub fn insert_forces(scheme: Scheme, body: Entity, world: &mut World) {
    let Some(count) = world.get::<RestPosition>(body).map(|rest| rest.0.len()) else { return };
    let Some(blocks) = world.get::<Authoring>(body).map(|authoring| authoring.blocks.clone()) else { return };
    let precision = world.get::<Displacement>(body).map_or(Precision::F64, |u| u.precision());
    let mut places: Vec<(u32, u32)> = Vec::new();
    let mut of_patches = Vec::new();
    let mut length = 0;
    for entity in blocks {
        let Some((kind, elements)) = world.get::<Block>(entity).map(|block| (block.kind, block.count)) else {
            continue;
        };
        let Some(connectivity) = world.get::<Connectivity>(entity) else { continue };
        let offset = length;
        match scheme {
            Scheme::Patches => {
                let patches = cut(kind, connectivity);
                of_patches.push(entity);
                places.extend(patches.nodes.iter().zip(0..).map(|(&node, slot)| (node, offset as u32 + 3 * slot)));
                length += 3 * patches.nodes.len();
                world.entity_mut(entity).insert(patches);
            }
            Scheme::TwoPass => {
                let nodes = node_count(kind);
                for row in 0..elements {
                    for corner in 0..nodes {
                        let place = offset + lane_place(row, 3 * nodes, 3 * corner);
                        places.push((connectivity[lane_place(row, nodes, corner)], place as u32));
                    }
                }
                length += elements.div_ceil(LANES) * LANES * 3 * nodes;
                world.entity_mut(entity).remove::<Patches>();
            }
        }
        if let Some(mut block) = world.get_mut::<Block>(entity) {
            (block.force_offset, block.force_length) = (offset, length - offset);
        }
    }
    let stride = if scheme == Scheme::Patches { 1 } else { LANES };
    let mut corners = corners(count, &places, stride);
    let apart = world.get::<SurfaceRows>(body).map_or(Vec::new(), |rows| rows.0.clone());
    for entity in of_patches {
        if let Some(mut patches) = world.get_mut::<Patches>(entity) {
            find_inside(&mut patches, &mut corners, &apart);
        }
    }
    corners.first_waiting = first_waiting(&corners, count, &apart);
    world.entity_mut(body).insert((corners, ElementForce(Reals::zeros(precision, length))));
}

/// By node what is told by place.
fn corners(nodes: usize, places: &[(u32, u32)], stride: usize) -> Corners {
    let mut starts = vec![0_u32; nodes + 1];
    places.iter().for_each(|&(node, _)| starts[node as usize + 1] += 1);
    (0..nodes).for_each(|node| starts[node + 1] += starts[node]);
    let mut next = starts.clone();
    let mut corners = vec![0; places.len()];
    for &(node, place) in places {
        corners[next[node as usize] as usize] = place;
        next[node as usize] += 1;
    }
    Corners { starts, corners, stride, first_interface: 0, deferred: Vec::new(), first_waiting: 0 }
}

/// Counts the nodes of each patch that nobody else has and that follow those of the patches before: first those that
/// always move with it, then those that are kept apart.
fn find_inside(patches: &mut Patches, corners: &mut Corners, apart: &[u32]) {
    let is_apart = |row: usize| apart.binary_search(&(row as u32)).is_ok();
    let alone = |row: usize| corners.starts[row + 1] - corners.starts[row] == 1;
    let mut next = corners.first_interface;
    for ends in patches.starts.windows(2) {
        let nodes = patches.nodes[ends[0] as usize..ends[1] as usize].iter().zip(next..);
        let own = nodes.take_while(|&(&node, wanted)| node as usize == wanted && alone(wanted)).count();
        let free = (next..next + own).take_while(|&row| !is_apart(row)).count();
        let [free, deferred] = inside_of([free, own - free]);
        patches.interior.push((free + deferred) as u32);
        patches.deferred.push(deferred as u32);
        if deferred > 0 {
            corners.deferred.push(next + free..next + free + deferred);
        }
        next += free + deferred;
    }
    corners.first_interface = next;
}

/// The first of so many rows outside patches that is kept apart, or a few rows before: with those that are not, whole
/// chunks are moved, so that sums over chunks are the same wherever it is.
fn first_waiting(corners: &Corners, nodes: usize, apart: &[u32]) -> usize {
    let first = corners.first_interface;
    let next = apart.partition_point(|&row| (row as usize) < first);
    match apart.get(next) {
        Some(&waiting) => first + (waiting as usize - first) / ROWS_A_CHUNK * ROWS_A_CHUNK,
        None => nodes,
    }
}

#[cfg(test)]
mod tests;
