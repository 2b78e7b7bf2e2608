// Springs and dampers to nodes that a program holds; twin of systems/grab.rs. MOST_HELD is generated.
struct HeldRow {
    row: u32, // behind the last held node the largest number, which no node has
    stiffness: f32, // N/m
    damping: f32, // N s/m
    most: f32, // the largest force (N)
    goal_x: f32, // the displacement to which it is pulled (m)
    goal_y: f32,
    goal_z: f32,
    unused: u32,
}
@group(0) @binding(0) var<uniform> grabs: array<HeldRow, MOST_HELD>;
@group(0) @binding(1) var<storage, read> mass: array<f32>;
@group(0) @binding(2) var<storage, read> displacement: array<f32>;
@group(0) @binding(3) var<storage, read> displacement_step: array<f32>;

fn grab(node: u32) {
    for (var i = 0u; i < MOST_HELD && grabs[i].row != 0xffffffffu; i++) {
        if grabs[i].row == node && mass[node] > 0.0 {
            let held = grabs[i];
            let at = 3u * node;
            let u = vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
            let last = vec3<f32>(displacement_step[at], displacement_step[at + 1u], displacement_step[at + 2u]);
            let goal = vec3<f32>(held.goal_x, held.goal_y, held.goal_z);
            let force = held.stiffness * (goal - u) - held.damping * (step.rate * last);
            let size = length(force);
            add_load(node, select(force, force * (held.most / size), size > held.most));
        }
    }
}
