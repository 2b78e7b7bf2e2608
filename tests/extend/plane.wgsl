// A floor that pushes back what has sunk into it; twin of plane.rs.
fn plane(node: u32) {
    let depth = parameters.height - (rest_position[3u * node + 2u] + displacement[3u * node + 2u]);
    if depth > 0.0 {
        let speed = step.rate * displacement_increment[3u * node + 2u];
        let push = max(parameters.stiffness * depth - parameters.damping * speed, 0.0);
        add_load(node, vec3<f32>(0.0, 0.0, mass[node] * push));
    }
}
