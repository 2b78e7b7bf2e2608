//! Patches as kernels read them.

use bevy_ecs::prelude::Entity;
use sinew::backend::patch_lists::*;
use sinew::components::{Block, Patches, patch_groups};
use sinew::elements::node_count;
use sinew::math::LANES;
use sinew::math::lane_place;
use sinew::mesh::ElementKind;

/// A block whose corners meet at random in so many nodes, and its patches, all corners of which are in one node where
/// `of` says so.
fn block(kind: ElementKind, count: usize, of: impl Fn(usize) -> usize) -> (Block, Patches) {
    let (corners, groups) = (node_count(kind), count.div_ceil(LANES));
    let mut patches = Patches { starts: vec![0], ..Patches::default() };
    let all: Vec<usize> = (0..groups * LANES * corners).map(of).collect();
    for of_patch in all.chunks(patch_groups(kind) * LANES * corners) {
        let mut nodes = of_patch.to_vec();
        nodes.sort_unstable();
        nodes.dedup();
        let place = |node| nodes.binary_search(node).unwrap() as u16;
        patches.connectivity.extend(of_patch.iter().map(place));
        patches.nodes.extend(nodes.iter().map(|&node| node as u32));
        patches.starts.push(patches.nodes.len() as u32);
    }
    let (body, material) = (Entity::PLACEHOLDER, Entity::PLACEHOLDER);
    let (force_offset, force_length, fibre_directions) = (0, 0, Vec::new());
    (Block { body, material, kind, count, force_offset, force_length, fibre_directions, simple: false }, patches)
}

/// Goes through the lists as `patches.wgsl` does.
#[test]
fn each_corner_is_summed_once_in_a_round_of_its_own() {
    for kind in ElementKind::ALL {
        for count in [1, 15, 16, 130, 1024, 1025, 2100] {
            let (block, patches) = block(kind, count, |i| i * 7919 % 501 + i / 4096);
            let PackedPatches { lists, words, room } = pack(&block, &patches).unwrap();
            let corners = node_count(kind);
            let mut summed = vec![0; count * corners];
            for patch in 0..lists.count as usize {
                let nodes = (words[patch + 1] - words[patch]) as usize;
                assert!(nodes <= room && room <= most_nodes(kind));
                let first_group = patch * patch_groups(kind);
                let groups = patch_groups(kind).min(count.div_ceil(LANES) - first_group);
                let batches = groups.div_ceil(BATCH_GROUPS);
                for batch in 0..batches {
                    for corner in 0..corners {
                        let of_four = (patch * patch_batches(kind) + batch) * corners.div_ceil(4) + corner / 4;
                        let rounds = words[lists.rounds as usize + of_four] >> (8 * (corner % 4)) & 255;
                        let mut seen = std::collections::BTreeSet::new();
                        for local in 0..BATCH_GROUPS * LANES {
                            let group = local / LANES * batches + batch;
                            let element = (first_group + group) * LANES + local % LANES;
                            if group >= groups || element >= count {
                                continue;
                            }
                            let at = lists.corners as usize + lane_place(element, corners / 2, corner / 2);
                            let word = words[at] >> (16 * (corner % 2)) & 0xffff;
                            let (place, round) = (word & PLACE_BITS, word >> PLACE_WIDTH);
                            assert!(round < rounds && seen.insert((place, round)), "{kind:?} {count}");
                            let node = words[(lists.nodes + words[patch] + place) as usize];
                            let corner_at = lane_place(element, corners, corner);
                            assert_eq!(node as usize, corner_at * 7919 % 501 + corner_at / 4096);
                            summed[element * corners + corner] += 1;
                        }
                    }
                }
            }
            assert!(summed.iter().all(|&times| times == 1), "{kind:?} {count}");
        }
    }
}

#[test]
fn patches_that_no_workgroup_can_sum_are_refused() {
    let (tets, patches) = block(ElementKind::Tet4, 161, |i| i);
    assert_eq!(pack(&tets, &patches).err().unwrap(), "a patch has 704 nodes, and 640 fit into a workgroup's memory");
    let (tets, patches) = block(ElementKind::Tet4, 144, |i| i);
    assert!(pack(&tets, &patches).is_ok());
    // corner 0 of all is the same node
    let fan = |i: usize| if (i / LANES).is_multiple_of(4) { 0 } else { 1 + i % 400 };
    let (tets, patches) = block(ElementKind::Tet4, 65, fan);
    let refused = pack(&tets, &patches).err().unwrap();
    assert_eq!(refused, "65 of 128 neighbouring elements have the same corner in common, and 64 may");
    let (tets, patches) = block(ElementKind::Tet4, 64, fan);
    assert!(pack(&tets, &patches).is_ok());
}
