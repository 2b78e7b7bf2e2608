//! One contact: its forces, from the steps of its nodes.

use crate::contact::parts::Parts;
use glam::{DVec3, DVec4};

/// A point and what it faces.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// Its nodes.
    pub parts: Parts,
    /// The unit normal, from the face to the point.
    pub normal: DVec3,
    /// The gap (m) before the step, where it is negative no more than may be pushed out in a step.
    pub gap: f64,
    /// The point's step against the face (m): as it would be, and after [`ContactSet::solve`] as it will be where the
    /// contact presses.
    pub step: DVec3,
    /// The largest tangential part of a normal force.
    pub friction: f64,
    /// How far the point has slipped elastically along the face (m).
    pub slip: DVec3,
    /// The normal force on the point (N).
    pub pressing: f64,
    /// The tangential force on it (N).
    pub rubbing: DVec3,
    /// How far it slides in the step (m), found where it presses.
    pub slid: f64,
    /// Whether friction does not hold it.
    pub slides: bool,
    /// Whether a spring presses: by the gap alone, whatever the step that is predicted.
    pub springs: bool,
    /// The stiffness of the spring that it has been so far (N/m), which it exceeds no more; `None` where nobody asks.
    pub stiffness: Option<f64>,
    /// How far it is let out in this step at least (m), whatever spring it has been.
    pub lets_out: f64,
    /// What a force of the other wall of a corner leaves of how far it yields alone: less than 1 where that pushes
    /// back.
    pub beside: f64,
    /// What whoever made it knows of it: the number of the point, whether that meets a face, and not an edge another,
    /// and how far it was outside (m).
    pub point: u32,
    pub of_point: bool,
    pub outside: f64,
    /// How far it yields to a force (m/N), with the shares of its nodes.
    pub(super) yields: f64,
    /// The same along the surface, and not less.
    pub(super) yields_along: f64,
    /// How far it would yield were there no other contact (m/N).
    yields_alone: f64,
}

impl Contact {
    /// Of nodes, along a normal with a gap (m), with the step that is predicted (m), a coefficient of friction and the
    /// slip (m) so far.
    pub fn new(parts: Parts, (normal, gap, step): (DVec3, f64, DVec3), (friction, slip): (f64, DVec3)) -> Self {
        Self {
            parts,
            normal,
            gap,
            step,
            friction,
            slip,
            pressing: 0.0,
            rubbing: DVec3::ZERO,
            slid: 0.0,
            // what nothing holds
            slides: true,
            springs: false,
            stiffness: None,
            lets_out: 0.0,
            beside: 1.0,
            point: 0,
            of_point: false,
            outside: gap,
            yields: 0.0,
            yields_along: 0.0,
            yields_alone: 0.0,
        }
    }

    /// The force on the point (N).
    #[inline(always)]
    pub fn force(&self) -> DVec3 {
        self.normal * self.pressing + self.rubbing
    }

    /// The part of a vector along the surface.
    #[inline(always)]
    pub fn along(&self, vector: DVec3) -> DVec3 {
        vector - self.normal * vector.dot(self.normal)
    }

    /// Finds the normal force of the step that was predicted, with the shares of nodes; gives it as a vector (N).
    #[inline(always)]
    pub(super) fn begin(&mut self, shares: &[f64], responses: &[DVec4]) -> DVec3 {
        self.find_yields(shares, responses);
        self.limit();
        self.press(self.step)
    }

    /// Lets a point that is inside come out no harder than the spring would that the contact has been so far. Of the
    /// nodes' masses it has a larger share where other contacts have let go, and would give back more than it took.
    #[inline(always)]
    fn limit(&mut self) {
        let (Some(stiffness), true) = (self.stiffness, self.gap < 0.0 && !self.springs) else { return };
        let step = self.normal.dot(self.step);
        let force = stiffness * (-self.gap - step) / (1.0 + stiffness * self.beside * self.yields_alone);
        // of no number that is nothing
        let out = (self.yields * force + step).max(self.lets_out).max(0.0);
        self.gap = self.gap.max(-out);
    }

    /// Corrects the normal force by a step of the point against the face (m), and gives by how much (N).
    #[inline(always)]
    pub(super) fn press(&mut self, step: DVec3) -> DVec3 {
        let (gap, before) = match self.springs {
            true => (self.gap, 0.0),
            false => (self.gap + self.normal.dot(step), self.pressing),
        };
        let pressing = if self.yields > 0.0 { (before - gap / self.yields).max(0.0) } else { 0.0 };
        let change = self.normal * (pressing - self.pressing);
        self.pressing = pressing;
        change
    }

    /// Corrects the tangential force, and gives by how much (N).
    #[inline(always)]
    pub(super) fn rub(&mut self, steps: &[DVec4]) -> DVec3 {
        let presses = self.pressing > 0.0 || self.rubbing != DVec3::ZERO;
        if self.friction <= 0.0 || self.yields_along <= 0.0 || !presses {
            return DVec3::ZERO;
        }
        let slip = self.along(self.slip + self.parts.step(steps));
        let wanted = self.along(self.rubbing) - slip / self.yields_along;
        let (bound, size) = (self.friction * self.pressing, wanted.length());
        self.slides = size > bound;
        let rubbing = if self.slides { wanted * (bound / size) } else { wanted };
        let change = rubbing - self.rubbing;
        self.rubbing = rubbing;
        change
    }

    /// Notes where the point goes and how far it has slipped elastically, now that forces are known.
    #[inline(always)]
    pub(super) fn note(&mut self, steps: &[DVec4]) {
        if self.pressing <= 0.0 {
            self.slip = DVec3::ZERO;
            return;
        }
        self.step = self.parts.step(steps);
        self.slid = if self.slides { self.along(self.step).length() } else { 0.0 };
        if self.friction <= 0.0 {
            self.slip = DVec3::ZERO;
            return;
        }
        let slip = self.along(self.slip + self.step);
        let (bound, size) = (self.friction * self.pressing * self.yields_along, slip.length());
        self.slip = if size > bound { slip * (bound / size) } else { slip };
    }

    /// Finds how far it yields to forces, from the shares of nodes.
    #[inline(always)]
    pub(super) fn find_yields(&mut self, shares: &[f64], responses: &[DVec4]) {
        let (mut along_normal, mut largest, mut alone) = (0.0, 0.0, 0.0);
        let ((nodes, weights), normal) = (self.parts.slices(), self.normal.extend(0.0));
        for (&node, weight) in nodes.iter().zip(weights) {
            let (share, response) = (weight.abs() * shares[node as usize], responses[node as usize]);
            let along = normal.dot(response * normal);
            along_normal += share * along;
            alone += weight * weight * along;
            largest += share * response.max_element();
        }
        (self.yields, self.yields_along, self.yields_alone) = (along_normal, largest, alone);
    }
}
