// Forces of threads on a body's sutured nodes, a thread a node, in a fixed order: after suture_tension.wgsl;
// suture.wgsl adds them to the loads.
struct ThreadsOf {
    first: u32,
    count: u32, // of the body's sutured nodes
    relaxed: u32,
}
@group(0) @binding(0) var<uniform> threads: ThreadsOf;
@group(0) @binding(0) var<storage, read> suture_pulled: array<u32>; // starts of the threads at each node; thread and signed weight of each
@group(0) @binding(0) var<storage, read> suture_pulls: array<f32>;
@group(0) @binding(0) var<storage, read_write> suture_force: array<f32>;

@compute @workgroup_size(64)
fn suture_tension_pull(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let node = row(id, groups);
    if node >= threads.count {
        return;
    }
    var force = vec3<f32>(0.0);
    for (var number = suture_pulled[node]; number < suture_pulled[node + 1u]; number++) {
        let word = threads.count + 1u + 2u * number;
        let at = 3u * suture_pulled[word];
        force += bitcast<f32>(suture_pulled[word + 1u]) * vec3<f32>(suture_pulls[at], suture_pulls[at + 1u], suture_pulls[at + 2u]);
    }
    suture_force[3u * node] = force.x;
    suture_force[3u * node + 1u] = force.y;
    suture_force[3u * node + 2u] = force.z;
}
