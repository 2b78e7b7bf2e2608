// The vectors of conjugate gradients, three numbers a node of all bodies; see conjugate_gradients.wgsl.
@group(0) @binding(3) var<storage, read_write> solution: array<f32>; // x (m)
@group(0) @binding(4) var<storage, read_write> residual: array<f32>; // r (N)
@group(0) @binding(5) var<storage, read_write> preconditioned: array<f32>; // z
@group(0) @binding(6) var<storage, read_write> direction: array<f32>; // p
@group(0) @binding(7) var<storage, read_write> image: array<f32>; // A p
@group(0) @binding(8) var<storage, read> heights: array<f32>; // of the flattest element at a node (m)

var<workgroup> sizes: array<f32, 64>;

// p = z + β p, and how much of it strains elements.
@compute @workgroup_size(64)
fn direct(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let node = row(id, groups);
    var size = 0.0;
    if node < extent.nodes {
        for (var axis = 0u; axis < 3u; axis++) {
            let at = 3u * node + axis;
            var p = preconditioned[at];
            if solve.turn != 0.0 {
                p += solve.turn * direction[at];
            }
            direction[at] = p;
            size = max(size, abs(p));
        }
        size /= heights[node];
    }
    sizes[local] = size;
    workgroupBarrier();
    for (var width = 32u; width > 0u; width /= 2u) {
        if local < width {
            sizes[local] = max(sizes[local], sizes[local + width]);
        }
        workgroupBarrier();
    }
    let group = patch_row(group_id, groups);
    if local == 0u && group < extent.groups {
        partials[group] = vec2<f32>(sizes[0], 0.0);
    }
}

// x += α p, r -= α A p.
@compute @workgroup_size(64)
fn advance(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let node = row(id, groups);
    if node >= extent.nodes || solve.length == 0.0 {
        return;
    }
    for (var axis = 0u; axis < 3u; axis++) {
        let at = 3u * node + axis;
        solution[at] += solve.length * direction[at];
        residual[at] -= solve.length * image[at];
    }
}
