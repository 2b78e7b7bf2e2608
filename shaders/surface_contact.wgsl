// What points of a body's surface face, and with what they would meet in this step; twin of systems/surface_contact.
// What a point is stands in surface_point_node.wgsl or surface_point_face.wgsl, touch_of is generated. First of a step
// are surface_contact_place.wgsl and surface_contact_foresee.wgsl, after it surface_contact_edges.wgsl and
// surface_contact_share.wgsl.
@group(0) @binding(0) var<storage, read_write> surface_touch: array<f32>;

fn meeting_with(triangle: u32) -> u32 {
    return meeting(surface.body, surface_faces[8u * triangle + 6u]);
}

// The smaller edge of both bodies (m).
fn edge_with(triangle: u32) -> f32 {
    return meeting_number(meeting_with(triangle), EDGE);
}

// Whether a triangle may be in a point's way at all: where lists do not hold, that is not known from them.
fn may_meet(point: u32, triangle: u32) -> bool {
    if (surface_faces[meeting_with(triangle)] & MEETS) == 0u {
        return false;
    }
    if surface_faces[8u * triangle + 6u] != surface.body {
        return true;
    }
    if is_of_point(point, triangle) {
        return false;
    }
    let starts = surface.apart + point;
    let all = surface.apart + surface.points + 1u;
    for (var place = surface_faces[starts]; place < surface_faces[starts + 1u]; place++) {
        if surface_faces[all + place] == triangle {
            return false;
        }
    }
    return true;
}

// What a point faces that sees a face near its rim, where faces are looked at so far (m); twin of src/contact/rims.rs.
fn at_rim(number: u32, point: vec3<f32>, own: vec3<f32>, facing: Facing, reach: f32) -> Facing {
    let corners = corners_of(facing.triangle, point);
    let edge = edge_with(facing.triangle);
    let near = ALIKE * edge;
    if !is_near_side(facing, corners, near) {
        return facing;
    }
    let normal = normal_of(corners);
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    let outside = -dot(corners[0], normal);
    let toward = dot(own, normal);
    let toward_least = least_of_point(number, normal);
    var best = FAR;
    var least = -FAR;
    var flank = facing.triangle;
    let on_it = ON_IT * edge;
    // two of the flanks that see the point, if there are so many
    var seen_by = vec2<u32>(select(NONE, facing.triangle, outside > on_it), NONE);
    for (var corner = 0u; corner < 3u; corner++) {
        let node = surface_faces[8u * facing.triangle + corner];
        let starts = surface.around + node;
        let all_around = surface.around + surface.nodes + 1u;
        for (var place = surface_faces[starts]; place < surface_faces[starts + 1u]; place++) {
            let other = surface_faces[all_around + place];
            let of_other = corners_of(other, point);
            let other_normal = normal_of(of_other);
            if other == facing.triangle || all(other_normal == vec3<f32>(0.0)) || dot(other_normal, normal) >= RIM
                || dot(other_normal, middle - of_other[0]) >= 0.0 {
                continue;
            }
            let from_place = array<vec3<f32>, 3>(
                of_other[0] - facing.at, of_other[1] - facing.at, of_other[2] - facing.at);
            let distance = length(nearest(of_other).at);
            let depth = bitcast<f32>(surface_faces[8u * other + 7u]);
            if length(nearest(from_place).at) >= near || distance > max(depth, reach) || !may_meet(number, other) {
                continue;
            }
            let turned = dot(own, other_normal);
            let turned_least = least_of_point(number, other_normal);
            if -dot(of_other[0], other_normal) > on_it {
                if seen_by.x == NONE {
                    seen_by.x = other;
                } else if seen_by.x != other {
                    seen_by.y = other;
                }
            }
            if turned_least <= FLUSH && toward_least <= LOOKS {
                let outside_of_other = -dot(of_other[0], other_normal);
                if outside_of_other > -min(near, depth) && min(outside, outside_of_other) < near {
                    var nothing = facing;
                    nothing.there = false;
                    return nothing;
                }
            } else if toward_least > FLUSH || turned_least > LOOKS {
                least = max(least, turned);
                if turned < toward - TURNED_AWAY && turned + distance / edge < best {
                    best = turned + distance / edge;
                    flank = other;
                }
            }
        }
    }
    if best == FAR && toward >= least - TURNED_AWAY {
        return facing;
    }
    let of_flank = corners_of(flank, point);
    var faced = facing;
    faced.triangle = flank;
    faced.normal = normal_of(of_flank);
    faced.gap = -dot(of_flank[0], faced.normal);
    faced.part = 0u;
    if faced.gap <= -min(near, bitcast<f32>(surface_faces[8u * flank + 7u])) {
        return facing;
    }
    // the place below the point, and how far beyond the rim that is
    faced.at = -faced.gap * faced.normal;
    let off = array<vec3<f32>, 3>(of_flank[0] - faced.at, of_flank[1] - faced.at, of_flank[2] - faced.at);
    var beyond = length(nearest(off).at);
    // the wall of a face that leans is behind itself: what no other flank sees is in the body
    if (seen_by.x == NONE || seen_by.x == flank) && (seen_by.y == NONE || seen_by.y == flank) {
        beyond = 0.0;
    }
    if beyond >= on_it && flank == facing.triangle && faced.gap > beyond {
        return facing;
    }
    faced.weights = weights_in_plane(off);
    // what is behind the wall is before some face of the flank
    faced.there = beyond < on_it && (flank == facing.triangle || outside > -on_it);
    return faced;
}

// How far the end of a normal as long as the thickness has gone in the last step as the surface turned where a point
// faces it (m), around each node that bears the point.
fn turned_by(meets: u32, parts: Parts, normal: vec3<f32>) -> vec3<f32> {
    let thickness = meeting_number(meets, 3u);
    // what nothing holds does not go along
    if thickness <= 0.0 || max(meeting_number(meets, 1u), meeting_number(meets, 2u)) <= 0.0 {
        return vec3<f32>(0.0);
    }
    var turn = vec3<f32>(0.0);
    for (var part = OF_FACE; part < PARTS; part++) {
        if parts.weights[part] != 0.0 {
            turn -= parts.weights[part] * turn_around(parts.nodes[part], normal);
        }
    }
    return thickness * cross(turn, normal);
}

// How the surface around a node has turned in the last step (rad), but for turns about its own normal: triangles count
// by their areas, and the more the more they look along a normal.
fn turn_around(node: u32, normal: vec3<f32>) -> vec3<f32> {
    let at = place_of(node);
    let starts = surface.around + node;
    let all_around = surface.around + surface.nodes + 1u;
    var across = vec3<f32>(0.0);
    var change = vec3<f32>(0.0);
    for (var place = surface_faces[starts]; place < surface_faces[starts + 1u]; place++) {
        let triangle = surface_faces[all_around + place];
        let corners = corners_of(triangle, at);
        let by_a = last_step_of(surface_faces[8u * triangle]);
        let by_b = last_step_of(surface_faces[8u * triangle + 1u]) - by_a;
        let by_c = last_step_of(surface_faces[8u * triangle + 2u]) - by_a;
        // sides in the middle of the step, and how they changed in it
        let b = corners[1] - corners[0] - 0.5 * by_b;
        let c = corners[2] - corners[0] - 0.5 * by_c;
        let of_triangle = cross(b, c);
        let share = max(dot(normal, of_triangle), 0.0) / max(length(of_triangle), 1e-37);
        across += share * of_triangle;
        change += share * (cross(by_b, c) + cross(b, by_c));
    }
    let size = length(across);
    return select(vec3<f32>(0.0), cross(across / max(size, 1e-37), change / max(size, 1e-37)), size > 1e-30);
}

fn last_step_of(node: u32) -> vec3<f32> {
    let at = NODE_NUMBERS * node + LAST;
    return vec3<f32>(surface_nodes[at], surface_nodes[at + 1u], surface_nodes[at + 2u]);
}

// What holds a point: the static coefficient where it stuck in the last step, or touched nothing and does not slip.
fn friction_of(meets: u32, parts: Parts, turned: vec3<f32>, normal: vec3<f32>, state: f32) -> f32 {
    let before = goes(parts, LAST) - turned;
    let still = length(before - normal * dot(normal, before)) <= STILL * meeting_number(meets, EDGE);
    let is_held = state == STICKS || (state != SLIDES && still);
    return meeting_number(meets, select(2u, 1u, is_held));
}

// Notes the contact of a point if it meets something, of which only then it is known what holds it.
fn begin_if_met(contact: u32, meets: u32, parts: Parts, of_point: Begun, state: f32) {
    if !meets_it(meets, parts, of_point) {
        return;
    }
    let turned = turned_by(meets, parts, of_point.normal);
    var begun = of_point;
    begun.friction = friction_of(meets, parts, turned, begun.normal, state);
    begun.slip -= turned;
    begin(contact, meets, parts, begun);
}

// How a point is to something that it faces: how far outside now, and how far outwards it went in the last step (m).
struct Outside {
    now: f32,
    went: f32,
}

fn sight(point: u32, place: vec3<f32>, facing: Facing) -> Outside {
    let parts = parts_of(point, facing, place);
    let outside = gap_of(facing, parts, place) - meeting_number(meeting_with(facing.triangle), 3u);
    return Outside(outside, dot(facing.normal, goes(parts, LAST)));
}

// How much deeper (m) a point is than motion tells that was so far outside (m), of one face that it sees, or of two:
// twin of `allowed` in systems/surface_contact/gather.rs.
fn deeper_than_expected(
    did: f32, was_in_corner: bool, last: f32, first: Outside, second: Outside, sees_two: bool) -> f32 {
    let lowest = min(first.now, select(first.now, second.now, sees_two));
    if did == FREE {
        return lowest;
    }
    if was_in_corner || did == FACES {
        return lowest - (last - 2.0 * largest_step());
    }
    let of_first = first.now - (last + first.went);
    let of_second = second.now - (last + second.went);
    if !sees_two {
        return of_first;
    }
    let of_new = (second.now - second.went) - (first.now - first.went);
    if abs(of_first) <= abs(of_second) {
        return min(of_first, of_new + max(first.now - first.went, 0.0));
    }
    return min(of_second, max(second.now - second.went, 0.0) - of_new);
}

// The contact of a point with something that it faces, if it meets that.
fn meet(contact: u32, point: u32, place: vec3<f32>, facing: Facing, outside: Outside, allowed: f32, slip: vec3<f32>,
    did: f32) {
    let meets = meeting_with(facing.triangle);
    let edge = meeting_number(meets, EDGE);
    let gap = max(outside.now - allowed, -OUT * edge);
    let begun = Begun(facing.normal, gap, outside.now, allowed, SHARES * edge, 0.0, slip);
    begin_if_met(contact, meets, parts_of(point, facing, place), begun, did);
}

@compute @workgroup_size(64)
fn surface_contact(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= surface.count {
        return;
    }
    let point = surface.first + i;
    let place = place_of_point(point);
    let both = faced(point, place);
    let at = touch_of(point);
    let slip = vec3<f32>(surface_touch[at], surface_touch[at + 1u], surface_touch[at + 2u]);
    let before = surface_touch[at + 3u];
    let was_in_corner = surface_touch[at + 4u] >= IN_CORNER;
    let did = surface_touch[at + 4u] - select(0.0, IN_CORNER, was_in_corner);
    begin_none(2u * point);
    begin_none(2u * point + 1u);
    let in_corner = both.first.there && both.second.there;
    var allowed = 0.0;
    var lowest = 0.0;
    if both.first.there {
        let first = sight(point, place, both.first);
        lowest = first.now;
        var second = first;
        if both.second.there {
            second = sight(point, place, both.second);
        }
        if in_corner {
            lowest = min(lowest, second.now);
        }
        let settling = settling_of_step(meeting_with(both.first.triangle));
        let last = surface_touch[at + 5u];
        let deeper = deeper_than_expected(did, was_in_corner, last, first, second, in_corner);
        allowed = max(min(before + min(deeper, 0.0) + settling, 0.0), min(lowest, 0.0));
        meet(2u * point, point, place, both.first, first, allowed, slip, did);
        if both.second.there {
            meet(2u * point + 1u, point, place, both.second, second, allowed, slip, did);
        }
    }
    for (var k = 0u; k < 3u; k++) {
        surface_touch[at + k] = 0.0;
    }
    surface_touch[at + 3u] = allowed;
    surface_touch[at + 4u] = select(FREE, FACES, both.first.there) + select(0.0, IN_CORNER, in_corner);
    surface_touch[at + 5u] = lowest;
}
