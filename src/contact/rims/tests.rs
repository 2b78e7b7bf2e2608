#![allow(clippy::expect_used)]

use super::super::facing::tests::faced;
use crate::contact::{Point, Surfaces};
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
