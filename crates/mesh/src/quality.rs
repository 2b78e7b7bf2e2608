//! How good the shapes of elements are: 1 is regular, 0 is flat, below 0 is inside out.

use super::Mesh;

/// Ranges of quality in a histogram, from 0 to 1.
pub const BINS: usize = 10;

/// The quality of each element: mean ratio of tetrahedra, scaled Jacobian of hexahedra.
#[derive(Clone, Debug, serde::Serialize)]
#[doc(hidden)]
pub struct Quality {
    /// Rows of elements with their quality, the ten worst, the worst first.
    pub worst: Vec<(usize, f64)>,
    /// How many elements there are in each tenth from 0 to 1; those below 0 are in the first.
    pub histogram: [usize; BINS],
    /// The mean of all elements.
    pub mean: f64,
}

impl Mesh {
    /// The quality of an element: that of its [kind](super::topology::Solid::quality).
    #[doc(hidden)]
    pub fn element_quality(&self, row: usize) -> f64 {
        self.cells.kind(row).topology().solid.map_or(0.0, |solid| (solid.quality)(&self.places(row)))
    }

    /// The quality of all elements, in short.
    #[doc(hidden)]
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
mod tests;
