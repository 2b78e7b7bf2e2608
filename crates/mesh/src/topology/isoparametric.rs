//! What cells share that are mapped by their shape functions.

use super::MOST_NODES;
use glam::{DMat3, DVec3};

/// Shape functions at a place of a reference cell; 0 for nodes that the cell does not have.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shape {
    /// Their values; 1 together.
    pub values: [f64; MOST_NODES],
    /// Their gradients by natural coordinates; zero together.
    pub gradients: [DVec3; MOST_NODES],
}

impl Shape {
    /// ∂X/∂ξ of a cell whose nodes are there (m); columns: natural coordinates.
    pub fn jacobian(&self, p: &[DVec3]) -> DMat3 {
        // from a node on: far from the origin places have digits that would be lost
        let origin = p.first().copied().unwrap_or_default();
        let outer = |(&p, n): (&DVec3, &DVec3)| {
            let way = p - origin;
            DMat3::from_cols(way * n.x, way * n.y, way * n.z)
        };
        p.iter().zip(&self.gradients).map(outer).fold(DMat3::ZERO, |sum, more| sum + more)
    }
}

/// Where in a cell a point lies.
#[derive(Clone, Copy, Debug)]
pub struct Located {
    /// Values of the nodes' shape functions there, or at the nearest place inside; 1 together.
    pub weights: [f64; MOST_NODES],
    /// How far outside the point lies, in cell sizes; 0 inside.
    pub outside: f64,
}

/// The place of a reference cell that is nearest to another.
pub(super) struct Inside {
    /// That place.
    pub at: DVec3,
    /// How far it is from the other, in cell sizes.
    pub outside: f64,
}

/// The first `N` of some points.
pub(super) fn first<const N: usize>(p: &[DVec3]) -> [DVec3; N] {
    std::array::from_fn(|i| p[i])
}

/// A step of Newton's iterations (cell sizes) after which the next changes nothing: it would be its square.
const LAST: f64 = 1e-10;

/// A step that is no smaller after all iterations than rounding lets it be, in a cell that is nearly flat.
const ROUNDED: f64 = 1e-6;

/// Locates a point by Newton's method; the map is linear on a parallelepiped and nearly so elsewhere. Places count from
/// the first node, so that it does not matter how far from the origin the cell is.
pub(super) fn newton(p: &[DVec3], x: DVec3, shape: fn([f64; 3]) -> Shape, clip: fn(DVec3) -> Inside) -> Located {
    let mut weights = [0.0; MOST_NODES];
    weights[..p.len()].fill(1.0 / p.len() as f64);
    let nowhere = Located { weights, outside: f64::INFINITY };
    let origin = p.first().copied().unwrap_or_default();
    let x = x - origin;
    let (mut r, mut reached) = (DVec3::ZERO, false);
    for _ in 0..20 {
        let n = shape(r.to_array());
        let here: DVec3 = p.iter().zip(&n.values).map(|(&place, &value)| value * (place - origin)).sum();
        let step = n.jacobian(p).inverse() * (x - here);
        // far outside the map folds over; what is there is no good place anyway
        r = (r + step).clamp(DVec3::splat(-5.0), DVec3::splat(5.0));
        if !r.is_finite() {
            return nowhere;
        }
        reached = step.length() < ROUNDED;
        if step.length() < LAST {
            break;
        }
    }
    if !reached {
        return nowhere;
    }
    let inside = clip(r);
    Located { weights: shape(inside.at.to_array()).values, outside: inside.outside }
}
