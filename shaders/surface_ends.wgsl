// What points face that are before sides and corners, by where they would end.

// What ends before a rim lacks less to a plane there than to the rim where it is so much of what it would lack to the
// plane if it went straight for the rim.
const LESS: f32 = 0.8;

// Whether all that is around a side or a corner is behind a plane through it, but for a twentieth.
fn are_behind(facing: Facing, point: vec3<f32>, normal: vec3<f32>) -> bool {
    let count = count_around(facing);
    for (var number = 0u; number < count; number++) {
        let other = around_part(facing, number);
        if other == NONE {
            continue;
        }
        var corners = corners_of(other, point);
        for (var corner = 0u; corner < 3u; corner++) {
            let off = corners[corner] - facing.at;
            if dot(off, normal) > ALIKE * length(off) {
                return false;
            }
        }
    }
    return true;
}

// What a point faces that is before a side or a corner, by where its step against that ends: a plane beside it to which
// it lacks nothing or clearly less, of such as are alike the first, where f32 knows them apart; twin of
// systems/surface_contact/ends.rs and src/contact/rims.rs.
fn at_end(point_number: u32, point: vec3<f32>, facing: Facing) -> Facing {
    let meets = meeting_with(facing.triangle);
    // a spring does not ask where a step ends
    if facing.part == 0u || meeting_number(meets, 4u) > 0.0 {
        return facing;
    }
    let goes_by = goes(parts_of(point_number, facing, point), NEXT);
    let within = meeting_number(meets, 3u) + SHARES * meeting_number(meets, EDGE);
    let lacks = within - dot(facing.normal, goes_by - facing.at);
    if !(lacks > 0.0) {
        return facing;
    }
    var found = facing;
    var least = FAR;
    let count = count_around(facing);
    for (var number = 0u; number < count; number++) {
        let triangle = around_part(facing, number);
        if triangle == NONE || !may_meet(point_number, triangle) {
            continue;
        }
        let corners = corners_of(triangle, point);
        let normal = normal_of(corners);
        let gap = -dot(corners[0], normal);
        let lacks_to_it = within - (gap + dot(normal, goes_by));
        let is_less = lacks_to_it <= max(0.0, LESS * dot(facing.normal, normal) * lacks);
        if all(normal == vec3<f32>(0.0)) || !(gap >= 0.0 && is_less && lacks_to_it < least - surface.rounding)
            || !are_behind(facing, point, normal) {
            continue;
        }
        least = lacks_to_it;
        found.triangle = triangle;
        found.normal = normal;
        found.gap = gap;
        found.part = 0u;
        found.at = -gap * normal;
        found.weights = weights_in_plane(array<vec3<f32>, 3>(
            corners[0] - found.at, corners[1] - found.at, corners[2] - found.at));
    }
    return found;
}
