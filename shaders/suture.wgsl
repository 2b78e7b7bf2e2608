// Forces of threads on nodes; twin of systems/suture.rs.
fn suture(i: u32, node: u32) {
    add_load(node, vec3<f32>(suture_force[3u * i], suture_force[3u * i + 1u], suture_force[3u * i + 2u]));
}
