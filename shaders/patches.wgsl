// Sums element forces at the nodes of a patch, in workgroup memory: one invocation an element, as many batches at a
// time as the workgroup of INVOCATIONS has room for. Corners of a batch that meet in a node take turns, in rounds that
// src/backend/patch_lists.rs has found, batch after batch: a fixed order, without atomics. add_forces and the constants
// are generated.
struct PatchLists {
    count: u32, // patches
    rounds: u32, // where in patch_lists the numbers of rounds begin, a byte a corner of each batch
    corners: u32, // where corners begin: as connectivity, but two in a word
    nodes: u32, // where the nodes of patches begin; before all these, where each patch's are among them
    interior: u32, // where it begins how many of each patch's nodes, its first ones, no other patch has
}
@group(0) @binding(0) var<uniform> patches: PatchLists;
@group(0) @binding(1) var<storage, read> patch_lists: array<u32>;
@group(0) @binding(2) var<storage, read> displacement: array<f32>;
@group(0) @binding(3) var<storage, read_write> element_force: array<f32>;

// m and N, three numbers a node
var<workgroup> patch_displacement: array<f32, 3u * PATCH_NODES>;
var<workgroup> patch_force: array<f32, 3u * PATCH_NODES>;

// A corner's place among the patch's nodes, and above PLACE_BITS the round in which it is summed.
fn corner_word(element: u32, corner: u32) -> u32 {
    let pair = patch_lists[patches.corners + place(element, NODES / 2u, corner / 2u)];
    return (pair >> (16u * (corner % 2u))) & 0xffffu;
}

// Displacement (m) of an element's corner.
fn corner_displacement(element: u32, corner: u32) -> vec3<f32> {
    let at = 3u * (corner_word(element, corner) & PLACE_BITS);
    return vec3<f32>(patch_displacement[at], patch_displacement[at + 1u], patch_displacement[at + 2u]);
}

// Adds the force on one corner of all elements of a batch. Uniform: all invocations take part in all rounds.
fn add_force(element: u32, is_there: bool, batch: u32, corner: u32, force: vec3<f32>) {
    var own_round = 0xffffffffu;
    var at = 0u;
    if is_there {
        let word = corner_word(element, corner);
        own_round = word / (PLACE_BITS + 1u);
        at = 3u * (word & PLACE_BITS);
    }
    let of_four = patch_lists[patches.rounds + batch * ((NODES + 3u) / 4u) + corner / 4u];
    let rounds = (of_four >> (8u * (corner % 4u))) & 0xffu;
    for (var round = 0u; round < rounds; round++) {
        if round == own_round {
            patch_force[at] += force.x;
            patch_force[at + 1u] += force.y;
            patch_force[at + 2u] += force.z;
        }
        workgroupBarrier();
    }
}

// Uniform: all invocations of the workgroup sum the same patch. They write down the forces but those on the first
// `kept` nodes; all are in patch_force, where every invocation may read them: a barrier follows the last sum.
fn sum_patch(number: u32, local: u32, kept: u32) {
    let first_node = patch_lists[number];
    let nodes = patch_lists[number + 1u] - first_node;
    for (var i = local; i < nodes; i += INVOCATIONS) {
        let node = patch_lists[patches.nodes + first_node + i];
        for (var axis = 0u; axis < 3u; axis++) {
            patch_displacement[3u * i + axis] = displacement[3u * node + axis];
            patch_force[3u * i + axis] = 0.0;
        }
        bring_volume_change(i, node);
    }
    workgroupBarrier();
    let first_group = number * PATCH_GROUPS;
    let groups = min(PATCH_GROUPS, (block.count + LANES - 1u) / LANES - first_group);
    let batches = (groups + BATCH_GROUPS - 1u) / BATCH_GROUPS;
    for (var first = 0u; first < batches; first += INVOCATIONS / BATCH) {
        let own = first + local / BATCH;
        // a batch takes every so many-th group: its elements come from all over the patch and seldom meet
        let group = local % BATCH / LANES * batches + own;
        let element = (first_group + group) * LANES + local % LANES;
        let is_there = own < batches && group < groups && element < block.count;
        var forces = array<vec3<f32>, NODES>();
        if is_there {
            forces = forces_of(element);
        }
        for (var batch = first; batch < min(first + INVOCATIONS / BATCH, batches); batch++) {
            add_forces(element, is_there && batch == own, number * PATCH_BATCHES + batch, forces);
        }
    }
    for (var i = 3u * kept + local; i < 3u * nodes; i += INVOCATIONS) {
        element_force[block.force_offset + 3u * first_node + i] = patch_force[i];
    }
}
