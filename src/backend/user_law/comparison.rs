//! Stresses against differences of energies.

use super::Complaint;

/// Allowed difference of a stress and the derivative of its energy, by differences of 1e-5: these err by 1e-7.
const DERIVATIVE: f64 = 1e-4;
/// The largest of the sizes of some numbers; NaN if one is.
pub(super) fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |largest: f64, x| if x.is_nan() { f64::NAN } else { largest.max(x.abs()) })
}

/// Stresses beside derivatives of energies.
#[derive(Default)]
pub(super) struct Comparison {
    /// Largest relative error, and where.
    worst: f64,
    at: String,
    found: f64,
    expected: f64,
    /// Sums for the factor that is between them, if it is one.
    products: f64,
    squares: f64,
    /// The pairs, scaled.
    pairs: Vec<(f64, f64)>,
}

impl Comparison {
    pub(super) fn add(&mut self, stress: &[f64], derivative: &[f64], least: f64, at: impl Fn() -> String) {
        let scale = largest(stress).max(largest(derivative)).max(least);
        for (&found, &expected) in stress.iter().zip(derivative) {
            self.products += found * expected / (scale * scale);
            self.squares += (expected / scale).powi(2);
            self.pairs.push((found / scale, expected / scale));
            let error = (found - expected).abs() / scale;
            if error > self.worst || error.is_nan() {
                (self.worst, self.at, self.found, self.expected) = (error, at(), found, expected);
            }
        }
    }

    pub(super) fn outcome(self, complaint: impl Fn(String) -> Complaint) -> Result<f64, Box<Complaint>> {
        if self.worst <= DERIVATIVE {
            return Ok(self.worst);
        }
        let (found, expected) = (self.found, self.expected);
        let factor = self.products / self.squares;
        let alike = self.pairs.iter().all(|(found, expected)| (found - factor * expected).abs() < 10.0 * DERIVATIVE);
        let complaint =
            complaint(format!("{found:.6} Pa, the derivative {expected:.6} Pa")).note(format!("at {}", self.at));
        Err(Box::new(match alike && factor.is_finite() {
            true => complaint
                .note(format!("it is {factor:.4} times the derivative everywhere: a factor too much or too little?")),
            false => complaint,
        }))
    }
}
