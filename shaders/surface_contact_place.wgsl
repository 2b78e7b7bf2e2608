// Where nodes of a surface are, and how far they have moved, before surface_contact.wgsl. Four words of surface_motion
// by turns: the square of the longest step in even and odd steps, that of the largest displacement since the lists
// were made, likewise; then how many steps had lists that did not hold.
struct SurfaceBody {
    first: u32, // first node of the body's surface
    count: u32, // how many
    displacements: u32, // where in surface_lists are those when they were made
}
@group(0) @binding(0) var<uniform> body: SurfaceBody;
@group(0) @binding(0) var<storage, read> surface_rows: array<u32>; // four a node: its row, bits of its place at rest (m)
@group(0) @binding(0) var<storage, read> surface_lists: array<u32>;
@group(0) @binding(0) var<storage, read> displacement: array<f32>;
@group(0) @binding(0) var<storage, read> displacement_increment: array<f32>;
@group(0) @binding(0) var<storage, read> surface_touch: array<f32>;
@group(0) @binding(0) var<storage, read_write> surface_nodes: array<f32>;
@group(0) @binding(0) var<storage, read_write> surface_motion: array<atomic<u32>>;

@compute @workgroup_size(64)
fn surface_contact_place(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= body.count {
        return;
    }
    let node = body.first + i;
    let of_node = 4u * node;
    let at = 3u * surface_rows[of_node];
    let rest = vec3<u32>(surface_rows[of_node + 1u], surface_rows[of_node + 2u], surface_rows[of_node + 3u]);
    let u = vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
    let d = vec3<f32>(displacement_increment[at], displacement_increment[at + 1u], displacement_increment[at + 2u]);
    let place = bitcast<vec3<f32>>(rest) + u;
    let then = body.displacements + 3u * node;
    let moved = u - bitcast<vec3<f32>>(vec3<u32>(surface_lists[then], surface_lists[then + 1u], surface_lists[then + 2u]));
    let to = 16u * node;
    surface_nodes[to] = place.x;
    surface_nodes[to + 1u] = place.y;
    surface_nodes[to + 2u] = place.z;
    surface_nodes[to + 6u] = d.x;
    surface_nodes[to + 7u] = d.y;
    surface_nodes[to + 8u] = d.z;
    surface_nodes[to + 15u] = surface_touch[MET * surface_rows[of_node] + 8u];
    // numbers that are not negative are in the order of their bits
    let turn = step.number & 1u;
    atomicMax(&surface_motion[turn], bitcast<u32>(dot(d, d)));
    atomicMax(&surface_motion[2u + turn], bitcast<u32>(dot(moved, moved)));
}
