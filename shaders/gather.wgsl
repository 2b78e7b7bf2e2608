// Sums element forces at the nodes in a fixed order; twin of systems/gather.rs. set_internal_force and clear_loads are
// in internal_force.wgsl and external_force.wgsl, or, where integrate shares the kernel, in their patch-local twins.
// STRIDE is generated. corners: where each node's begin, and the end; behind these, where in element_force they are.
fn gather(node: u32) {
    var sum = vec3<f32>(0.0);
    for (var i = corners[node]; i < corners[node + 1u]; i++) {
        let at = corners[i];
        sum += vec3<f32>(element_force[at], element_force[at + STRIDE], element_force[at + 2u * STRIDE]);
    }
    set_internal_force(node, sum);
    clear_loads(node);
}
