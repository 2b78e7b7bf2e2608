//! Formulas for a point: the neo-Hookean law with fibres under stretches along the axes.

/// μ, κ and η (Pa); fibres along the first axis.
#[derive(Clone, Copy)]
pub struct Law {
    pub shear: f64,
    pub bulk: f64,
    pub fibres: f64,
}

impl Law {
    /// From Young's modulus (Pa) and Poisson's ratio.
    pub fn young(young: f64, poisson: f64) -> Self {
        Self { shear: young / (2.0 * (1.0 + poisson)), bulk: young / (3.0 * (1.0 - 2.0 * poisson)), fibres: 0.0 }
    }

    /// Energy per rest volume (J/m³) at stretches along the axes.
    fn energy(&self, [a, b, c]: [f64; 3]) -> f64 {
        let j = a * b * c;
        let factor = j.powf(-2.0 / 3.0);
        let fibre = factor * a * a - 1.0;
        0.5 * self.shear * (factor * (a * a + b * b + c * c) - 3.0)
            + 0.5 * self.bulk * (j - 1.0).powi(2)
            + 0.5 * self.fibres * fibre * fibre
    }

    /// First Piola-Kirchhoff stress (Pa) along the first axis.
    fn stress(&self, stretches: [f64; 3], axis: usize) -> f64 {
        let step = 1e-6 * stretches[axis];
        let at = |sign: f64| {
            let mut moved = stretches;
            moved[axis] += sign * step;
            self.energy(moved)
        };
        (at(1.0) - at(-1.0)) / (2.0 * step)
    }

    /// Stress (Pa) of a point stretched along the first axis between walls.
    pub fn confined(&self, stretch: f64) -> f64 {
        self.stress([stretch, 1.0, 1.0], 0)
    }

    /// Stress (Pa) of a point stretched along the first axis, its sides free.
    pub fn free(&self, stretch: f64) -> f64 {
        self.free_with_sides(stretch).1
    }

    /// The stretch across and the stress (Pa), followed from rest: further on, other stretches across are free of
    /// stress too.
    pub fn free_with_sides(&self, stretch: f64) -> (f64, f64) {
        const STEPS: i32 = 200;
        let mut across = 1.0;
        for step in 1..=STEPS {
            let along = stretch.powf(f64::from(step) / f64::from(STEPS));
            for _ in 0..20 {
                let h = 1e-4 * across;
                let at = |side: f64| self.stress([along, side, side], 1);
                across -= at(across) * 2.0 * h / (at(across + h) - at(across - h));
            }
        }
        (across, self.stress([stretch, across, across], 0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// σ and P at λ = 1.5 and .7: the closed-form values of E = 3000 Pa, ν = .45.
    #[test]
    fn uniaxial_stresses_are_the_known_ones() {
        let law = Law::young(3000.0, 0.45);
        for (stretch, expected) in [(1.5, 1035.4829), (0.7, -1347.7943), (2.0, 1673.0186)] {
            assert!((law.free(stretch) - expected).abs() < 1e-3, "{stretch}: {}", law.free(stretch));
        }
        // what stiff fibres cannot do without changing volume
        let fibred = Law { shear: 1e3, bulk: 1e4, fibres: 1e6 };
        let (across, _) = fibred.free_with_sides(1.02);
        assert!(across > 1.0 && fibred.stress([1.02, across, across], 1).abs() < 1e-3, "{across}");
    }
}
