// Where integrate will take a node, from what its loads are by now; twin of Factors::foresee. damped is in
// damping_coefficient.wgsl, relaxation.wgsl or generated.
@group(0) @binding(0) var<storage, read> mass: array<f32>;
@group(0) @binding(1) var<storage, read> constrained_axes: array<u32>;
@group(0) @binding(2) var<storage, read> displacement: array<f32>;
@group(0) @binding(3) var<storage, read> displacement_increment: array<f32>;

struct Foreseen {
    before: vec3<f32>, // the last step (m)
    predicted: vec3<f32>, // the next one (m)
    free: vec3<f32>, // 1 along axes that are free, 0 along others
    to_force: f32, // the force that a push of 1 m comes to (N)
}

fn displacement_of(node: u32) -> vec3<f32> {
    let at = 3u * node;
    return vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
}

// Of a node that has mass.
fn foresee(node: u32) -> Foreseen {
    let at = 3u * node;
    let inertia = mass[node];
    let per_mass = 1.0 / inertia;
    let before = vec3<f32>(displacement_increment[at], displacement_increment[at + 1u], displacement_increment[at + 2u]);
    let held = (vec3<u32>(constrained_axes[node]) & vec3<u32>(1u, 2u, 4u)) != vec3<u32>(0u);
    let free = select(vec3<f32>(1.0), vec3<f32>(0.0), held);
    let force = external_force_of(node) - internal_force_of(node);
    let predicted = before + free * damped(node, before, (step.force_factor * per_mass) * force, per_mass);
    let to_force = inertia / (step.force_factor * damped(node, vec3<f32>(0.0), vec3<f32>(1.0), per_mass).x);
    return Foreseen(before, predicted, free, to_force);
}
