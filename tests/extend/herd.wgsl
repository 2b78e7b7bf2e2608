// A spring to where another node is; twin of herd.rs.
fn herd(node: u32) {
    let other = (node + 1u) % arrayLength(&mass);
    var apart = vec3<f32>(0.0);
    for (var i = 0u; i < 3u; i++) {
        apart[i] = displacement[3u * other + i] - displacement[3u * node + i];
    }
    add_load(node, parameters.stiffness * mass[node] * apart);
}
