// The force on a node inside a patch, which the workgroup has just summed; in place of gather.wgsl.
fn gather(node: u32) {
    // + 0: as a sum of one, to the bit
    set_internal_force(node, vec3<f32>(0.0) + force_of_patch);
    clear_loads(node);
}
