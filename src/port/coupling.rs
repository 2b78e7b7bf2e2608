//! The virtual coupling: a spring and a damper between the hand's device and the tool's proxy.

use super::Touch;
use glam::DVec3;

/// Makes the force for the hand of the last [`Touch`], in the device's own thread at its own rate:
///
/// F = K (x_p − x_d) − B v_d + s F_t
///
/// x_p is where the tool was last, carried on by its velocity for [`batch`](Self::batch) at most, x_d and v_d are the
/// device's, F_t what the tool felt. The force is at most [`most_force`](Self::most_force), changes in a second by K ·
/// [`fastest`](Self::fastest) at most, or by as much as it takes to lose the largest force over [`decay`](Self::decay)
/// where that is more, and is 0 after that time when no touch comes any more: whatever the engine does, the hand is not
/// pulled. Tissue of stiffness k is felt as K k/(K + k). Colgate et al. 1995 for the coupling; the bound of K is
/// [`largest_stiffness`](Self::largest_stiffness).
#[derive(Clone, Debug, PartialEq)]
pub struct VirtualCoupling {
    /// K (N/m).
    pub stiffness: f64,
    /// B (N s/m).
    pub damping: f64,
    /// s: what share of the force on the tool is passed on at once. 0 for a proxy, which the coupling pulls; 1 for a
    /// tool that goes where the device is, whose spring has nothing to tell. That is late by the age of the touch, and
    /// gives energy: tissue of stiffness k is held by no hand with less damping than k (T/2 + τ).
    pub feed_forward: f64,
    /// The largest force of the device (N).
    pub most_force: f64,
    /// The speed (m/s) with which a hand may load the spring: the force changes by no more than K times it a second, or
    /// by the largest force over [`decay`](Self::decay) where that is more, as with no spring at all.
    pub fastest: f64,
    /// Time between two touches (s), `every` of the port in the scene: for so long the proxy goes on as it went, and
    /// for twice as long nothing decays.
    pub batch: f64,
    /// Time (s) over which the force goes to 0 after that.
    pub decay: f64,
    force: DVec3,
    /// Number and time of arrival of the last touch, and when the force was asked for last (s); none before the first.
    heard: Option<(u64, f64, f64)>,
}

impl VirtualCoupling {
    /// With a stiffness (N/m), a damping (N s/m) and the device's largest force (N); for touches each millisecond,
    /// hands up to 1 m/s, and a decay over 50 ms.
    pub fn new(stiffness: f64, damping: f64, most_force: f64) -> Self {
        Self {
            stiffness,
            damping,
            feed_forward: 0.0,
            most_force,
            fastest: 1.0,
            batch: 1e-3,
            decay: 0.05,
            force: DVec3::ZERO,
            heard: None,
        }
    }

    /// The largest stiffness (N/m) that a device does not oscillate with: b/(T/2 + τ), b the damping of the device and
    /// the hand (N s/m), T the tick (s), τ the age of what goes through the proxy (s). The limit
    /// found by bisection is at most 1 % larger for devices of 100 g and more, 5 % for 20 g, with τ from 0 to 5 ticks
    /// (`the_largest_stiffness_is_that_of_the_sampled_device`). Of a proxy that stays, as against a wall, τ is 0.
    pub fn largest_stiffness(damping: f64, tick: f64, age: f64) -> f64 {
        damping / (0.5 * tick + age)
    }

    /// The force for the hand (N) at a place (m) and velocity (m/s) of the device and at a time of its clock (s), which
    /// may begin anywhere and must not go back. The first is 0.
    pub fn force(&mut self, touch: &Touch, place: DVec3, velocity: DVec3, time: f64) -> DVec3 {
        // a clock may begin anywhere
        let Some((sequence, arrived, before)) = self.heard else {
            self.heard = Some((touch.sequence, time, time));
            return self.force;
        };
        let arrived = if touch.sequence == sequence { arrived } else { time };
        let silent = time - arrived;
        let late = silent - 2.0 * self.batch;
        let left = if late > 0.0 { (1.0 - late / self.decay).max(0.0) } else { 1.0 };
        let wanted = match touch.sequence {
            0 => DVec3::ZERO,
            _ => {
                let proxy = touch.place + touch.velocity * silent.clamp(0.0, self.batch);
                let spring = self.stiffness * (proxy - place) - self.damping * velocity;
                spring + self.feed_forward * touch.force
            }
        };
        // no device gets what is no number
        let wanted = if wanted.is_finite() { left * wanted.clamp_length_max(self.most_force) } else { DVec3::ZERO };
        let release = Some(self.most_force / self.decay).filter(|release| release.is_finite()).unwrap_or(0.0);
        let change = (self.stiffness * self.fastest).max(release) * (time - before).max(0.0);
        // what is to be lost is lost first, whichever way the rest goes
        let kept = self.force.clamp_length_max(left * self.most_force);
        let rest = (change - kept.distance(self.force)).max(0.0);
        self.force = kept + (wanted - kept).clamp_length_max(rest);
        self.heard = Some((touch.sequence, arrived, time));
        self.force
    }
}

#[cfg(test)]
mod tests;
