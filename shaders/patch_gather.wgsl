// The force on a node inside a patch, which the workgroup has just summed; in place of gather.wgsl.
fn gather(node: u32) {
    let at = 3u * place_in_patch;
    // + 0: as a sum of one, to the bit
    set_internal_force(node, vec3<f32>(0.0) + vec3<f32>(patch_force[at], patch_force[at + 1u], patch_force[at + 2u]));
    clear_loads(node);
}
