// What points of a body's surface face, and with what they would meet in this step; twin of systems/surface_contact.
// First of a step are surface_contact_place.wgsl and surface_contact_foresee.wgsl, after it
// surface_contact_impulse.wgsl.
@group(0) @binding(0) var<storage, read> surface_nodes: array<f32>;
@group(0) @binding(0) var<storage, read> surface_rows: array<u32>;
@group(0) @binding(0) var<storage, read_write> surface_contacts: array<u32>;
@group(0) @binding(0) var<storage, read_write> surface_touch: array<f32>;

fn meeting(point: u32, triangle: u32) -> u32 {
    return surface.meetings + MEETING_WORDS * (point * surface.bodies + surface_faces[8u * triangle + 6u]);
}

fn thickness_of(point: u32, triangle: u32) -> f32 {
    return bitcast<f32>(surface_faces[meeting(point, triangle) + 3u]);
}

// Whether a triangle may be in a point's way at all: where lists do not hold, that is not known from them.
fn may_meet(node: u32, of_body: u32, triangle: u32) -> bool {
    if surface_faces[meeting(of_body, triangle)] == 0u {
        return false;
    }
    if surface_faces[8u * triangle + 6u] != of_body {
        return true;
    }
    for (var corner = 0u; corner < 3u; corner++) {
        if surface_faces[8u * triangle + corner] == node {
            return false;
        }
    }
    let starts = surface.apart + node;
    let all = surface.apart + surface.nodes + 1u;
    for (var place = surface_faces[starts]; place < surface_faces[starts + 1u]; place++) {
        if surface_faces[all + place] == triangle {
            return false;
        }
    }
    return true;
}

struct Faced {
    first: Facing,
    second: Facing,
}

fn faced(node: u32, of_body: u32) -> Faced {
    let hold = lists_hold();
    let starts = surface.list + node;
    let all = surface.list + surface.nodes + 1u;
    let begin = select(0u, surface_lists[starts], hold);
    let end = select(surface.triangles, surface_lists[starts + 1u], hold);
    let point = place_of(node);
    let reach_without = reach_of_step();
    var both: Faced;
    both.first.there = false;
    both.second.there = false;
    var own = vec3<f32>(0.0);
    var own_known = false;
    for (var place = begin; place < end; place++) {
        var triangle = place;
        if hold {
            triangle = surface_lists[all + place];
        } else if !may_meet(node, of_body, triangle) {
            continue;
        }
        let corners = corners_of(triangle, point);
        let found = nearest(corners);
        let reach = reach_without + thickness_of(of_body, triangle);
        let depth = bitcast<f32>(surface_faces[8u * triangle + 7u]);
        // no number is near nothing
        if !(length(found.at) <= max(reach, depth)) {
            continue;
        }
        var facing = outside(triangle, point, corners, found);
        if !facing.there || !(facing.gap >= -depth && facing.gap <= reach) {
            continue;
        }
        if !own_known {
            own = normal_of_node(node);
            own_known = true;
        }
        let turned = dot(facing.normal, own);
        if turned >= TURNED_AWAY {
            continue;
        }
        facing.way = (abs(facing.gap) + ALIKE * surface.edge) * (1.0 + TURNED_AWAY + turned);
        if !both.first.there || facing.way < both.first.way {
            if both.first.there && is_corner(facing, both.first) {
                both.second = both.first;
            }
            both.first = facing;
        } else if !both.second.there || facing.way < both.second.way {
            both.second = facing;
        }
        both.second.there = both.second.there && is_corner(both.first, both.second);
    }
    return both;
}

fn step_of(node: u32) -> vec3<f32> {
    let at = NODE_NUMBERS * node + 3u;
    return vec3<f32>(surface_nodes[at], surface_nodes[at + 1u], surface_nodes[at + 2u]);
}

fn write_numbers(at: u32, v: vec3<f32>) {
    let bits = bitcast<vec3<u32>>(v);
    surface_contacts[at] = bits.x;
    surface_contacts[at + 1u] = bits.y;
    surface_contacts[at + 2u] = bits.z;
}

fn last_step_of(node: u32) -> vec3<f32> {
    let at = NODE_NUMBERS * node + 6u;
    return vec3<f32>(surface_nodes[at], surface_nodes[at + 1u], surface_nodes[at + 2u]);
}

// Notes a contact where the point would end inside; where a spring keeps it out, where it is.
fn note(contact: u32, node: u32, of_body: u32, facing: Facing, kinematic_gap: f32, outside_by: f32, allowed: f32,
    friction: f32, slip: vec3<f32>) {
    let at = CONTACT_WORDS * contact;
    surface_contacts[at + ACTIVE] = 0u;
    if !facing.there {
        return;
    }
    let corners = 8u * facing.triangle;
    let relative = step_of(node) - facing.weights.x * step_of(surface_faces[corners])
        - facing.weights.y * step_of(surface_faces[corners + 1u]) - facing.weights.z * step_of(surface_faces[corners + 2u]);
    let meets = meeting(of_body, facing.triangle);
    let share = bitcast<f32>(surface_faces[meets + 4u]);
    var gap = kinematic_gap;
    var acts = BY_STEP;
    if share > 0.0 {
        let came = last_step_of(node) - facing.weights.x * last_step_of(surface_faces[corners])
            - facing.weights.y * last_step_of(surface_faces[corners + 1u])
            - facing.weights.z * last_step_of(surface_faces[corners + 2u]);
        let damping = bitcast<f32>(surface_faces[meets + 5u]);
        let inside = outside_by - allowed;
        if !(inside < 0.0) {
            return;
        }
        gap = spring_gap(share, damping, inside, dot(facing.normal, came));
        acts = BY_SPRING;
    } else if !(gap + dot(facing.normal, relative) < 0.0) {
        return;
    }
    surface_contacts[at + TRIANGLE] = facing.triangle;
    write_numbers(at + WEIGHTS, facing.weights);
    write_numbers(at + NORMAL, facing.normal);
    surface_contacts[at + GAP] = bitcast<u32>(gap);
    surface_contacts[at + FRICTION] = bitcast<u32>(friction);
    write_numbers(at + SLIP, slip);
    surface_contacts[at + PRESSING] = 0u;
    write_numbers(at + RUBBING, vec3<f32>(0.0));
    surface_contacts[at + SLIDING] = 0u;
    surface_contacts[at + OUTSIDE] = bitcast<u32>(outside_by);
    surface_contacts[at + ACTIVE] = acts;
}

@compute @workgroup_size(64)
fn surface_contact(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= surface.count {
        return;
    }
    if i == 0u {
        // nobody asks for these in this step any more
        let turn = 1u - (step.number & 1u);
        atomicStore(&surface_motion[turn], 0u);
        atomicStore(&surface_motion[2u + turn], 0u);
        if surface.first == 0u && !lists_hold() {
            atomicAdd(&surface_motion[4], 1u);
        }
    }
    let node = surface.first + i;
    let of_body = surface.body;
    let both = faced(node, of_body);
    let at = TOUCH_NUMBERS * surface_rows[4u * node];
    let slip = vec3<f32>(surface_touch[at], surface_touch[at + 1u], surface_touch[at + 2u]);
    let before = surface_touch[at + 3u];
    let state = surface_touch[at + 4u];
    let gap_before = surface_touch[at + 5u];
    var settling = surface.settling * step.time_step;
    if step.time * surface.settling >= 0.5 * surface.edge {
        settling *= 0.01;
    }
    if surface.relaxed != 0u {
        settling = FAR;
    }
    var allowed = 0.0;
    var outside_by = 0.0;
    if both.first.there {
        outside_by = both.first.gap - thickness_of(of_body, both.first.triangle);
        var expected = 0.0;
        if state == FACES {
            expected = gap_before - 2.0 * largest_step();
        } else if state != FREE {
            expected = gap_before;
        }
        allowed = max(min(before + min(outside_by - expected, 0.0) + settling, 0.0), min(outside_by, 0.0));
    }
    surface_touch[at + 3u] = allowed;
    let stuck = state == STICKS;
    var friction = vec2<f32>(0.0);
    if both.first.there {
        let meets = meeting(of_body, both.first.triangle);
        friction.x = bitcast<f32>(surface_faces[meets + select(2u, 1u, stuck)]);
    }
    var second_gap = 0.0;
    if both.second.there {
        let meets = meeting(of_body, both.second.triangle);
        friction.y = bitcast<f32>(surface_faces[meets + select(2u, 1u, stuck)]);
        second_gap = both.second.gap - thickness_of(of_body, both.second.triangle);
    }
    let gap = max(outside_by - allowed, -OUT * surface.edge);
    note(2u * node, node, of_body, both.first, gap, outside_by, allowed, friction.x, slip);
    note(2u * node + 1u, node, of_body, both.second, max(second_gap, -settling), second_gap, 0.0, friction.y,
        vec3<f32>(0.0));
    for (var k = 0u; k < 3u; k++) {
        surface_touch[at + k] = 0.0;
    }
    surface_touch[at + 4u] = select(FREE, FACES, both.first.there);
    surface_touch[at + 5u] = select(0.0, outside_by, both.first.there);
}
