#![allow(clippy::panic)]

use super::*;

/// Two roofs of two triangles each, the second turned over and by an angle (degrees), its ridge so high above the
/// other's.
fn roofs(height: f64, angle: f64) -> (Surfaces, Vec<DVec3>) {
    let roof = [(-1.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, -1.0, -1.0), (0.0, 1.0, -1.0)].map(DVec3::from);
    let turned = glam::DQuat::from_rotation_z(angle.to_radians());
    let over = roof.map(|at| turned * DVec3::new(at.x, -at.y, -at.z) + height * DVec3::Z);
    let triangles = vec![[0_u32, 2, 1], [0, 1, 3], [4, 6, 5], [4, 5, 7]];
    (Surfaces::new(8, triangles, vec![0, 0, 1, 1], vec![0.5; 4]), [roof, over].concat())
}

fn crossing(height: f64, angle: f64) -> Option<Crossing> {
    let (surfaces, places) = roofs(height, angle);
    let normals: Vec<DVec3> = (0..4).map(|triangle| surfaces.normal(&places, triangle)).collect();
    assert!(normals[0].z > 0.0 && normals[2].z < 0.0, "{normals:?}");
    let (edges, sides) = surfaces.edges();
    assert_eq!(edges.len(), 2, "one ridge each");
    assert_eq!(sides.iter().flatten().filter(|side| **side == 0).count(), 2);
    let now = Placed { places: &places, normals: &normals };
    surfaces.crossing(now, &edges[1], &edges[0], 0.2)
}

#[test]
fn ridges_that_cross_are_as_far_apart_as_they_are() {
    for (height, angle) in [(0.1, 90.0), (0.1, 35.0), (-0.1, 90.0), (0.0, 90.0)] {
        let found = crossing(height, angle).unwrap_or_else(|| panic!("{height} m, {angle}°"));
        assert!((found.gap - height).abs() < 1e-15 && (found.normal - DVec3::Z).length() < 1e-12, "{found:?}");
        assert!(found.weights.iter().flatten().all(|weight| (weight - 0.5).abs() < 1e-12), "{found:?}");
    }
}

#[test]
fn what_is_far_deep_or_parallel_does_not_cross() {
    for (height, angle) in [(0.21, 90.0), (-0.51, 90.0), (0.1, 0.0), (0.1, 180.0)] {
        assert_eq!(crossing(height, angle), None, "{height} m, {angle}°");
    }
}

#[test]
fn the_distance_of_segments_is_the_least_between_their_places() {
    let mut random = fastrand::Rng::with_seed(5);
    let mut place = || DVec3::new(random.f64(), random.f64(), random.f64());
    for _ in 0..200 {
        let (one, other) = ([place(), place()], [place(), place()]);
        let on = |ends: [DVec3; 2], step: usize| ends[0].lerp(ends[1], step as f64 / 60.0);
        let all = (0..=60).flat_map(|i| (0..=60).map(move |j| (i, j)));
        let least = all.map(|(i, j)| on(one, i).distance(on(other, j))).fold(f64::INFINITY, f64::min);
        let found = distance(one, other);
        // sampled places are a sixtieth of a length of at most √3 apart
        assert!(found <= least + 1e-12 && found >= least - 0.03, "{found} and {least}");
    }
}
