use super::*;

#[test]
fn bilinear_weights_of_a_place_lead_back_to_it() {
    let mut random = fastrand::Rng::with_seed(3);
    for _ in 0..300 {
        let mut number = || 0.5 * random.f64();
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            .map(|(x, y)| DVec3::new(x + 0.6 * number(), y + 0.6 * number(), x - 2.0 * y));
        let [x, y] = [2.0 * number(), 2.0 * number()];
        let at = corners[0].lerp(corners[1], x).lerp(corners[3].lerp(corners[2], x), y);
        let weights = bilinear(at, corners);
        let found: DVec3 = corners.iter().zip(weights).map(|(corner, weight)| *corner * weight).sum();
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12 && found.distance(at) < 1e-6, "{weights:?}");
    }
    assert_eq!(bilinear(DVec3::ONE, [DVec3::ZERO; 4]), [0.25; 4]);
}

/// All points count alike: so linear functions, and squares of a triangle's, have the right mean.
#[test]
fn the_means_over_points_are_those_over_faces() {
    for (facet, corners) in [
        ([0, 1, 2, 2], &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]][..]),
        ([0, 1, 2, 3], &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]),
    ] {
        let points = face_points(facet);
        let mean = |of: &dyn Fn(f64, f64) -> f64| {
            let at = |weights: &[f64; 4], axis: usize| -> f64 {
                corners.iter().zip(weights).map(|(corner, weight)| corner[axis] * weight).sum()
            };
            points.iter().map(|weights| of(at(weights, 0), at(weights, 1))).sum::<f64>() / points.len() as f64
        };
        let is_triangle = corners.len() == 3;
        let near = |found: f64, exact: f64| assert!((found - exact).abs() < 1e-15, "{found} for {exact}");
        near(mean(&|_, _| 1.0), 1.0);
        near(mean(&|x, _| x), if is_triangle { 1.0 / 3.0 } else { 0.5 });
        near(mean(&|x, _| x * x), if is_triangle { 1.0 / 6.0 } else { 1.0 / 3.0 });
        near(mean(&|x, y| x * y), if is_triangle { 1.0 / 12.0 } else { 0.25 });
    }
}
