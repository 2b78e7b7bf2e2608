// Closed tools take nodes along; twin of systems/grasp.rs. GRASPS and NUMBERS are generated; tools are in
// tool_row.wgsl, foresee in foreseen.wgsl.
struct GripRow {
    closed: u32, // the slot that says whether it is
    reach: f32, // how far a node may be when it closes (m)
    strength: f32, // the force above which a node slips out (N)
    counts_work: u32, // whether work is counted, and nodes slip out
}
@group(0) @binding(0) var<uniform> tools: array<ToolRow, GRASPS>;
@group(0) @binding(1) var<uniform> grips: array<GripRow, GRASPS>;
@group(0) @binding(2) var<storage, read> holdable: array<vec4<u32>>; // bits of the place at rest (m), and a bit for each grasp
@group(0) @binding(3) var<storage, read_write> tool_hold: array<f32>;

const HOLD_NUMBERS: u32 = 9u;
const HELD: f32 = 1.0;
const WITHOUT: f32 = 2.0;
const SLIPPED: f32 = 3.0;
const LET_GO: f32 = 4.0;

// A point of a tool that the three slots from one on take to the scene; of a difference of poses, how far it goes.
fn from_frame(at: u32, y: vec3<f32>) -> vec3<f32> {
    let of_tool = vec4<f32>(y, 1.0);
    return vec3<f32>(
        dot(step.signals[at], of_tool), dot(step.signals[at + 1u], of_tool), dot(step.signals[at + 2u], of_tool));
}

fn grasp(i: u32, node: u32) {
    // of several tools the last one has it
    var ends = vec4<f32>(0.0);
    for (var left = GRASPS; left > 0u; left--) {
        if ((holdable[i].w >> (left - 1u)) & 1u) == 1u {
            ends = hold(i, node, left - 1u, ends);
        }
    }
}

// What one tool does to one node, which others may take to a place already (the fourth number is 1): whom these let go
// it takes up where it is then. Gives where the node ends, if a tool holds it.
fn hold(i: u32, node: u32, number: u32, ends: vec4<f32>) -> vec4<f32> {
    let own = NUMBERS * (GRASPS * i + number);
    let is_closed = step.signals[grips[number].closed].y > 0.0;
    let open = tool_hold[own + 3u] == 0.0 || tool_hold[own + 3u] == LET_GO;
    if open && !is_closed {
        return ends;
    }
    // what it bore in the step before, which is nothing where it takes the node in this one
    let bore = any(vec3<f32>(tool_hold[own], tool_hold[own + 1u], tool_hold[own + 2u]) != vec3<f32>(0.0));
    for (var k = 0u; k < 3u; k++) {
        tool_hold[own + k] = 0.0;
    }
    if !is_closed {
        tool_hold[own + 3u] = select(0.0, LET_GO, tool_hold[own + 3u] == SLIPPED);
        return ends;
    }
    if mass[node] <= 0.0 {
        return ends;
    }
    let at = tools[number].signal;
    let rest = bitcast<vec3<f32>>(holdable[i].xyz);
    let place = rest + displacement_of(node);
    if open {
        // where the tool was at the beginning of the step
        let earlier = array<vec4<f32>, 3>(step.signals[at] - step.signals[at + 3u],
            step.signals[at + 1u] - step.signals[at + 4u], step.signals[at + 2u] - step.signals[at + 5u]);
        let y = into_frame(earlier, rest, displacement_of(node));
        tool_hold[own + 3u] = select(WITHOUT, HELD, distance_to(tools[number], y).w <= grips[number].reach);
        tool_hold[own + 6u] = y.x;
        tool_hold[own + 7u] = y.y;
        tool_hold[own + 8u] = y.z;
    }
    if tool_hold[own + 3u] != HELD {
        return ends;
    }
    if ends.w == 1.0 {
        let y = into_frame(array<vec4<f32>, 3>(step.signals[at], step.signals[at + 1u], step.signals[at + 2u]), vec3<f32>(0.0), ends.xyz);
        tool_hold[own + 6u] = y.x;
        tool_hold[own + 7u] = y.y;
        tool_hold[own + 8u] = y.z;
        return ends;
    }
    let of_tool = vec3<f32>(tool_hold[own + 6u], tool_hold[own + 7u], tool_hold[own + 8u]);
    let of_node = foresee(node);
    let gap = of_node.free * (from_frame(at, of_tool) - place - of_node.predicted);
    let force = of_node.to_force * gap;
    // to the end of the step it holds, as others have been told
    if bore && grips[number].counts_work != 0u && length(force) > grips[number].strength {
        tool_hold[own + 3u] = SLIPPED;
    }
    tool_hold[own] = force.x;
    tool_hold[own + 1u] = force.y;
    tool_hold[own + 2u] = force.z;
    if NUMBERS > HOLD_NUMBERS {
        // a hand feels the mean over a batch of steps
        tool_hold[own + 9u] += force.x;
        tool_hold[own + 10u] += force.y;
        tool_hold[own + 11u] += force.z;
    }
    if grips[number].counts_work != 0u {
        let on_node = step.work_factor * dot(force, 0.5 * (of_node.before + of_node.predicted + gap));
        // whom it held it moved as itself, and gives to it all that it does
        let lost = select(step.work_factor * dot(force, from_frame(at + 3u, of_tool)) - on_node, 0.0, bore);
        tool_hold[own + 4u] += on_node + lost;
        tool_hold[own + 5u] += lost;
    }
    add_load(node, force);
    return vec4<f32>(place + of_node.predicted + gap, 1.0);
}
