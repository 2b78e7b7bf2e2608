//! How good the shapes of elements are: 1 is regular, 0 is flat, below 0 is inside out.

use super::Mesh;
use super::measure::{hex_determinants, tet_volume};
use glam::DVec3;

/// Ranges of quality in a histogram, from 0 to 1.
pub const BINS: usize = 10;

/// The quality of each element: mean ratio of tetrahedra, scaled Jacobian of hexahedra.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Quality {
    /// Rows of elements (tetrahedra first, then hexahedra) with their quality, the ten worst, the worst first.
    pub worst: Vec<(usize, f64)>,
    /// How many elements there are in each tenth from 0 to 1; those below 0 are in the first.
    pub histogram: [usize; BINS],
    /// The mean of all elements.
    pub mean: f64,
}

/// Mean ratio of a tetrahedron, 12 (3 V)^(2/3) / Σ l² over its edges (Liu and Joe 1994): 1 for the regular one.
pub fn mean_ratio(p: [DVec3; 4]) -> f64 {
    let edges = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
    let sum: f64 = edges.iter().map(|&[a, b]: &[usize; 2]| p[a].distance_squared(p[b])).sum();
    let volume = tet_volume(p);
    if sum > 0.0 { volume.signum() * 12.0 * (3.0 * volume.abs()).powf(2.0 / 3.0) / sum } else { 0.0 }
}

/// Scaled Jacobian of a hexahedron (Knupp 2000): the least of its corners' determinants over the lengths of their
/// edges: 1 for a cuboid.
pub fn scaled_jacobian(p: [DVec3; 8]) -> f64 {
    const NEIGHBOURS: [[usize; 3]; 8] =
        [[1, 3, 4], [2, 0, 5], [3, 1, 6], [0, 2, 7], [7, 5, 0], [4, 6, 1], [5, 7, 2], [6, 4, 3]];
    let determinants = hex_determinants(p);
    let scaled = |corner: usize| {
        let lengths: f64 = NEIGHBOURS[corner].iter().map(|&other| p[corner].distance(p[other])).product();
        if lengths > 0.0 { determinants[corner] / lengths } else { 0.0 }
    };
    (0..8).map(scaled).fold(1.0, f64::min)
}

impl Mesh {
    /// The quality of an element (tetrahedra first, then hexahedra).
    pub fn element_quality(&self, row: usize) -> f64 {
        match row.checked_sub(self.tets.len()) {
            None => mean_ratio(self.tet_corners(row)),
            Some(row) => scaled_jacobian(self.hex_corners(row)),
        }
    }

    /// The quality of all elements, in short.
    pub fn quality(&self) -> Quality {
        let mut all: Vec<(usize, f64)> =
            (0..self.element_count()).map(|row| (row, self.element_quality(row))).collect();
        let mut histogram = [0; BINS];
        for (_, quality) in &all {
            histogram[((quality * BINS as f64).max(0.0) as usize).min(BINS - 1)] += 1;
        }
        let mean = all.iter().map(|(_, quality)| quality).sum::<f64>() / all.len().max(1) as f64;
        all.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        all.truncate(10);
        Quality { worst: all, histogram, mean }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regular_elements_have_the_quality_one() {
        let tet = [(1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0)];
        let tet = tet.map(|(x, y, z)| DVec3::new(x, y, z));
        let right = if tet_volume(tet) > 0.0 { tet } else { [tet[1], tet[0], tet[2], tet[3]] };
        assert!((mean_ratio(right) - 1.0).abs() < 1e-14);
        assert!((mean_ratio([right[1], right[0], right[2], right[3]]) + 1.0).abs() < 1e-14, "inside out is below 0");
        let cube = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
        let cube = cube.map(|[x, y, z]| DVec3::new(f64::from(x), 2.0 * f64::from(y), 3.0 * f64::from(z)));
        assert!((scaled_jacobian(cube) - 1.0).abs() < 1e-14);
        // sheared by 45°: the angle between two edges at each corner has the sine of 45°
        let sheared = cube.map(|p| p + DVec3::new(p.z, 0.0, 0.0));
        assert!((scaled_jacobian(sheared) - 0.5_f64.sqrt()).abs() < 1e-14);
    }
}
