// A load that a scene has in WGSL alone; twin of systems/own_load.rs. own_load is generated, which calls own_load_on.
// load: slot of the curve (signal), and 1, or 0 in a static analysis, whose steps are no motion (velocity_factor).

// The scene's function: linked.
fn force_on(state: Node) -> vec3<f32> {
    return vec3<f32>(0.0);
}

// What has lost all its elements bears nothing.
fn own_load_on(node: u32) {
    if mass[node] > 0.0 {
        let at = 3u * node;
        var state: Node;
        state.rest_position = vec3<f32>(rest_position[at], rest_position[at + 1u], rest_position[at + 2u]);
        state.displacement = vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
        let last = vec3<f32>(displacement_increment[at], displacement_increment[at + 1u], displacement_increment[at + 2u]);
        state.velocity = last * (step.rate * load.velocity_factor);
        state.mass = mass[node];
        state.curve = step.signals[load.signal].x;
        state.time = step.time;
        state.time_step = step.time_step;
        add_load(node, force_on(state));
    }
}
