// A spring that slips and remembers where it holds; twin of bond.rs.
fn bond(node: u32) {
    let at = 3u * node;
    let u = vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
    var held = vec3<f32>(own(node, 0u), own(node, 1u), own(node, 2u));
    let far = length(u - held);
    if far > parameters.slip {
        held = u - (u - held) * (parameters.slip / far);
        for (var i = 0u; i < 3u; i++) {
            set_own(node, i, held[i]);
        }
    }
    add_load(node, parameters.stiffness * mass[node] * (held - u));
}
