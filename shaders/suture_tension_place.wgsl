// Where ends of threads are in a body, a thread an end, before suture_tension.wgsl. ENDS, how many there are in all
// bodies, is generated.
struct ThreadsOf {
    first: u32, // of the ends of the body
    count: u32,
    relaxed: u32, // whether it is a static analysis
}
@group(0) @binding(0) var<uniform> threads: ThreadsOf;
@group(0) @binding(0) var<storage, read> suture_ends: array<u32>; // starts of the nodes of each end; row, weight and mass at the start of each
@group(0) @binding(0) var<storage, read> displacement: array<f32>;
@group(0) @binding(0) var<storage, read> mass: array<f32>;
@group(0) @binding(0) var<storage, read_write> suture_places: array<f32>; // four an end: its displacement (m), the share of mass that is left

@compute @workgroup_size(64)
fn suture_tension_place(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= threads.count {
        return;
    }
    let end = threads.first + i;
    var moved = vec3<f32>(0.0);
    var left = 1.0;
    for (var number = suture_ends[end]; number < suture_ends[end + 1u]; number++) {
        let word = ENDS + 1u + 3u * number;
        let node = suture_ends[word];
        let at = 3u * node;
        let u = vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
        moved += bitcast<f32>(suture_ends[word + 1u]) * u;
        let start = bitcast<f32>(suture_ends[word + 2u]);
        left = min(left, select(0.0, mass[node] / max(start, 1e-37), start > 0.0));
    }
    suture_places[4u * end] = moved.x;
    suture_places[4u * end + 1u] = moved.y;
    suture_places[4u * end + 2u] = moved.z;
    suture_places[4u * end + 3u] = left;
}
