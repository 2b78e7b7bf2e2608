//! What the colours span: one range for a whole series.

use super::colour::Scale;

/// The values that are seen in a series, gathered frame by frame.
#[derive(Default)]
pub struct SeenValues {
    values: Vec<f32>,
}

impl SeenValues {
    /// Adds a value that is drawn.
    pub fn value(&mut self, value: f32) {
        if value.is_finite() {
            self.values.push(value);
        }
    }

    /// The least and the largest value that was added; of nothing the least is above the largest.
    pub(super) fn extremes(&self) -> (f32, f32) {
        let beyond_all = (f32::INFINITY, f32::NEG_INFINITY);
        self.values.iter().fold(beyond_all, |(least, most), value| (least.min(*value), most.max(*value)))
    }

    /// A scale for what was seen: from the value that one in two hundred lies below to that which one in two hundred
    /// exceeds, so that a few outliers do not wash out the rest. Sizes begin at 0; fields with a middle that have
    /// values on both sides of it span as much on either side.
    pub fn scale(mut self, centre: Option<f32>, sizes: bool) -> Scale {
        let (mut low, mut high) = (self.percentile(0.005), self.percentile(0.995));
        if sizes && low >= 0.0 {
            low = 0.0;
        }
        let least = 1e-6 * low.abs().max(high.abs());
        if let Some(centre) = centre {
            let (below, above) = (centre - low, high - centre);
            let reach = below.max(above);
            if reach > least && below.min(above) > 0.02 * reach {
                return Scale { range: (centre - reach, centre + reach), centre: Some(centre) };
            }
        }
        if high - low <= least {
            // one value everywhere, or nothing: that value in the middle
            let half = if high == 0.0 { 1.0 } else { high.abs() / 2.0 };
            (low, high) = if sizes { (0.0, 2.0 * half) } else { (high - half, high + half) };
        }
        Scale { range: (low, high), centre: None }
    }

    fn percentile(&mut self, share: f64) -> f32 {
        let last = match self.values.len() {
            0 => return 0.0,
            count => count - 1,
        };
        *self.values.select_nth_unstable_by((last as f64 * share).round() as usize, f32::total_cmp).1
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    fn scale(values: impl IntoIterator<Item = f32>, centre: Option<f32>, sizes: bool) -> Scale {
        let mut seen = SeenValues::default();
        values.into_iter().for_each(|value| seen.value(value));
        seen.scale(centre, sizes)
    }

    #[test]
    fn outliers_and_what_is_no_number_do_not_count() {
        let values = (0..1000).map(|row| row as f32).chain([1e30, f32::NAN, f32::INFINITY, -1e30]);
        let found = scale(values, None, false);
        assert!(found.range.0 < 10.0 && found.range.0 > 0.0 && found.range.1 > 990.0 && found.range.1 < 1000.0);
    }

    #[test]
    fn fields_with_two_sides_span_as_much_on_either() {
        assert_eq!(scale([-1.0, 3.0], Some(0.0), false), Scale { range: (-3.0, 3.0), centre: Some(0.0) });
        assert_eq!(scale([2.0, 3.0], Some(0.0), false), Scale { range: (2.0, 3.0), centre: None });
        assert_eq!(scale([0.9, 1.05], Some(1.0), false).centre, Some(1.0));
    }

    #[test]
    fn a_range_is_never_empty() {
        for values in [&[][..], &[0.0], &[5.0, 5.0], &[-2.0], &[f32::NAN]] {
            for (centre, sizes) in [(None, true), (None, false), (Some(0.0), false), (Some(5.0), false)] {
                let range = scale(values.iter().copied(), centre, sizes).range;
                assert!(range.0 < range.1, "{values:?} {centre:?}: {range:?}");
            }
        }
    }
}
