//! A ratio by how far something is deformed, from samples of several kinds.

use super::LARGEST_RATIO;

/// Stiffness ratio by how far something is deformed, as straight pieces that never fall: above those between the
/// samples of each kind. (One line through all samples would be flat up to the last soft one before each stiff one.)
#[derive(Clone, Debug)]
pub(super) struct Table {
    /// Of each kind of samples deformation and ratio, both ascending once they are sorted.
    kinds: Vec<Vec<(f64, f64)>>,
    /// Deformation and ratio of all, both ascending.
    pub(super) points: Vec<(f64, f64)>,
    /// The first of them in each [`bucket`] of deformations, or else behind it.
    first: Vec<usize>,
}

impl Table {
    pub(super) fn new() -> Self {
        Self { kinds: Vec::new(), points: vec![(1.0, 1.0)], first: vec![0, 1] }
    }

    /// Takes a sample of a kind: deformation and ratio. It counts once all are sorted.
    pub(super) fn add(&mut self, kind: usize, sample: (f64, f64)) {
        if self.kinds.len() <= kind {
            self.kinds.resize(kind + 1, vec![(1.0, 1.0)]);
        }
        self.kinds[kind].push(sample);
    }

    pub(super) fn sort(&mut self) {
        self.kinds.iter_mut().for_each(never_falling);
        let mut sizes = vec![1.0];
        sizes.extend(self.kinds.iter().flatten().map(|(size, _)| *size));
        sizes.sort_by(f64::total_cmp);
        sizes.dedup();
        let of_all = |size: f64| self.kinds.iter().map(|kind| between(kind, size)).fold(1.0, f64::max);
        self.points = sizes.into_iter().map(|size| (size, of_all(size))).collect();
        never_falling(&mut self.points);
        let beyond = self.points.last().map_or(0, |(size, _)| bucket(*size) + 1);
        self.first = (0..=beyond).map(|b| self.points.partition_point(|(size, _)| bucket(*size) < b)).collect();
    }

    pub(super) fn at(&self, size: f64) -> f64 {
        let mut after = self.first.get(bucket(size)).copied().unwrap_or(self.points.len());
        while self.points.get(after).is_some_and(|(s, _)| *s < size) {
            after += 1;
        }
        match beside(&self.points, after) {
            [Some(before), Some(after)] => on_line(before, after, size),
            [None, _] => 1.0,
            [Some((s, g)), None] => (g * (size / s) * (size / s)).min(LARGEST_RATIO),
        }
    }

    /// Up to which deformation the ratio is at most that: 0 where it is more from the beginning.
    pub(super) fn until(&self, ratio: f64) -> f64 {
        let after = self.points.partition_point(|(_, g)| *g <= ratio);
        match beside(&self.points, after) {
            [Some((s0, g0)), Some((s1, g1))] => {
                // a billionth less, so that rounding leads to no more; pieces may be as short as that
                let size = s0 + (s1 - s0) * (ratio - g0) / (g1 - g0) * (1.0 - 1e-9);
                if self.at(size) <= ratio { size } else { s0 }
            }
            [Some((s, _)), None] => s,
            [None, _] => 0.0,
        }
    }
}

/// Sorts points by deformation; the ratio of each is the largest up to it, and of those of one deformation one is left.
fn never_falling(points: &mut Vec<(f64, f64)>) {
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut largest = 1.0_f64;
    for (_, ratio) in points.iter_mut() {
        largest = largest.max(*ratio);
        *ratio = largest;
    }
    points.dedup_by(|later, kept| {
        let same = later.0 == kept.0;
        if same {
            kept.1 = later.1;
        }
        same
    });
}

/// The ratio of a kind at a deformation; beyond its last sample that of this.
fn between(kind: &[(f64, f64)], size: f64) -> f64 {
    let after = kind.partition_point(|(s, _)| *s < size);
    match beside(kind, after) {
        [Some(before), Some(after)] => on_line(before, after, size),
        [Some((_, g)), None] | [None, Some((_, g))] => g,
        [None, None] => 1.0,
    }
}

/// The points before and after a place among them.
fn beside(points: &[(f64, f64)], after: usize) -> [Option<(f64, f64)>; 2] {
    [after.checked_sub(1).map(|before| points[before]), points.get(after).copied()]
}

/// The ratio of a deformation between two points.
fn on_line((s0, g0): (f64, f64), (s1, g1): (f64, f64), size: f64) -> f64 {
    g0 + (g1 - g0) * (size - s0) / (s1 - s0)
}

/// Which sixty-fourth of an octave from 1 on a size is in: the exponent and six bits of the mantissa.
fn bucket(size: f64) -> usize {
    ((size.to_bits() >> 46) as usize).saturating_sub((1.0_f64.to_bits() >> 46) as usize)
}
