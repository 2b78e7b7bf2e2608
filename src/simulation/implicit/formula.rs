//! The formulas of implicit steps: one nonlinear system for the displacements w at the end of a step of h,
//!
//! M [(1 − α_m) a⁺ + α_m a] + C [(1 − α_f) v⁺ + α_f v] + (1 − α_f) (F − R)⁺ + α_f (F − R) = 0,
//!
//! with a⁺ = c (w − u − h v) + κ a and v⁺ = v + h (γ₀ a + γ a⁺). Forces of both ends are weighted, not those of a place
//! in between (the generalised trapezoidal rule: for linear bodies the same, of second order for others, too): the
//! forces at the end are then known when the step is solved, and viscous memories and loads have one time.

use crate::scene::schema::ImplicitScheme;

/// The numbers of a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::simulation) struct Formula {
    /// α_m and α_f.
    pub alpha_m: f64,
    pub alpha_f: f64,
    /// c h², and κ.
    pub of_displacement: f64,
    pub of_acceleration: f64,
    /// γ₀ and γ.
    pub before: f64,
    pub after: f64,
}

impl Formula {
    /// That of a scheme. Implicit Euler: v⁺ = (w − u)/h, a⁺ = (v⁺ − v)/h, forces of the end. Generalised-α (Chung &
    /// Hulbert 1993): γ = ½ − α_m + α_f, β = ¼ (1 − α_m + α_f)², α_m = (2ρ − 1)/(ρ + 1), α_f = ρ/(ρ + 1).
    pub fn of(scheme: ImplicitScheme) -> Self {
        match scheme {
            ImplicitScheme::Euler => {
                Self { alpha_m: 0.0, alpha_f: 0.0, of_displacement: 1.0, of_acceleration: 0.0, before: 0.0, after: 1.0 }
            }
            ImplicitScheme::GeneralizedAlpha { high_frequencies: rho } => {
                let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
                let (gamma, beta) = (0.5 - alpha_m + alpha_f, 0.25 * (1.0 - alpha_m + alpha_f).powi(2));
                Self {
                    alpha_m,
                    alpha_f,
                    of_displacement: 1.0 / beta,
                    of_acceleration: (beta - 0.5) / beta,
                    before: 1.0 - gamma,
                    after: gamma,
                }
            }
        }
    }

    /// That of rest: neither inertia nor damping.
    pub fn of_rest() -> Self {
        Self { alpha_m: 0.0, alpha_f: 0.0, of_displacement: 0.0, of_acceleration: 0.0, before: 0.0, after: 0.0 }
    }

    /// The acceleration at the end (m/s²), of h, w − u − h v (m) and the acceleration before.
    #[inline]
    pub fn acceleration(&self, h: f64, moved: f64, before: f64) -> f64 {
        self.of_displacement * moved / (h * h) + self.of_acceleration * before
    }

    /// The velocity at the end (m/s), of that before and both accelerations.
    #[inline]
    pub fn velocity(&self, h: f64, before: f64, accelerations: [f64; 2]) -> f64 {
        before + h * (self.before * accelerations[0] + self.after * accelerations[1])
    }

    /// Whether it is that of rest.
    #[inline]
    pub fn is_of_rest(&self) -> bool {
        self.of_displacement == 0.0
    }

    /// What a displacement of 1 m makes of the step (m), which is that of the velocity at the end; at rest the way
    /// there itself.
    pub fn step(&self) -> f64 {
        if self.is_of_rest() { 1.0 } else { self.after * self.of_displacement }
    }

    /// What a displacement of 1 m changes of the equation of an axis (N/m), beside forces: with its mass (kg) and
    /// damping coefficient (kg/s).
    #[inline]
    pub fn inertia(&self, h: f64, mass: f64, damping: f64) -> f64 {
        let per_displacement = self.of_displacement / (h * h);
        ((1.0 - self.alpha_m) * mass + (1.0 - self.alpha_f) * damping * h * self.after) * per_displacement
    }

    /// Inertia and damping of an axis (N), of velocities and accelerations before and after.
    #[inline]
    pub fn inertial_force(&self, mass: f64, damping: f64, velocities: [f64; 2], accelerations: [f64; 2]) -> f64 {
        let between = |[before, after]: [f64; 2], alpha: f64| (1.0 - alpha) * after + alpha * before;
        mass * between(accelerations, self.alpha_m) + damping * between(velocities, self.alpha_f)
    }

    /// The share of the tangent stiffness in the operator of a Newton iteration.
    pub fn stiffness(&self) -> f64 {
        1.0 - self.alpha_f
    }

    /// The order of the error of a motion in h.
    pub fn order(&self) -> i32 {
        if self.needs_acceleration() { 2 } else { 1 }
    }

    /// What a step of h is off by (m), to the first term that it leaves out, of accelerations before and after. Of
    /// first order w − u(t + h) = ½ h² a⁺. Of second order the accelerations are those of t + (α_m − α_f) h, so that
    /// h² [(½ − β) a + β a⁺] is off by (β − ⅙ + ½ (α_m − α_f)) h² (a⁺ − a); with α_m = α_f as Zienkiewicz & Xie (1991)
    /// have it.
    pub fn local_error(&self, h: f64, [before, after]: [f64; 2]) -> f64 {
        if self.order() == 1 {
            return 0.5 * h * h * after;
        }
        let beta = 1.0 / self.of_displacement;
        (beta - 1.0 / 6.0 + 0.5 * (self.alpha_m - self.alpha_f)) * h * h * (after - before)
    }

    /// Whether accelerations are carried on.
    pub fn needs_acceleration(&self) -> bool {
        self.of_acceleration != 0.0 || self.alpha_m != 0.0 || self.before != 0.0
    }
}

#[cfg(test)]
mod tests;
