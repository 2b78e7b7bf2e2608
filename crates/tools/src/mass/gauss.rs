//! Gauss and Legendre's rule.

use std::f64::consts::PI;

const POINTS: usize = 20;

/// Places between -1 and 1, and their weights: to rounding, of what is smooth.
pub(super) struct Rule([[f64; 2]; POINTS]);

impl Rule {
    pub fn new() -> Self {
        Self(std::array::from_fn(|i| {
            // the roots of Legendre's polynomial, by Newton's iterations from where they nearly are
            let n = POINTS as f64;
            let mut x = (PI * (i as f64 + 0.75) / (n + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..8 {
                let (mut before, mut value) = (1.0, x);
                for k in 2..=POINTS {
                    let k = k as f64;
                    (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
                }
                slope = n * (x * value - before) / (x * x - 1.0);
                x -= value / slope;
            }
            [x, 2.0 / ((1.0 - x * x) * slope * slope)]
        }))
    }

    /// Places between two, and their weights.
    pub fn between(&self, from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> + '_ {
        let (middle, half) = ((from + to) / 2.0, (to - from) / 2.0);
        self.0.iter().map(move |[place, weight]| (middle + half * place, half * weight))
    }
}
