//! The equation of each axis in a step: its inertia, its damping, and what it is at a place.

use super::axes::Motion;
use super::formula::Formula;

impl Motion {
    /// Bytes of all vectors.
    pub fn bytes(&self) -> usize {
        let Self { u, v, a, mass, damping, free, held } = self;
        let numbers: usize = [u, v, a, mass, damping].into_iter().map(|vector| size_of_val(&vector[..])).sum();
        numbers + size_of_val(&free[..]) + size_of_val(&held[..])
    }

    /// The acceleration before (m/s²), 0 where none is carried on.
    pub fn acceleration(&self, axis: usize) -> f64 {
        self.a.get(axis).copied().unwrap_or(0.0)
    }

    /// The damping coefficient of an axis (kg/s).
    pub fn damping(&self, axis: usize) -> f64 {
        self.damping.get(axis / 3).copied().unwrap_or(0.0)
    }

    /// y = u + h v (m).
    pub fn predicted(&self, axis: usize, h: f64) -> f64 {
        if self.free[axis] { self.u[axis] + h * self.v[axis] } else { self.u[axis] }
    }

    /// The velocity (m/s) and acceleration (m/s²) at the end of a step of h, of an axis that is at w then.
    pub fn arrival(&self, formula: &Formula, axis: usize, h: f64, w: f64) -> (f64, f64) {
        if !self.free[axis] {
            let velocity = if self.held[axis] { (w - self.u[axis]) / h } else { 0.0 };
            return (velocity, 0.0);
        }
        let before = self.acceleration(axis);
        let acceleration = formula.acceleration(h, w - self.predicted(axis, h), before);
        (formula.velocity(h, self.v[axis], [before, acceleration]), acceleration)
    }

    /// D of a node (N/m).
    pub fn inertia(&self, formula: &Formula, h: f64, node: usize) -> f64 {
        formula.inertia(h, self.mass[node], self.damping(3 * node))
    }

    /// What is constant of the equation of an axis (N) beside D (w − y) and the forces at the end; `net` is F − R
    /// before.
    pub fn constant(&self, formula: &Formula, h: f64, axis: usize, net: f64) -> f64 {
        if !self.free[axis] {
            return 0.0;
        }
        let (mass, damping) = (self.mass[axis / 3], self.damping(axis));
        let (velocity, acceleration) = self.arrival(formula, axis, h, self.predicted(axis, h));
        let accelerations = [self.acceleration(axis), acceleration];
        let inertial = formula.inertial_force(mass, damping, [self.v[axis], velocity], accelerations);
        inertial + formula.alpha_f * net
    }

    /// The residual of all free axes at w (N), from the forces there.
    pub fn fill_residual(
        &self,
        (stiffness, h): (f64, f64),
        (w, net): (&[f64], &[f64]),
        (constant, inertia): (&[f64], &[f64]),
        g: &mut [f64],
    ) {
        for axis in 0..w.len() {
            g[axis] = match self.free[axis] {
                true => {
                    constant[axis] + inertia[axis / 3] * (w[axis] - self.predicted(axis, h)) + stiffness * net[axis]
                }
                false => 0.0,
            };
        }
    }
}
