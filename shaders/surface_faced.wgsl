// Which of the faces that a point sees are in its way; twin of src/contact/facing.rs.

// Whether two faces are walls of a corner that the point is in, and the first is not behind the second.
fn is_corner(first: Facing, second: Facing, point: vec3<f32>) -> bool {
    let edge = min(edge_with(first.triangle), edge_with(second.triangle));
    let is_before = dot(second.normal, first.at - second.at) > -ALIKE * edge;
    return dot(first.normal, second.normal) < CORNER && is_before && rises(first, second, point, edge);
}

// How little a face is in a point's way.
fn in_way(facing: Facing, edge: f32) -> f32 {
    let inside = max(-facing.gap, 0.0) + ALIKE * edge;
    return max(facing.gap, 0.0) + inside * (1.0 + TURNED_AWAY + facing.turned);
}

// Whether a face is more in a point's way than another.
fn is_more_in_way(facing: Facing, other: Facing) -> bool {
    let edge = min(edge_with(facing.triangle), edge_with(other.triangle));
    return in_way(facing, edge) < in_way(other, edge);
}

struct Faced {
    first: Facing,
    second: Facing,
}

// Whether a point that is deep in a face is outside of the body, beyond what is thin behind that: in front of another
// face of the same body that is nearer. To what is beside a wall of a corner nothing of the body is nearer than where
// walls meet, neither in front of nor behind it.
fn is_behind_another(number: u32, point: vec3<f32>, facing: Facing, places: vec2<u32>, largest: f32) -> bool {
    let edge = edge_with(facing.triangle);
    let deep = ALIKE * edge;
    let distance = length(facing.at);
    let is_beside = facing.part == 0u && distance > (1.0 + ALIKE) * abs(facing.gap);
    if select(facing.gap >= -deep, distance <= deep, is_beside) {
        return false;
    }
    let all = surface.list + surface.items + 1u;
    let hold = lists_hold();
    let body = surface_faces[8u * facing.triangle + 6u];
    for (var place = places.x; place < places.y; place++) {
        let triangle = select(place, surface_lists[all + place], hold);
        if surface_faces[8u * triangle + 6u] != body || !(hold || may_meet(number, triangle)) {
            continue;
        }
        let corners = corners_of(triangle, point);
        let found = nearest(corners);
        let away = length(found.at);
        let reach = reach_of(meeting_with(triangle), largest);
        let depth = bitcast<f32>(surface_faces[8u * triangle + 7u]);
        // an edge where more than two faces meet is as near to all of them
        if away >= select((1.0 + ON_IT) * -facing.gap, distance - deep, is_beside) || away > max(reach, depth) {
            continue;
        }
        let other = outside(triangle, point, corners, found, edge);
        let is_seen = is_beside && other.gap >= -depth && other.gap <= reach;
        if other.there && (is_seen || other.gap > select(deep, 0.0, is_beside)) {
            return true;
        }
    }
    return false;
}

// Whether a place on a triangle is nearer to a side than so far (m), or beyond it.
fn is_near_side(facing: Facing, corners: array<vec3<f32>, 3>, near: f32) -> bool {
    let twice = length(cross(corners[1] - corners[0], corners[2] - corners[0]));
    return facing.weights.x * twice < near * length(corners[2] - corners[1])
        || facing.weights.y * twice < near * length(corners[0] - corners[2])
        || facing.weights.z * twice < near * length(corners[1] - corners[0]);
}

// The place of a wall that is nearest to a point, along the way to there, with the depth that it has in one of those
// that meet there.
fn where_they_meet(wall: Facing, point: vec3<f32>, deepest: f32) -> Faced {
    let found = nearest(corners_of(wall.triangle, point));
    let distance = length(found.at);
    var only: Faced;
    only.first = wall;
    only.first.weights = found.weights;
    only.first.at = found.at;
    only.first.normal = found.at / max(distance, 1e-37);
    only.first.gap = deepest;
    only.first.there = distance > 0.0;
    only.second.there = false;
    return only;
}

// The face that is most in a point's way, and of those that are walls of a corner with it the one that is: several
// triangles of each wall are as near to what is behind a node of the line in which walls meet. Behind three it is borne
// by where they meet.
fn faced(number: u32, point: vec3<f32>) -> Faced {
    let hold = lists_hold();
    let starts = surface.list + number;
    let all = surface.list + surface.items + 1u;
    let begin = select(0u, surface_lists[starts], hold);
    let end = select(surface.triangles, surface_lists[starts + 1u], hold);
    let largest = largest_step();
    var both: Faced;
    both.first.there = false;
    both.second.there = false;
    var deepest = 0.0;
    var is_tip = false; // whether it is behind three
    var own = vec3<f32>(0.0);
    var own_known = false;
    var others = 0u;
    // walls are looked for once the first is known, of those that face more than one, and a third once both are
    for (var turn = 0u; turn < 3u && (turn == 0u || others > 0u); turn++) {
        if turn == 2u && !(both.second.there && both.first.gap < 0.0 && both.second.gap < 0.0) {
            break;
        }
        for (var place = begin; place < end; place++) {
            var triangle = place;
            if hold {
                triangle = surface_lists[all + place];
            } else if !may_meet(number, triangle) {
                continue;
            }
            let corners = corners_of(triangle, point);
            let found = nearest(corners);
            let reach = reach_of(meeting_with(triangle), largest);
            let depth = bitcast<f32>(surface_faces[8u * triangle + 7u]);
            // no number is near nothing
            if !(length(found.at) <= max(reach, depth)) {
                continue;
            }
            var facing = outside(triangle, point, corners, found, edge_with(triangle));
            if !facing.there || !(facing.gap >= -depth && facing.gap <= reach) {
                continue;
            }
            if is_behind_another(number, point, facing, vec2<u32>(begin, end), largest) {
                continue;
            }
            if !own_known {
                own = normal_of_point(number);
                own_known = true;
            }
            // of its own body it may be a face beside its own
            if surface_faces[8u * triangle + 6u] != surface.body || dot(facing.normal, own) < TURNED_AWAY {
                facing = at_rim(number, point, own, facing, reach);
            }
            facing.turned = dot(facing.normal, own);
            if !facing.there || facing.turned >= TURNED_AWAY {
                continue;
            }
            if turn == 0u {
                others += u32(both.first.there);
                if !both.first.there || is_more_in_way(facing, both.first) {
                    both.first = facing;
                }
            } else if is_corner(both.first, facing, point) {
                if turn == 2u {
                    is_tip = is_tip || (facing.gap < 0.0 && dot(facing.normal, both.second.normal) < CORNER);
                    deepest = min(deepest, facing.gap);
                } else if !both.second.there || is_more_in_way(facing, both.second) {
                    both.second = facing;
                }
            }
        }
    }
    if is_tip {
        return where_they_meet(both.first, point, min(both.first.gap, deepest));
    }
    if both.first.there {
        both.first = at_end(number, point, both.first);
    }
    if both.second.there {
        both.second = at_end(number, point, both.second);
        // both may end outside of the same
        both.second.there = both.second.triangle != both.first.triangle;
    }
    return both;
}
