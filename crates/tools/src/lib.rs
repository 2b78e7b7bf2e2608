//! Rigid tools: shapes that touch bodies, known by the signed distance to their surface in a frame of their own.

mod closed;
mod disc;
mod form;
mod grid;
mod lost;
mod mass;
mod pivot;
mod rigid;
mod shape;
mod solid;
mod surface;
#[cfg(test)]
mod tests;
// what carries skins finds where they are by it
#[doc(hidden)]
pub mod tree;

pub use disc::share_in_disc;
pub use form::Form;
pub use grid::DistanceGrid;
pub use pivot::closest_approach;
pub use rigid::{Inertia, RigidMotion};
pub use shape::Shape;
pub use solid::{Problem, Solid};

use glam::DVec3;
use std::sync::Arc;

/// What says the words of scenes here: messages quote it.
pub const TEXTS: &[&str] = &[include_str!("shape.rs")];

/// What a tool is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// A shape in closed form.
    Analytic(Solid),
    /// A closed surface of triangles.
    Grid(Arc<DistanceGrid>),
}

impl Geometry {
    /// φ, the signed distance (m) from a place in the tool's frame to the surface, negative inside, and the direction
    /// of its gradient, a unit vector: see [`Solid::distance`] and [`DistanceGrid::distance`].
    #[inline]
    pub fn distance(&self, y: DVec3) -> (f64, DVec3) {
        match self {
            Self::Analytic(solid) => solid.distance(y),
            Self::Grid(grid) => grid.distance(y),
        }
    }

    /// Centre and radius (m) of a ball around it; none of a plane.
    pub fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        match self {
            Self::Analytic(solid) => solid.bounding_sphere(),
            Self::Grid(grid) => Some(grid.bounding_sphere()),
        }
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Analytic(_) => size_of::<Self>(),
            Self::Grid(grid) => size_of_val(grid.values()),
        }
    }

    /// Half of what it measures across where it is thinnest (m), of a grid to about a spacing and half of one at least;
    /// none of a plane.
    pub fn smallest_radius(&self) -> Option<f64> {
        match self {
            Self::Analytic(solid) => solid.smallest_radius(),
            Self::Grid(grid) => Some(grid.thinnest()),
        }
    }

    /// How far it may go wrong (m) to take it for as thick as [`Self::smallest_radius`] says: half of a grid's spacing,
    /// as edges and what tapers may be thinner than one; else infinitely far.
    pub fn blur(&self) -> f64 {
        match self {
            Self::Analytic(_) => f64::INFINITY,
            Self::Grid(grid) => 0.5 * grid.spacing(),
        }
    }
}
