//! What is the same for all nodes in a step.

use crate::components::Clock;
use crate::math::Scalar;
use glam::DVec3;

/// What a step multiplies forces and damping with.
#[derive(Clone, Copy)]
pub struct IntegrationCoefficients<T> {
    /// Δt times the time between the middles of the last and of this step (see [`Clock::half_step_interval`]), times
    /// the force scale of a static analysis (s²).
    pub force: T,
    /// Half the time between the middles, in the first step Δt/2 (s).
    pub half_step: T,
    /// 1, in the first step 0.
    pub after_first: T,
    /// 1/Δt (1/s).
    pub rate: T,
    /// Share of a step's work that is counted, the time between the middles over Δt: 1, in the first step ½.
    pub work_factor: T,
    /// a of a static analysis, else 0.
    pub relaxation: T,
}

impl<T: Scalar> IntegrationCoefficients<T> {
    /// In the step that begins at the clock's time.
    pub fn of(clock: &Clock) -> Self {
        let (dt, between, first) = (clock.time_step, clock.half_step_interval(), clock.step == 0);
        let (force_scale, damping) =
            clock.relaxation.map_or((1.0, 0.0), |relaxation| (relaxation.force_scale, relaxation.damping));
        Self {
            force: T::from_f64(force_scale * dt * between),
            half_step: T::from_f64(0.5 * if first { dt } else { between }),
            after_first: T::from_f64(if first { 0.0 } else { 1.0 }),
            rate: T::from_f64(1.0 / dt),
            work_factor: T::from_f64(between / dt),
            relaxation: T::from_f64(damping),
        }
    }
}

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
