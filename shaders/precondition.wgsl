// z = B r, r·z and r·r; see conjugate_gradients.wgsl. coarse_motion_of is in coarse_motion.wgsl, or generated where
// there is no coarse level.
// xx yy zz xy xz yz of a symmetric matrix a node (m/N)
@group(0) @binding(3) var<storage, read> node_blocks: array<f32>;
@group(0) @binding(4) var<storage, read> residual: array<f32>;
@group(0) @binding(5) var<storage, read_write> preconditioned: array<f32>;
@group(0) @binding(6) var<storage, read> inertia: array<f32>; // below 0 where an axis is not free

@compute @workgroup_size(64)
fn precondition(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let node = row(id, groups);
    var sum = vec2<f32>(0.0);
    if node < extent.nodes {
        let at = 3u * node;
        let r = vec3<f32>(residual[at], residual[at + 1u], residual[at + 2u]);
        let b = 6u * node;
        let diagonal = vec3<f32>(node_blocks[b], node_blocks[b + 1u], node_blocks[b + 2u]);
        let xy = node_blocks[b + 3u];
        let xz = node_blocks[b + 4u];
        let yz = node_blocks[b + 5u];
        let motion = coarse_motion_of(node);
        let is_free = vec3<bool>(inertia[at] >= 0.0, inertia[at + 1u] >= 0.0, inertia[at + 2u] >= 0.0);
        let z = diagonal * r + vec3<f32>(xy * r.y + xz * r.z, xy * r.x + yz * r.z, xz * r.x + yz * r.y)
            + select(vec3<f32>(0.0), motion, is_free);
        preconditioned[at] = z.x;
        preconditioned[at + 1u] = z.y;
        preconditioned[at + 2u] = z.z;
        sum = vec2<f32>(dot(r, z), dot(r, r));
    }
    let of_group = sum_of_group(local, sum);
    let group = patch_row(group_id, groups);
    if local == 0u && group < extent.groups {
        partials[group] = of_group;
    }
}
