// Closed tools take nodes along; twin of systems/grasp.rs. GRASPS and NUMBERS are generated; damped is in
// damping_coefficient.wgsl, relaxation.wgsl or generated; tool_distance is in tool_shape.wgsl, grid_distance in
// tool_of_grid.wgsl, or generated where no tool is a grid.
struct ToolRow {
    kind: u32,
    size_0: f32,
    size_1: f32,
    size_2: f32,
    size_3: f32,
    size_4: f32,
    size_5: f32,
    rounding: f32,
    signal: u32, // first of six slots: where it is, and how that differs from where it was
    sticking: f32,
    sliding: f32,
    spacing: f32, // of a grid, whose first point is at the first three sizes (m)
    nx: u32,
    ny: u32,
    nz: u32,
    first: u32,
}
struct GripRow {
    closed: u32, // the slot that says whether it is
    reach: f32, // how far a node may be when it closes (m)
    strength: f32, // the force above which a node slips out (N)
    books: u32, // whether work is counted
}
@group(0) @binding(0) var<uniform> tools: array<ToolRow, GRASPS>;
@group(0) @binding(1) var<uniform> grips: array<GripRow, GRASPS>;
@group(0) @binding(2) var<storage, read> holdable: array<vec4<u32>>; // bits of the place at rest (m), and a bit for each grasp
@group(0) @binding(3) var<storage, read> mass: array<f32>;
@group(0) @binding(4) var<storage, read> constrained_axes: array<u32>;
@group(0) @binding(5) var<storage, read> displacement: array<f32>;
@group(0) @binding(6) var<storage, read> displacement_increment: array<f32>;
@group(0) @binding(7) var<storage, read_write> tool_hold: array<f32>;

const HOLD_NUMBERS: u32 = 9u;
const TOOL_GRID: u32 = 0xffffffffu;
const HELD: f32 = 1.0;
const WITHOUT: f32 = 2.0;

fn distance_to(row: ToolRow, y: vec3<f32>) -> f32 {
    if row.kind == TOOL_GRID {
        return grid_distance(row, y).w;
    }
    return tool_distance(
        ToolShape(row.kind, row.size_0, row.size_1, row.size_2, row.size_3, row.size_4, row.size_5, row.rounding), y).w;
}

// A point of a tool that the three slots from one on take to the scene; of a difference of poses, how far it goes.
fn from_frame(at: u32, y: vec3<f32>) -> vec3<f32> {
    let of_tool = vec4<f32>(y, 1.0);
    return vec3<f32>(
        dot(step.signals[at], of_tool), dot(step.signals[at + 1u], of_tool), dot(step.signals[at + 2u], of_tool));
}

// A point of the scene in the frame in which the tool was at the beginning of the step.
fn into_frame(at: u32, x: vec3<f32>) -> vec3<f32> {
    let row_0 = step.signals[at] - step.signals[at + 3u];
    let row_1 = step.signals[at + 1u] - step.signals[at + 4u];
    let row_2 = step.signals[at + 2u] - step.signals[at + 5u];
    let y = x - vec3<f32>(row_0.w, row_1.w, row_2.w);
    return y.x * row_0.xyz + y.y * row_1.xyz + y.z * row_2.xyz;
}

fn grasp(i: u32, node: u32) {
    for (var number = 0u; number < GRASPS; number++) {
        if ((holdable[i].w >> number) & 1u) == 1u {
            hold(i, node, number);
        }
    }
}

fn hold(i: u32, node: u32, number: u32) {
    let own = NUMBERS * (GRASPS * i + number);
    let is_closed = step.signals[grips[number].closed].y > 0.0;
    let open = tool_hold[own + 3u] == 0.0;
    if open && !is_closed {
        return;
    }
    for (var k = 0u; k < 3u; k++) {
        tool_hold[own + k] = 0.0;
    }
    if !is_closed {
        tool_hold[own + 3u] = 0.0;
        return;
    }
    let inertia = mass[node];
    if inertia <= 0.0 {
        return;
    }
    let at = 3u * node;
    let signal = tools[number].signal;
    let u = vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
    let before = vec3<f32>(displacement_increment[at], displacement_increment[at + 1u], displacement_increment[at + 2u]);
    let place = bitcast<vec3<f32>>(holdable[i].xyz) + u;
    if open {
        let y = into_frame(signal, place);
        tool_hold[own + 3u] = select(WITHOUT, HELD, distance_to(tools[number], y) <= grips[number].reach);
        tool_hold[own + 6u] = y.x;
        tool_hold[own + 7u] = y.y;
        tool_hold[own + 8u] = y.z;
    }
    if tool_hold[own + 3u] != HELD {
        return;
    }
    let of_tool = vec3<f32>(tool_hold[own + 6u], tool_hold[own + 7u], tool_hold[own + 8u]);
    let held = (vec3<u32>(constrained_axes[node]) & vec3<u32>(1u, 2u, 4u)) != vec3<u32>(0u);
    let free = select(vec3<f32>(1.0), vec3<f32>(0.0), held);
    let other = external_force_of(node) - internal_force_of(node);
    let per_mass = 1.0 / inertia;
    let predicted = before + free * damped(node, before, (step.force_factor * per_mass) * other, per_mass);
    // what a push of 1 comes to
    let to_force = inertia / (step.force_factor * damped(node, vec3<f32>(0.0), vec3<f32>(1.0), per_mass).x);
    let gap = free * (from_frame(signal, of_tool) - place - predicted);
    let force = to_force * gap;
    if length(force) > grips[number].strength {
        tool_hold[own + 3u] = WITHOUT;
        return;
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
    if grips[number].books != 0u {
        let work = step.booked * dot(force, from_frame(signal + 3u, of_tool));
        tool_hold[own + 4u] += work;
        tool_hold[own + 5u] += work - step.booked * dot(force, 0.5 * (before + predicted + gap));
    }
    add_load(node, force);
}
