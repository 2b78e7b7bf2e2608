//! Patches as a GPU's kernels read them; `shaders/patches.wgsl` is what reads.

use super::kernel::uniform;
use crate::components::{Block, Patches, patch_groups};
use crate::elements::{averages, node_count};
use crate::math::LANES;
use crate::math::lane_place;
use crate::mesh::ElementKind;

/// Groups of elements that a workgroup computes at a time.
pub const BATCH_GROUPS: usize = 8;

/// Bits of a corner's place among its patch's nodes; the rest of 16 are its round.
pub const PLACE_WIDTH: u32 = 10;

/// What [`PLACE_WIDTH`] bits can hold.
pub const PLACE_BITS: u32 = (1 << PLACE_WIDTH) - 1;

/// How many corners of a batch may take turns at a node.
const MOST_ROUNDS: u32 = 1 << (16 - PLACE_WIDTH);

/// Bytes of workgroup memory that every WebGPU device has (`maxComputeWorkgroupStorageSize`).
pub const WEBGPU_WORKGROUP_MEMORY: usize = 16_384;

/// Where a block's lists begin, in words.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PatchLists {
    /// How many patches.
    pub count: u32,
    /// Numbers of rounds.
    pub rounds: u32,
    /// Corners.
    pub corners: u32,
    /// Nodes.
    pub nodes: u32,
    /// How many of each patch's are inside.
    pub interior: u32,
}
uniform!(PatchLists { count, rounds, corners, nodes, interior });

/// The patches of a block in one buffer: where each patch's nodes begin; for each batch and corner how many rounds
/// there are, a byte each; each corner's place and round, two a word; the nodes; how many of them are inside. About 8
/// bytes a tetrahedron and 16 a hexahedron.
pub struct PackedPatches {
    /// Where what begins.
    pub lists: PatchLists,
    /// The buffer.
    pub words: Vec<u32>,
    /// Nodes that workgroup memory must have room for.
    pub room: usize,
}

/// Batches of a full patch.
pub const fn patch_batches(kind: ElementKind) -> usize {
    patch_groups(kind).div_ceil(BATCH_GROUPS)
}

/// Nodes of a patch that workgroup memory has room for.
pub fn most_nodes(kind: ElementKind) -> usize {
    WEBGPU_WORKGROUP_MEMORY / bytes_a_node(kind) / ROOM_STEP * ROOM_STEP
}

/// Bytes of workgroup memory for a node: a displacement and a force, θ where it is called for.
fn bytes_a_node(kind: ElementKind) -> usize {
    4 * if averages(kind) { 7 } else { 6 }
}

/// Bytes of workgroup memory that the kernel of a block takes for a patch.
pub(crate) fn workgroup_memory(kind: ElementKind, patches: &Patches) -> usize {
    room(most_nodes_of(patches)) * bytes_a_node(kind)
}

fn most_nodes_of(patches: &Patches) -> usize {
    patches.starts.windows(2).map(|pair| (pair[1] - pair[0]) as usize).max().unwrap_or(0)
}

/// Room that is made for so many nodes.
fn room(nodes: usize) -> usize {
    nodes.next_multiple_of(ROOM_STEP).max(ROOM_STEP)
}

/// Room is made in such steps, so that blocks with patches of about the same size share a kernel.
const ROOM_STEP: usize = 64;

impl PackedPatches {
    /// How many patches there are.
    pub fn count(&self) -> usize {
        self.lists.count as usize
    }
}

/// Packs the patches of a block.
///
/// # Errors
/// Why no workgroup can sum them: a patch of too many nodes, or too many elements around one node. Then the scheme of
/// two passes remains.
pub fn pack(block: &Block, patches: &Patches) -> Result<PackedPatches, String> {
    let (kind, count) = (block.kind, patches.count());
    let corners = node_count(kind);
    let nodes = most_nodes_of(patches);
    let most = most_nodes(kind);
    if nodes > most {
        return Err(format!("a patch has {nodes} nodes, and {most} fit into a workgroup's memory"));
    }
    let words_a_batch = corners.div_ceil(4);
    let mut words = patches.starts.clone();
    let rounds_at = words.len();
    words.resize(rounds_at + count * patch_batches(kind) * words_a_batch, 0);
    let mut packed = patches.connectivity.clone();
    let mut turns = vec![0_u32; nodes];
    let elements_a_patch = patch_groups(kind) * LANES;
    for patch in 0..count {
        let first = patch * elements_a_patch;
        let elements = elements_a_patch.min(block.count - first);
        let batches = elements.div_ceil(LANES).div_ceil(BATCH_GROUPS);
        for batch in 0..batches {
            for corner in 0..corners {
                turns.fill(0);
                let of_batch = (0..BATCH_GROUPS).flat_map(|slot| {
                    let start = (slot * batches + batch) * LANES;
                    start..(start + LANES).min(elements)
                });
                for element in of_batch {
                    let place = &mut packed[lane_place(first + element, corners, corner)];
                    let turn = &mut turns[usize::from(*place)];
                    // turns fit their bits: more of them are refused below
                    *place |= (*turn << PLACE_WIDTH) as u16;
                    *turn += 1;
                }
                let rounds = turns.iter().copied().max().unwrap_or(0);
                if rounds > MOST_ROUNDS {
                    return Err(format!(
                        "{rounds} of 128 neighbouring elements have the same corner in common, and {MOST_ROUNDS} may"
                    ));
                }
                let at = rounds_at + (patch * patch_batches(kind) + batch) * words_a_batch + corner / 4;
                words[at] |= rounds << (8 * (corner % 4));
            }
        }
    }
    let corners_at = words.len();
    words.resize(corners_at + packed.len() / 2, 0);
    for (group, pairs) in packed.chunks(corners * LANES).zip(words[corners_at..].chunks_mut(corners / 2 * LANES)) {
        for (place, pair) in pairs.iter_mut().enumerate() {
            let (of_corners, lane) = (place / LANES, place % LANES);
            let corner = |k: usize| u32::from(group[(2 * of_corners + k) * LANES + lane]);
            *pair = corner(0) | corner(1) << 16;
        }
    }
    let nodes_at = words.len();
    words.extend(&patches.nodes);
    let interior_at = words.len();
    words.extend(&patches.interior);
    let place = |at: usize| at as u32;
    let lists = PatchLists {
        count: place(count),
        rounds: place(rounds_at),
        corners: place(corners_at),
        nodes: place(nodes_at),
        interior: place(interior_at),
    };
    Ok(PackedPatches { lists, words, room: room(nodes) })
}
