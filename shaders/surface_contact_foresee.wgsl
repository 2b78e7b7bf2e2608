// Where nodes of a surface would go, as integrate will find it, and how far for a force; between
// surface_contact_place.wgsl and surface_contact.wgsl. damped is in damping_coefficient.wgsl, relaxation.wgsl or
// generated; last_step is generated.
struct SurfaceBody {
    first: u32, // first node of the body's surface
    count: u32, // how many
    displacements: u32,
}
@group(0) @binding(0) var<uniform> body: SurfaceBody;
@group(0) @binding(0) var<storage, read> surface_rows: array<u32>; // four a node: its row, bits of its place at rest (m)
@group(0) @binding(0) var<storage, read> mass: array<f32>;
@group(0) @binding(0) var<storage, read> constrained_axes: array<u32>;
@group(0) @binding(0) var<storage, read> internal_force: array<f32>;
@group(0) @binding(0) var<storage, read> external_force: array<f32>;
@group(0) @binding(0) var<storage, read_write> surface_nodes: array<f32>;

@compute @workgroup_size(64)
fn surface_contact_foresee(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= body.count {
        return;
    }
    let node = surface_rows[4u * (body.first + i)];
    let at = 3u * node;
    let to = 16u * (body.first + i);
    let held = (vec3<u32>(constrained_axes[node]) & vec3<u32>(1u, 2u, 4u)) != vec3<u32>(0u);
    let free = select(vec3<f32>(1.0), vec3<f32>(0.0), held);
    let inertia = mass[node];
    var before = vec3<f32>(surface_nodes[to + 6u], surface_nodes[to + 7u], surface_nodes[to + 8u]);
    var after = vec3<f32>(0.0);
    var response = vec3<f32>(0.0);
    var went = vec3<f32>(0.0);
    if inertia > 0.0 {
        let inner = vec3<f32>(internal_force[at], internal_force[at + 1u], internal_force[at + 2u]);
        let outer = vec3<f32>(external_force[at], external_force[at + 1u], external_force[at + 2u]);
        let per_mass = 1.0 / inertia;
        after = before + free * damped(node, before, (step.force_factor * per_mass) * (outer - inner), per_mass);
        response = free * (step.force_factor * damped(node, vec3<f32>(0.0), vec3<f32>(1.0), per_mass).x * per_mass);
        went = last_step(node, before, held);
    } else {
        before = vec3<f32>(0.0);
    }
    surface_nodes[to + 3u] = after.x;
    surface_nodes[to + 4u] = after.y;
    surface_nodes[to + 5u] = after.z;
    surface_nodes[to + 6u] = before.x;
    surface_nodes[to + 7u] = before.y;
    surface_nodes[to + 8u] = before.z;
    surface_nodes[to + 9u] = response.x;
    surface_nodes[to + 10u] = response.y;
    surface_nodes[to + 11u] = response.z;
    surface_nodes[to + 12u] = went.x;
    surface_nodes[to + 13u] = went.y;
    surface_nodes[to + 14u] = went.z;
}
