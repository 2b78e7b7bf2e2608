//! Points of faces that may meet others: those at which a quadrature of degree two or three looks at a pressure.

use glam::DVec3;

/// Weights of the corners of a triangle at its points (Strang and Fix 1973, degree 2).
const OF_TRIANGLE: [[f64; 4]; 3] = [
    [2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0, 0.0],
    [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0, 0.0],
    [1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0, 0.0],
];

/// Bilinear weights of the corners of a quadrilateral at the points of Gauss, 2 × 2: of the nearest corner ¼ (1 +
/// 1/√3)², of the one across ¼ (1 − 1/√3)².
const NEAREST: f64 = 0.622_008_467_928_146_2;
const ADJACENT: f64 = 1.0 / 6.0;
const OPPOSITE: f64 = 0.044_658_198_738_520_45;
const OF_QUADRILATERAL: [[f64; 4]; 4] = [
    [NEAREST, ADJACENT, OPPOSITE, ADJACENT],
    [ADJACENT, NEAREST, ADJACENT, OPPOSITE],
    [OPPOSITE, ADJACENT, NEAREST, ADJACENT],
    [ADJACENT, OPPOSITE, ADJACENT, NEAREST],
];

/// What the corners of a facet have of each of its points, the point nearest to the first corner first; a triangle
/// repeats its last corner.
pub fn face_points([_, _, third, last]: [u32; 4]) -> &'static [[f64; 4]] {
    if third == last { &OF_TRIANGLE } else { &OF_QUADRILATERAL }
}

/// Steps of Newton from the middle of a quadrilateral; of a parallelogram the first is exact.
const STEPS: usize = 4;

/// What the corners of a quadrilateral have of a place on it, by bilinear weights; of a place beside it those of its
/// rim.
pub fn bilinear(at: DVec3, [a, b, c, d]: [DVec3; 4]) -> [f64; 4] {
    let (mut x, mut y) = (0.5, 0.5);
    for _ in 0..STEPS {
        let (along_x, along_y) = ((b - a).lerp(c - d, y), (d - a).lerp(c - b, x));
        let off = at - a.lerp(b, x).lerp(d.lerp(c, x), y);
        let [xx, xy, yy] = [along_x.dot(along_x), along_x.dot(along_y), along_y.dot(along_y)];
        let (of_x, of_y) = (along_x.dot(off), along_y.dot(off));
        let size = xx * yy - xy * xy;
        // of one without area any weights will do
        if size > f64::MIN_POSITIVE {
            x = (x + (of_x * yy - of_y * xy) / size).clamp(0.0, 1.0);
            y = (y + (of_y * xx - of_x * xy) / size).clamp(0.0, 1.0);
        }
    }
    [(1.0 - x) * (1.0 - y), x * (1.0 - y), x * y, (1.0 - x) * y]
}

#[cfg(test)]
mod tests {
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
}
