// The row (node, element, corner ...) an invocation works on, for kernels of `@workgroup_size(64)`.
// More than 65 535 workgroups do not fit one dimension; the rest continue in y.
// `id` is `global_invocation_id`, `groups` is `num_workgroups`. The last rows lie beyond the data: check the bound.
fn row(id: vec3<u32>, groups: vec3<u32>) -> u32 {
    return id.y * (groups.x * 64u) + id.x;
}

// The same for kernels that give one patch to a workgroup of any size: `id` is `workgroup_id`.
fn patch_row(id: vec3<u32>, groups: vec3<u32>) -> u32 {
    return id.y * groups.x + id.x;
}
