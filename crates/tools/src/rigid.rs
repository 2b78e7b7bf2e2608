//! Rigid bodies that move freely: where they are, how they move, and a step of their motion.

use glam::{DMat3, DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// What resists the motion of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// Mass (kg).
    pub mass: f64,
    /// The centre of mass (m), in the body's own frame.
    pub center: DVec3,
    /// Moments of inertia about it (kg m²), along the body's own axes.
    pub moments: DMat3,
    /// Their inverse.
    inverse: DMat3,
}

impl Inertia {
    /// From a mass (kg), its centre (m) and moments about that (kg m²), in the body's own frame.
    pub fn new(mass: f64, center: DVec3, moments: DMat3) -> Self {
        Self { mass, center, moments, inverse: moments.inverse() }
    }

    /// Whether it can be moved: what is finite, and has an inverse.
    pub fn is_sound(&self) -> bool {
        self.mass > 0.0 && self.mass.is_finite() && self.moments.is_finite() && self.inverse.is_finite()
    }

    /// The inverse of the moments (1/(kg m²)) along the scene's axes, of a body that is turned so.
    pub fn inverse_in(&self, turn: DQuat) -> DMat3 {
        let turn = DMat3::from_quat(turn);
        turn * self.inverse * turn.transpose()
    }
}

/// Where a rigid body is, and how it moves. As of nodes, velocities are those of the middle of the last step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigidMotion {
    /// Where its centre of mass is (m).
    pub place: DVec3,
    /// From its own axes to the scene's.
    pub turn: DQuat,
    /// Velocity of its centre of mass (m/s).
    pub velocity: DVec3,
    /// Angular momentum about its centre of mass (kg m²/s), along the scene's axes.
    pub momentum: DVec3,
}

/// How often the spin of a step is found anew.
const ROUNDS: usize = 60;

impl RigidMotion {
    /// Whether all of it is finite, and it is turned somehow.
    pub fn is_sound(&self) -> bool {
        let finite = self.place.is_finite() && self.velocity.is_finite() && self.momentum.is_finite();
        finite && self.turn.is_finite() && (self.turn.length() - 1.0).abs() < 1e-6
    }

    /// Angular velocity (rad/s), along the scene's axes.
    pub fn spin(&self, inertia: &Inertia) -> DVec3 {
        inertia.inverse_in(self.turn) * self.momentum
    }

    /// Kinetic energy (J).
    pub fn kinetic(&self, inertia: &Inertia) -> f64 {
        0.5 * inertia.mass * self.velocity.length_squared() + 0.5 * self.momentum.dot(self.spin(inertia))
    }

    /// Where it is after a time (s) in which nothing pushes it.
    ///
    /// The turn is that of the implicit midpoint rule for Euler's equations, Π' = Π × J⁻¹ Π with the angular momentum Π
    /// in the body's axes: (I + [v]) Π̄ = Π, v = ½ Δt J⁻¹ Π̄, Π̄ of the middle, and the unit quaternion (1, v)/√(1 +
    /// v²). Of second order and the same backwards; angular momentum and energy, which are quadratic, are kept to
    /// rounding whatever Δt is (Simo & Wong 1991; Lewis & Simo 1994).
    pub fn after(&self, time: f64, inertia: &Inertia) -> Self {
        let begin = self.turn.conjugate() * self.momentum;
        let half = |middle: DVec3| inertia.inverse * middle * (0.5 * time);
        let mut v = half(begin);
        for _ in 0..ROUNDS {
            let middle = (begin - v.cross(begin) + v * v.dot(begin)) / (1.0 + v.length_squared());
            let next = half(middle);
            let change = next.distance_squared(v);
            v = next;
            if change <= 1e-32 * v.length_squared() {
                break;
            }
        }
        let turn = (self.turn * DQuat::from_xyzw(v.x, v.y, v.z, 1.0)).normalize();
        Self { place: self.place + self.velocity * time, turn, ..*self }
    }
}

#[cfg(test)]
mod tests;
