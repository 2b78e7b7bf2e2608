//! Springs of contact in implicit steps: their law, and what a Newton iteration needs of those that touch.

use super::{ContactSpring, Reals};
use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

/// Springs of contact whose forces are those at the end of the step that is solved for, or at rest.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
pub struct SolvedSprings {
    /// The step (s) over the square of which a share of the mass is a stiffness: the stable one of the stiffest
    /// element, at the start; before a motion by explicit steps their own.
    pub step: f64,
    /// Whether a spring between surfaces acts on what it does in explicit steps, the masses of the nodes on both sides,
    /// split among all that touches there; else on that of the point.
    #[serde(skip)]
    pub shared: bool,
    /// What becomes of their forces.
    #[serde(skip)]
    pub forces: SpringForces,
}

/// What becomes of the forces of contact where systems find forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SpringForces {
    /// None are found, but which points of surfaces may touch what in the step that begins.
    Sought,
    /// They are found for the solver, which adds them up itself, and nothing is noted.
    #[default]
    Tried,
    /// They are left out: of a product the solver knows their part.
    Omitted,
    /// They are loads, and what touches carries on to the next step is noted.
    Noted,
    /// All of that in a pseudo-step to rest: who may touch what is sought, and their forces are loads and noted.
    Stepped,
}

impl SpringForces {
    /// Whether they are loads, and what touches is noted.
    pub fn are_noted(self) -> bool {
        matches!(self, SpringForces::Noted | SpringForces::Stepped)
    }
}

/// How a spring presses on a mass, in place of [`ContactSpring::gap`].
#[derive(Clone, Copy, Debug)]
pub struct SolvedPress {
    /// N/m, along the surface as well.
    pub stiffness: f64,
    /// The normal force (N).
    pub pressing: f64,
    /// What that grows by (N/m) as the point goes inwards: by where it is, and by how far it has come in the step.
    slopes: [f64; 2],
}

/// A tangential force and its slope.
#[derive(Clone, Copy, Debug)]
pub struct Rubbing {
    /// N.
    pub force: DVec3,
    /// Whether friction does not hold the point.
    pub slides: bool,
    /// What the force falls by as the point goes along (N/m), 3 × 3, symmetric: that of sliding without what a change
    /// of the normal force does to it, which is not.
    slope: DMat3,
}

/// A spring that touches, as it is where it was tried.
#[derive(Clone, Debug)]
pub struct TouchingSpring {
    /// First axes of its nodes, with signed weights: positive of the point's, negative of what it touches.
    pub parts: SmallVec<[(usize, f64); 8]>,
    /// The force on the point (N).
    pub force: DVec3,
    /// What it falls by (N/m), 3 × 3: as the point moves against what it touches, and as their step does.
    pub slopes: [DMat3; 2],
}

impl ContactSpring {
    /// On a mass (kg) that is so far outside (m; 0 touches) and has come outwards by so much in the implicit step (m),
    /// which takes a time (s): k δ − 2 ζ √(k m) v with k = share · m/Δt², Δt that of [`SolvedSprings`], and nothing
    /// where that pulls. v is how fast the depth δ changes: the way up to the surface does not count, or a force would
    /// be there all at once where it touches, and of some steps there were no end.
    pub fn press(&self, springs: &SolvedSprings, mass: f64, outside: f64, [outwards, time]: [f64; 2]) -> SolvedPress {
        let per_share = mass / (springs.step * springs.step);
        let stiffness = self.share * per_share;
        let damping = 2.0 * self.damping * self.share.sqrt() * per_share * springs.step / time;
        let from_outside = outwards < outside;
        let pressing = -stiffness * outside - damping * if from_outside { outside } else { outwards };
        // what is no number is told by guards, not lost
        match pressing < 0.0 {
            true => SolvedPress { stiffness, pressing: 0.0, slopes: [0.0; 2] },
            false if from_outside => SolvedPress { stiffness, pressing, slopes: [stiffness + damping, 0.0] },
            false => SolvedPress { stiffness, pressing, slopes: [stiffness, damping] },
        }
    }
}

impl SolvedPress {
    /// The tangential force of an elastic slip along the surface (m): the return mapping of a force that is at most so
    /// large a part of the normal one.
    pub fn rub(&self, normal: DVec3, slip: DVec3, friction: f64) -> Rubbing {
        if friction == 0.0 {
            return Rubbing { force: DVec3::ZERO, slides: true, slope: DMat3::ZERO };
        }
        let (wanted, bound) = (-self.stiffness * slip, friction * self.pressing);
        let size = wanted.length();
        let surface = DMat3::IDENTITY - outer(normal);
        // what is no number is told by guards, not lost
        if size <= bound {
            return Rubbing { force: wanted, slides: false, slope: surface * self.stiffness };
        }
        let across = surface - outer(wanted / size);
        Rubbing { force: wanted * (bound / size), slides: true, slope: across * (self.stiffness * bound / size) }
    }

    /// The force on the point (N) and its slopes ([`TouchingSpring::slopes`]), with friction.
    pub fn with(&self, normal: DVec3, rubbing: &Rubbing) -> (DVec3, [DMat3; 2]) {
        let [of_place, of_step] = self.slopes.map(|slope| outer(normal) * slope);
        (normal * self.pressing + rubbing.force, [of_place, of_step + rubbing.slope])
    }
}

impl TouchingSpring {
    /// How the point moves against what it touches where axes move so far (m).
    pub fn relative(&self, axes: &Reals) -> DVec3 {
        self.parts.iter().map(|&(first, weight)| axes.vector_at(first) * weight).sum()
    }

    /// Adds a force on the point, and against it on what it touches, to those of axes (N).
    pub fn add(&self, force: DVec3, to: &mut Reals) {
        for &(first, weight) in &self.parts {
            to.set_vector_at(first, to.vector_at(first) + weight * force);
        }
    }
}

/// a aᵀ.
fn outer(a: DVec3) -> DMat3 {
    DMat3::from_cols(a * a.x, a * a.y, a * a.z)
}

#[cfg(test)]
mod tests;
