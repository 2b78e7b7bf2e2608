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
mod tests;
