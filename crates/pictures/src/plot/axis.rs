//! Logarithmic axes.

/// A logarithmic axis over some pixels.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    /// For values above 0, with some room on both sides and at least a decade; drawn from `from` to `to` (pixels).
    pub fn new(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.filter(|value| *value > 0.0 && value.is_finite()) {
            (low, high) = (low.min(value.log10()), high.max(value.log10()));
        }
        if low > high {
            (low, high) = (-3.0, 0.0);
        }
        let missing = (1.0 - (high - low)).max(0.0) / 2.0;
        let room = 0.07 * (high - low + 2.0 * missing) + missing;
        Self { low: low - room, high: high + room, from, to }
    }

    /// The pixel of a value.
    pub fn at(&self, value: f64) -> f64 {
        self.from + (self.to - self.from) * (value.log10() - self.low) / (self.high - self.low)
    }

    /// Whether a value lies on the axis.
    pub fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value.log10())
    }

    /// The least value on the axis.
    pub fn least(&self) -> f64 {
        10f64.powf(self.low)
    }

    /// Values with grid lines, and whether each is a power of ten. Few decades also get 2 and 5 as `true`.
    pub fn ticks(&self) -> Vec<(f64, bool)> {
        let few = self.high - self.low < 2.0;
        let mut ticks = Vec::new();
        for decade in self.low.floor() as i32..=self.high.ceil() as i32 {
            for digit in 1..10 {
                let value = f64::from(digit) * 10f64.powi(decade);
                if self.contains(value) {
                    ticks.push((value, digit == 1 || few && (digit == 2 || digit == 5)));
                }
            }
        }
        ticks
    }
}
