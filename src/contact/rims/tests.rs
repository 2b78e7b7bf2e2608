#![allow(clippy::expect_used)]

use super::super::facing::tests::faced;
use crate::contact::{Facing, Point, Surfaces};
use crate::mesh::OnTriangle;
use glam::DVec3;

/// A cube of edges of one metre whose lower face is at height 0 and whose front wall at x = 1, leaning forwards by so
/// much a metre of height, and a small triangle of another body with its first corner at a place, whose normal is
/// given.
fn before_cube(at: DVec3, own: DVec3, leans: f64) -> (Surfaces, Vec<DVec3>) {
    let straight = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
    let corner = |i: u32| straight(i) + leans * straight(i).z * DVec3::X;
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let cut = sides.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let triangles: Vec<[u32; 3]> = cut.chain([[8, 9, 10]]).collect();
    let along = own.any_orthonormal_vector();
    let places = (0..8).map(corner).chain([at, at + 0.1 * along, at + 0.1 * own.cross(along)]).collect();
    (Surfaces::new(11, triangles, [vec![0; 12], vec![1]].concat(), vec![0.5; 13]), places)
}

/// What the first corner of the triangle faces: normal and gap (m) of the face in its way, what each corner of that has
/// of the place below it, and whether there is another.
fn sees(at: [f64; 3], own: DVec3) -> Option<(DVec3, f64, DVec3, bool)> {
    sees_leaning(at, own, 0.0)
}

fn sees_leaning(at: [f64; 3], own: DVec3, leans: f64) -> Option<(DVec3, f64, DVec3, bool)> {
    let (surfaces, places) = before_cube(DVec3::from(at), own, leans);
    let point = Point { triangle: Some(12), ..Point::node(1, 8) };
    let all: Vec<u32> = (0..12).collect();
    let found = faced(&surfaces, &places, &point, &all, |_| 0.2);
    found.first.map(|first| {
        let corners = surfaces.corners(&places, first.triangle);
        let borne = corners.into_iter().zip(first.weights).map(|(corner, weight)| corner * weight).sum();
        (first.normal, first.gap, borne, found.second.is_some())
    })
}

/// Of a surface that looks up at the cube: before its wall, a little above its rim, behind it, and below.
#[test]
fn what_is_before_a_wall_at_its_rim_faces_the_flank() {
    // at sides and corners of triangles of the wall, too, and beside the rim's ends
    for y in [0.013, 0.3, 0.987] {
        for (beyond, above) in [(9e-4, 1e-9), (9e-4, 0.04), (1e-9, 0.03), (-0.02, 0.01), (-1e-9, 1e-9)] {
            for above in [above, -above] {
                let (normal, gap, borne, second) = sees([1.0 + beyond, y, above], DVec3::Z).expect("it faces one");
                assert!((normal + DVec3::Z).length() < 1e-12, "{beyond}, {above}: {normal}");
                assert!((gap + above).abs() < 1e-12 && !second, "{beyond}, {above}: {gap}");
                // what it bears is below it, so that forces have no moment
                let below = DVec3::new(1.0 + beyond, y, 0.0);
                assert!(borne.distance(below) < 1e-12, "{beyond}, {above}: {borne}");
            }
        }
        // farther before the wall nothing is in its way, until it is below the rim: that is rounded off
        for (beyond, above) in [(0.1, 0.04), (0.1, 1e-9), (0.1, -1e-9), (0.1, -0.05), (0.01, 0.04), (0.01, -1e-9)] {
            assert_eq!(sees([1.0 + beyond, y, above], DVec3::Z), None, "{beyond}, {above}");
        }
        let (normal, gap, ..) = sees([1.06, y, -0.08], DVec3::Z).expect("it faces the rim");
        assert!((normal - DVec3::new(0.6, 0.0, -0.8)).length() < 1e-12 && (gap - 0.1).abs() < 1e-12, "{normal} {gap}");
    }
}

/// However far off faces are looked at: farther than insides go, too, as where a step leads farther.
#[test]
fn what_is_far_before_a_wall_at_its_rim_does_not_face_it() {
    for (above, faces) in [(0.03, false), (-0.03, false), (0.06, true)] {
        let (surfaces, places) = before_cube(DVec3::new(1.6, 0.3, above), DVec3::Z, 0.0);
        let point = Point { triangle: Some(12), ..Point::node(1, 8) };
        let all: Vec<u32> = (0..12).collect();
        let found = faced(&surfaces, &places, &point, &all, |_| 0.8);
        assert_eq!(found.first.is_some(), faces, "{above}: {found:?}");
    }
}

#[test]
fn what_is_well_above_the_rim_or_faces_the_wall_meets_it() {
    for (above, own) in [(0.06, DVec3::Z), (0.3, DVec3::Z), (0.01, DVec3::NEG_X), (0.01, DVec3::new(-0.8, 0.0, 0.6))] {
        let (normal, gap, ..) = sees([1.01, 0.3, above], own.normalize()).expect("it faces the wall");
        assert!((normal - DVec3::X).length() < 1e-12 && (gap - 0.01).abs() < 1e-12, "{above}, {own}: {normal} {gap}");
    }
    // who faces both alike is kept off the rim itself
    let diagonal = DVec3::new(1.0, 0.0, -1.0).normalize();
    let (normal, gap, ..) = sees([1.01, 0.3, -0.01], -diagonal).expect("it faces the rim");
    assert!((normal - diagonal).length() < 1e-12 && (gap - 0.01 * 2_f64.sqrt()).abs() < 1e-12, "{normal} {gap}");
}

/// Of a wall that leans forwards what is in the body, as high as its lower rim, has the wall's plane before it beyond
/// the rim: it is in the body all the same, and is held by the wall. What the lower face sees is beyond.
#[test]
fn what_is_in_the_body_at_the_rim_of_a_leaning_wall_is_held() {
    for (y, leans) in [0.013, 0.3, 0.987].into_iter().flat_map(|y| [0.1, 0.3, 0.5].map(|leans| (y, leans))) {
        let normal = DVec3::new(1.0, 0.0, -leans).normalize();
        for (behind, above) in [(1e-3, 0.0), (0.02, 0.0), (0.04, 0.0), (0.02, 1e-4), (0.02, -5e-4)] {
            let what = format!("{y}, {leans}, {behind}, {above}");
            let (faced, gap, borne, _) = sees_leaning([1.0 - behind, y, above], DVec3::NEG_X, leans).expect(&what);
            let at = DVec3::new(1.0 - behind, y, above);
            let expected = (at - DVec3::X).dot(normal);
            assert!((faced - normal).length() < 1e-12 && (gap - expected).abs() < 1e-12, "{what}: {faced}, {gap}");
            assert!(borne.distance(at - gap * normal) < 1e-12, "{what}: {borne}");
        }
        assert_eq!(sees_leaning([0.98, y, -0.01], DVec3::NEG_X, leans), None, "{y}, {leans}");
    }
}

/// What the triangle's first corner faces by its end, of a triangle of the lower face at the cube's front rim, whose
/// nearest part it is before: with its step against that, and where only some triangles may be met. And the way.
fn at_end(
    (surfaces, places): &(Surfaces, Vec<DVec3>),
    step: [f64; 3],
    may_meet: impl Fn(u32) -> bool,
) -> (Facing, DVec3) {
    let (at, triangle) = (places[8], 1);
    let OnTriangle { at: nearest, weights, part } = OnTriangle::nearest(at, surfaces.corners(places, triangle));
    let gap = at.distance(nearest);
    let way = (at - nearest) / gap;
    let facing = Facing { triangle, weights, at: nearest, normal: way, gap, part: part as u32 };
    let point = Point { triangle: Some(12), ..Point::node(1, 8) };
    let found = surfaces.flank_at_end(places, (&point, DVec3::from(step), 0.0), facing, may_meet);
    if found.part == 0 {
        // what bears it is below it, so that forces have no moment
        let corners = surfaces.corners(places, found.triangle);
        let borne: DVec3 = corners.into_iter().zip(found.weights).map(|(corner, weight)| corner * weight).sum();
        assert!(borne.distance(at - found.gap * found.normal) < 1e-12, "{borne}");
    } else {
        assert_eq!(found, facing);
    }
    (found, way)
}

#[test]
fn what_is_before_a_rim_or_a_corner_faces_what_it_ends_the_farthest_outside_of() {
    for y in [0.013, 0.3, 0.987, -0.05] {
        let cube = before_cube(DVec3::new(1.06, y, -0.08), DVec3::Z, 0.0);
        for (step, normal, gap) in [
            // by below the cube, or into it a little above its lower face
            ([-0.22, 0.0, 0.0], DVec3::NEG_Z, 0.08),
            ([-0.3, 0.2, 0.1], DVec3::NEG_Z, 0.08),
            // up before its front wall, or into that
            ([-0.02, 0.1, 0.3], DVec3::X, 0.06),
            ([-0.08, 0.1, 0.3], DVec3::X, 0.06),
        ] {
            let (found, _) = at_end(&cube, step, |_| true);
            assert!((found.normal - normal).length() < 1e-12, "{y}, {step:?}: {}", found.normal);
            assert!((found.gap - gap).abs() < 1e-12, "{y}, {step:?}: {}", found.gap);
        }
        // before it still, and of planes that it may not meet none
        for step in [[0.0; 3], [-0.03, 0.0, 0.04]] {
            let (found, way) = at_end(&cube, step, |_| true);
            assert_eq!(found.normal, way, "{y}, {step:?}");
        }
        let (found, way) = at_end(&cube, [-0.2, 0.0, 0.0], |_| false);
        assert_eq!(found.normal, way, "{y}");
    }
}

/// What meets the rim itself is kept off it, whichever of its flanks it ends a little less inside of.
#[test]
fn what_goes_straight_for_a_rim_faces_that() {
    let cube = before_cube(DVec3::new(1.06, 0.3, -0.06), DVec3::Z, 0.0);
    for (right, up) in [(-0.08, 0.08), (-0.08, 0.085), (-0.085, 0.08), (-0.3, 0.3)] {
        let (found, way) = at_end(&cube, [right, 0.0, up], |_| true);
        assert_eq!(found.normal, way, "{right}, {up}");
    }
}

/// Below a wall that leans back far the point is behind its plane, and would be thrown out of that.
#[test]
fn a_plane_that_the_point_is_behind_is_not_faced() {
    let cube = before_cube(DVec3::new(1.02, 0.3, -0.08), DVec3::Z, -1.0);
    let (found, _) = at_end(&cube, [-0.2, 0.0, 0.1], |_| true);
    assert!((found.normal + DVec3::Z).length() < 1e-12 && (found.gap - 0.08).abs() < 1e-12, "{found:?}");
}

/// A corner whose front wall has a dent: what ends in the wall beside that is outside of a plane of the dent, and
/// inside the body.
#[test]
fn a_plane_before_which_the_surface_rises_is_not_faced() {
    let (surfaces, mut places) = before_cube(DVec3::new(1.08, -0.04, -0.045), DVec3::Z, 0.0);
    places[7].x = 0.5;
    let (found, _) = at_end(&(surfaces, places), [-0.1, 0.06, 0.345], |_| true);
    assert!((found.normal + DVec3::Y).length() < 1e-12 && (found.gap - 0.04).abs() < 1e-12, "{found:?}");
}
