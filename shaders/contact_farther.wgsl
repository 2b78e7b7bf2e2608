// Notes that a node goes farther (m) than contact between surfaces has foreseen when it counted what it takes; twin of
// NodeColumns::note_farther. MET is generated.
@group(0) @binding(0) var<storage, read> contact_force: array<f32>;
@group(0) @binding(1) var<storage, read_write> surface_touch: array<f32>;

fn note_farther(node: u32, farther: vec3<f32>) {
    let at = 3u * node;
    let force = vec3<f32>(contact_force[at], contact_force[at + 1u], contact_force[at + 2u]);
    surface_touch[MET * node + 7u] -= step.work_factor * 0.5 * dot(force, farther);
}
