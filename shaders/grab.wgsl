// Springs and dampers to nodes that a program holds; twin of systems/grab.rs. MOST_HELD is generated.
struct HeldRow {
    row: u32, // behind the last held node the largest number, which no node has
    stiffness: f32, // N/m
    damping: f32, // N s/m
    most: f32, // the largest force (N)
    goal_x: f32, // the displacement to which it is pulled (m)
    goal_y: f32,
    goal_z: f32,
    stiffness_over_mass: f32, // of the node when it was grabbed (1/s²)
    damping_over_mass: f32, // (1/s)
    unused_1: u32,
    unused_2: u32,
    unused_3: u32,
}
@group(0) @binding(0) var<uniform> grabs: array<HeldRow, MOST_HELD>;

fn grab(node: u32) {
    for (var i = 0u; i < MOST_HELD && grabs[i].row != 0xffffffffu; i++) {
        if grabs[i].row == node && mass[node] > 0.0 {
            let held = grabs[i];
            let at = 3u * node;
            let u = vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
            let last = vec3<f32>(displacement_increment[at], displacement_increment[at + 1u], displacement_increment[at + 2u]);
            let goal = vec3<f32>(held.goal_x, held.goal_y, held.goal_z);
            // what elements that go take of the mass makes the spring softer: the stable step stays
            let stiffness = min(held.stiffness, held.stiffness_over_mass * mass[node]);
            let damping = min(held.damping, held.damping_over_mass * mass[node]);
            let force = stiffness * (goal - u) - damping * (step.rate * last);
            let size = length(force);
            add_load(node, select(force, force * (held.most / size), size > held.most));
        }
    }
}
