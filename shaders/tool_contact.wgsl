// Rigid tools keep nodes outside; twin of systems/tool_contact.rs. TOOLS and NUMBERS are generated; tools are in
// tool_row.wgsl, foresee in foreseen.wgsl, spring_gap in contact_spring.wgsl, note_farther in
// contact_farther.wgsl or generated.
struct Limits {
    edge: f32, // who is farther off cannot be there within a step (m)
    settling: f32, // how fast nodes inside a tool come out (m/s); in a static analysis a tenth of an edge a step
    counts_work: u32, // whether work is counted
}
@group(0) @binding(0) var<uniform> tools: array<ToolRow, TOOLS>;
@group(0) @binding(1) var<uniform> limits: Limits;
@group(0) @binding(2) var<storage, read> touchable: array<vec4<u32>>; // bits of the place at rest (m), and a bit for each tool
@group(0) @binding(3) var<storage, read_write> tool_touch: array<f32>;

const TOUCH_NUMBERS: u32 = 10u;
const SPEED: u32 = 7u; // where it is kept how fast a tool went (m/s)
const STICKS: f32 = 1.0;
const SLIDES: f32 = 2.0;
const TURNS: u32 = 12u;
const SETTLED: f32 = 1e-7; // changes of a turn, in edges, that are none
const STILL: f32 = 1e-6; // what is still slips by no more in a step, in edges
const SMOOTH: f32 = 0.9; // see systems/tool_contact/direction.rs

struct Touch {
    start: vec3<f32>, // outward normals where the node begins and where it ends
    normal: vec3<f32>,
    direction: vec3<f32>, // along which it is pushed; friction is across
    gap: f32, // how far from where it may be it ends (m)
    target_gap: f32, // where it may be: the distance from the surface (m)
    outwards: vec3<f32>, // what the tool adds (m)
    tool_step: vec3<f32>, // (m)
    friction: f32,
    tangential: vec3<f32>, // what the tool adds along the surface (m)
    push: f32, // and how far outwards
    touches: bool,
    touched: bool, // whether it did in the last step
    slides: bool, // whether friction does not hold it
    swept: bool, // whether it stays outside a plane, in the tool's frame: where its way first meets the tool
    plane_normal: vec3<f32>,
    plane_at: vec3<f32>, // (m)
}

// Where the way of a node first meets a tool; twin of systems/tool_contact/sweep.rs.
const SWEEP_TURNS: u32 = 64u;
const SWEEP_NEAR: f32 = 1e-3;

fn first_touch(tool: u32, start: vec3<f32>, end: vec3<f32>, touch: ptr<function, Touch>) {
    (*touch).swept = false;
    let beyond = tools[tool].swept;
    let way = distance(start, end);
    // false too of what is no number
    if beyond <= 0.0 || !(way > beyond) {
        return;
    }
    var share = 0.0;
    for (var turn = 0u; turn < SWEEP_TURNS; turn++) {
        let at = mix(start, end, share);
        let surface = distance_to(tools[tool], at);
        (*touch).plane_normal = surface.xyz;
        (*touch).plane_at = at - surface.w * surface.xyz;
        if surface.w <= SWEEP_NEAR * beyond {
            break;
        }
        share += surface.w / way;
        if share >= 1.0 {
            return;
        }
    }
    (*touch).swept = true;
}

// How far a place in the tool's frame is outside of what the node must stay outside of (m), and which way out is.
fn surface_of(tool: u32, touch: ptr<function, Touch>, at: vec3<f32>) -> vec4<f32> {
    if (*touch).swept {
        return vec4<f32>((*touch).plane_normal, dot((*touch).plane_normal, at - (*touch).plane_at));
    }
    return distance_to(tools[tool], at);
}

// A direction of the tool's frame in the scene's.
fn turned(pose: array<vec4<f32>, 3>, normal: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(pose[0].xyz, normal), dot(pose[1].xyz, normal), dot(pose[2].xyz, normal));
}

fn predict(
    tool: u32,
    rest: vec3<f32>,
    moved: vec3<f32>,
    before: vec3<f32>,
    predicted: vec3<f32>,
    state: f32,
) -> Touch {
    let at = tools[tool].signal;
    let pose = array<vec4<f32>, 3>(step.signals[at], step.signals[at + 1u], step.signals[at + 2u]);
    let change = array<vec4<f32>, 3>(step.signals[at + 3u], step.signals[at + 4u], step.signals[at + 5u]);
    let of_tool = into_frame(pose, rest, moved + predicted);
    let earlier = array<vec4<f32>, 3>(pose[0] - change[0], pose[1] - change[1], pose[2] - change[2]);
    var touch: Touch;
    touch.swept = false;
    if tools[tool].swept > 0.0 {
        first_touch(tool, into_frame(earlier, rest, moved), of_tool, &touch);
    }
    let surface = surface_of(tool, &touch, of_tool);
    let at_tool = vec4<f32>(of_tool, 1.0);
    touch.normal = turned(pose, surface.xyz);
    touch.start = touch.normal;
    touch.direction = touch.normal;
    touch.gap = surface.w;
    touch.target_gap = 0.0;
    touch.outwards = vec3<f32>(0.0);
    touch.tool_step = vec3<f32>(dot(change[0], at_tool), dot(change[1], at_tool), dot(change[2], at_tool));
    touch.tangential = vec3<f32>(0.0);
    touch.push = 0.0;
    touch.slides = true;
    touch.touches = surface.w <= limits.edge;
    if touch.touches {
        let here = into_frame(earlier, rest, moved);
        let now = distance_to(tools[tool], here);
        if !touch.swept {
            touch.start = turned(earlier, now.xyz);
        }
        if surface.w < 0.0 {
            var out = limits.settling * step.time_step;
            if limits.counts_work == 0u {
                out = 0.1 * limits.edge;
            }
            touch.target_gap = min(now.w + out, 0.0);
            touch.gap = surface.w - touch.target_gap;
        }
        if tools[tool].share > 0.0 {
            let at_here = vec4<f32>(here, 1.0);
            touch.normal = touch.start;
            touch.tool_step = vec3<f32>(dot(change[0], at_here), dot(change[1], at_here), dot(change[2], at_here));
            touch.gap = step.work_factor * spring_gap(
                tools[tool].share, tools[tool].damping, now.w, dot(touch.normal, before - touch.tool_step));
            touch.touches = touch.gap < 0.0;
        }
    }
    // what was not at the tool and does not slip along it is held as what stuck is
    let still = length(along_surface(before - touch.tool_step, touch.normal)) <= STILL * limits.edge;
    let is_held = state == STICKS || (state != SLIDES && still);
    touch.friction = select(tools[tool].sliding, tools[tool].sticking, is_held);
    return touch;
}

// Where the node ends by now.
fn evaluate_again(tool: u32, rest: vec3<f32>, moved: vec3<f32>, before: Touch) -> Touch {
    var touch = before;
    let at = tools[tool].signal;
    let pose = array<vec4<f32>, 3>(step.signals[at], step.signals[at + 1u], step.signals[at + 2u]);
    let of_tool = into_frame(pose, rest, moved);
    let surface = surface_of(tool, &touch, of_tool);
    let at_tool = vec4<f32>(of_tool, 1.0);
    touch.normal = turned(pose, surface.xyz);
    touch.gap = surface.w - touch.target_gap;
    touch.tool_step = vec3<f32>(
        dot(step.signals[at + 3u], at_tool), dot(step.signals[at + 4u], at_tool), dot(step.signals[at + 5u], at_tool));
    return touch;
}

// How far a tool that touches went in the last step, there (m), where its numbers at a node begin.
fn tool_before(at_tool: u32, touch: Touch, of_node: Foreseen) -> vec3<f32> {
    if !touch.touched {
        return touch.tool_step;
    }
    let at = at_tool + SPEED;
    let kept = step.time_step * vec3<f32>(tool_touch[at], tool_touch[at + 1u], tool_touch[at + 2u]);
    // there the node's last step is the one to come already
    let is_told = (of_node.free == vec3<f32>(0.0)) & (of_node.before != vec3<f32>(0.0));
    return select(kept, touch.tool_step, is_told);
}

fn along_surface(v: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return v - normal * dot(v, normal);
}

fn tool_contact(i: u32, node: u32) {
    let first = NUMBERS * TOOLS * i;
    let bits = touchable[i].w;
    let rest = bitcast<vec3<f32>>(touchable[i].xyz);
    let moved = displacement_of(node);
    let is_active = mass[node] > 0.0;
    var of_node: Foreseen;
    if is_active {
        of_node = foresee(node);
    }
    let predicted = of_node.predicted;
    let free = of_node.free;
    var found: array<Touch, TOOLS>;
    var touched = 0u;
    for (var tool = 0u; tool < TOOLS; tool++) {
        let at_tool = first + NUMBERS * tool;
        let state = tool_touch[at_tool + 3u];
        for (var k = 0u; k < 4u; k++) {
            tool_touch[at_tool + k] = 0.0;
        }
        found[tool].touches = false;
        if is_active && ((bits >> tool) & 1u) == 1u {
            found[tool] = predict(tool, rest, moved, of_node.before, predicted, state);
            found[tool].touched = state != 0.0;
            if found[tool].touches {
                touched++;
            }
        }
    }
    if touched == 0u {
        return;
    }
    var sum = vec3<f32>(0.0);
    for (var turn = 0u; turn < TURNS; turn++) {
        var most = 0.0;
        for (var tool = 0u; tool < TOOLS; tool++) {
            if !found[tool].touches {
                continue;
            }
            let waits = turn > 0u && tools[tool].share > 0.0;
            if turn > 0u && !waits {
                found[tool] = evaluate_again(tool, rest, moved + predicted + sum, found[tool]);
            }
            let end = found[tool].normal;
            let at_end = dot(end, free * end);
            let at_start = dot(end, free * found[tool].start);
            let is_smooth = at_start >= SMOOTH * at_end && SMOOTH * at_start <= at_end;
            let along = select(at_end, at_start, is_smooth);
            let way = select(end, found[tool].start, is_smooth);
            found[tool].direction = way;
            if along > 1e-9 && !waits {
                let push = max(found[tool].push - found[tool].gap / along, 0.0);
                let outwards = way * (push - found[tool].push);
                sum += free * outwards;
                found[tool].outwards += outwards;
                most = max(most, abs(push - found[tool].push));
                found[tool].push = push;
            }
            if found[tool].friction > 0.0 {
                let slip = along_surface(predicted + sum - found[tool].tool_step, way);
                let wanted = along_surface(found[tool].tangential, way) - slip;
                let bound = found[tool].friction * found[tool].push;
                let size = length(wanted);
                found[tool].slides = size > bound;
                let tangential = select(wanted, wanted * (bound / max(size, 1e-30)), size > bound);
                sum += free * (tangential - found[tool].tangential);
                most = max(most, length(tangential - found[tool].tangential));
                found[tool].tangential = tangential;
            }
        }
        if most <= SETTLED * limits.edge {
            break;
        }
    }
    let d = predicted + sum;
    if limits.counts_work != 0u {
        note_farther(node, sum);
    }
    var load = vec3<f32>(0.0);
    for (var tool = 0u; tool < TOOLS; tool++) {
        if !found[tool].touches || found[tool].push <= 0.0 {
            continue;
        }
        let force = of_node.to_force * (found[tool].outwards + found[tool].tangential);
        load += force;
        let at_tool = first + NUMBERS * tool;
        tool_touch[at_tool] = force.x;
        tool_touch[at_tool + 1u] = force.y;
        tool_touch[at_tool + 2u] = force.z;
        tool_touch[at_tool + 3u] = select(STICKS, SLIDES, found[tool].slides);
        if NUMBERS > TOUCH_NUMBERS {
            // a hand feels the mean over a batch of steps
            tool_touch[at_tool + TOUCH_NUMBERS] += force.x;
            tool_touch[at_tool + TOUCH_NUMBERS + 1u] += force.y;
            tool_touch[at_tool + TOUCH_NUMBERS + 2u] += force.z;
        }
        if limits.counts_work != 0u {
            let tool_step = found[tool].tool_step;
            let mean = 0.5 * (tool_before(at_tool, found[tool], of_node) + tool_step);
            let work = step.work_factor * dot(force, mean);
            let on_node = step.work_factor * dot(force, 0.5 * (of_node.before + d));
            tool_touch[at_tool + 4u] += length(along_surface(d - tool_step, found[tool].direction));
            tool_touch[at_tool + 5u] += work;
            tool_touch[at_tool + 6u] += work - on_node;
            for (var k = 0u; k < 3u; k++) {
                tool_touch[at_tool + SPEED + k] = step.rate * tool_step[k];
            }
        }
    }
    add_load(node, load);
}
