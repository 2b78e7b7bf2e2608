// What closed tools hold goes where they take it, whatever pushes, a thread a node that may be held; between
// surface_contact_foresee.wgsl and surface_contact.wgsl or glue.wgsl, twin of systems/grasp/foreseen.rs. Held it is by
// grasp.wgsl. GRASPS, NUMBERS and HOLDABLE are generated.

// two a grasp: the slot that says whether it is closed, and the first of those that say where its tool is
@group(0) @binding(0) var<storage, read> holds: array<u32>;
// seven a node: its number among those foreseen, its row, its place among who may be held, a bit for each grasp, bits
// of its place at rest (m)
@group(0) @binding(0) var<storage, read> holdable: array<u32>;
@group(0) @binding(0) var<storage, read> tool_hold: array<f32>;
@group(0) @binding(0) var<storage, read> displacement: array<f32>;
@group(0) @binding(0) var<storage, read_write> surface_nodes: array<f32>;

const HELD: f32 = 1.0;

@compute @workgroup_size(64)
fn surface_contact_hold(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= HOLDABLE {
        return;
    }
    let first = 7u * i;
    let to = 16u * holdable[first];
    let at = 3u * holdable[first + 1u];
    let rest = bitcast<vec3<f32>>(vec3<u32>(holdable[first + 4u], holdable[first + 5u], holdable[first + 6u]));
    let place = rest + vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
    let next = vec3<f32>(surface_nodes[to + 3u], surface_nodes[to + 4u], surface_nodes[to + 5u]);
    let response = vec3<f32>(surface_nodes[to + 9u], surface_nodes[to + 10u], surface_nodes[to + 11u]);
    let free = response > vec3<f32>(0.0);
    // the last one has it
    for (var left = GRASPS; left > 0u; left--) {
        let number = left - 1u;
        let own = NUMBERS * (GRASPS * holdable[first + 2u] + number);
        let takes_part = ((holdable[first + 3u] >> number) & 1u) == 1u && tool_hold[own + 3u] == HELD;
        if !takes_part || step.signals[holds[2u * number]].y <= 0.0 {
            continue;
        }
        let y = vec4<f32>(tool_hold[own + 6u], tool_hold[own + 7u], tool_hold[own + 8u], 1.0);
        let pose = holds[2u * number + 1u];
        let there = vec3<f32>(
            dot(step.signals[pose], y), dot(step.signals[pose + 1u], y), dot(step.signals[pose + 2u], y));
        let gap = select(vec3<f32>(0.0), there - place - next, free);
        for (var k = 0u; k < 3u; k++) {
            surface_nodes[to + 3u + k] = next[k] + gap[k];
            surface_nodes[to + 9u + k] = 0.0;
        }
        return;
    }
}
