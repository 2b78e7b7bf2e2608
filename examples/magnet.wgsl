// The magnet of examples/custom_system.rs on a GPU. Its columns, `parameters` and `step` are declared by the engine.
fn magnet(node: u32) {
    let angle = 6.2831853 * parameters.turns * step.time;
    let place = parameters.center + parameters.radius * vec3<f32>(cos(angle), sin(angle), 0.0);
    let at = 3u * node;
    let rest = vec3<f32>(rest_position[at], rest_position[at + 1u], rest_position[at + 2u]);
    let toward = place - rest - vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
    let near = exp(-dot(toward, toward) / (parameters.reach * parameters.reach));
    // it comes up slowly: a sudden pull would ring
    let strength = parameters.acceleration * min(step.time / 0.2, 1.0);
    add_load(node, mass[node] * strength * near * normalize(toward));
}
