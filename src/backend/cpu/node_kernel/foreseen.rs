//! Where nodes would go, for who acts before they do.

use super::IntegrationCoefficients;
use glam::DVec3;

/// Where a node would go.
#[derive(Clone, Copy, Debug)]
pub struct Foreseen {
    /// Its last step (m).
    pub before: DVec3,
    /// Its next step (m), as `integrate` will find it.
    pub step: DVec3,
    /// 1 along each axis that it moves freely along, else 0.
    pub free: DVec3,
    /// The force that takes it one metre farther in this step (N/m).
    pub to_force: f64,
}

impl IntegrationCoefficients<f64> {
    /// Where a node would go with a mass (kg), a damping coefficient (kg/s), constrained axes (bits), the last step (m)
    /// and a force (N); inactive nodes, without mass, stay where they are.
    #[inline(always)] // with the instructions of whoever asks
    pub fn foresee(&self, mass: f64, damping: f64, axes: u32, before: DVec3, force: DVec3) -> Foreseen {
        if mass <= 0.0 {
            return Foreseen { before: DVec3::ZERO, step: DVec3::ZERO, free: DVec3::ZERO, to_force: f64::INFINITY };
        }
        let free = DVec3::from_array([0, 1, 2].map(|i| f64::from(1 - (axes >> i & 1))));
        let a = damping * self.half_step / mass + self.relaxation;
        let damped = 1.0 + self.after_first * a;
        let step = before + free * (force * (self.force / mass) - before * ((1.0 + self.after_first) * a)) / damped;
        Foreseen { before, step, free, to_force: mass * damped / self.force }
    }
}
