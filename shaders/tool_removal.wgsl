// Lists the elements in a tool's reach; twin of systems/tool_removal.rs. criterion_due and step_that_comes are
// generated, tool_distance is in tool_shape.wgsl. In which order they are listed does not matter:
// tool_removal_choice.wgsl chooses by key and number.
struct Reach {
    kind: u32, // of a disc or a shape, then its sizes (m)
    size_0: f32,
    size_1: f32,
    size_2: f32,
    size_3: f32,
    size_4: f32,
    size_5: f32,
    rounding: f32,
    pose: u32, // first slot of where the tool is
    reach: f32, // (m)
}
@group(0) @binding(0) var<uniform> reach: Reach;
@group(0) @binding(1) var<storage, read> rest_shape: array<f32>;
@group(0) @binding(2) var<storage, read> alive: array<u32>;
@group(0) @binding(3) var<storage, read> removal_step: array<u32>;
@group(0) @binding(4) var<storage, read_write> tool_reach: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read> rest_points: array<f32>; // of nodes, from the reference (m)
@group(0) @binding(6) var<storage, read> numbers: array<u32>; // the author's place; 0xffffffff: it stays

const DISC: u32 = 0xffffffffu;

// How far a place in the tool's frame is from its mouth (m).
fn distance_from_mouth(y: vec3<f32>) -> f32 {
    if reach.kind == DISC {
        return length(vec2<f32>(max(length(y.xy) - reach.size_0, 0.0), y.z));
    }
    return tool_distance(
        ToolShape(reach.kind, reach.size_0, reach.size_1, reach.size_2, reach.size_3, reach.size_4, reach.size_5,
            reach.rounding), y).w;
}

// Bits that ascend with the number.
fn ascending(number: f32) -> u32 {
    let bits = bitcast<u32>(number);
    return select(bits | 0x80000000u, ~bits, (bits >> 31u) == 1u);
}

@compute @workgroup_size(64)
fn tool_removal(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let element = row(id, groups);
    if element >= block.count || !criterion_due() || numbers[element] == 0xffffffffu || alive[element] == 0u
        || removal_step[element] <= step_that_comes() {
        return;
    }
    var sum = vec3<f32>(0.0);
    for (var corner = 0u; corner < NODES; corner++) {
        let at = 3u * connectivity[place(element, NODES, corner)];
        sum += vec3<f32>(rest_points[at], rest_points[at + 1u], rest_points[at + 2u])
            + vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
    }
    let rows = array<vec4<f32>, 3>(
        step.signals[reach.pose], step.signals[reach.pose + 1u], step.signals[reach.pose + 2u]);
    let x = sum / f32(NODES) - vec3<f32>(rows[0].w, rows[1].w, rows[2].w);
    let found = distance_from_mouth(x.x * rows[0].xyz + x.y * rows[1].xyz + x.z * rows[2].xyz);
    if found > reach.reach {
        return;
    }
    let at = 1u + 3u * atomicAdd(&tool_reach[0], 1u);
    atomicStore(&tool_reach[at], ascending(found));
    atomicStore(&tool_reach[at + 1u], numbers[element]);
    atomicStore(&tool_reach[at + 2u], bitcast<u32>(rest_shape[place(element, ROWS, VOLUME_ROW)]));
}
