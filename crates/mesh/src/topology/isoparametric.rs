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
        let outer = |(p, n): (&DVec3, &DVec3)| DMat3::from_cols(*p * n.x, *p * n.y, *p * n.z);
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

/// Locates a point by Newton's method; the map is linear on a parallelepiped and nearly so elsewhere.
pub(super) fn newton(p: &[DVec3], x: DVec3, shape: fn([f64; 3]) -> Shape, clip: fn(DVec3) -> Inside) -> Located {
    let mut weights = [0.0; MOST_NODES];
    weights[..p.len()].fill(1.0 / p.len() as f64);
    let nowhere = Located { weights, outside: f64::INFINITY };
    let (mut r, mut reached) = (DVec3::ZERO, false);
    for _ in 0..20 {
        let n = shape(r.to_array());
        let (mut here, mut slope) = (DVec3::ZERO, DMat3::ZERO);
        for (node, &place) in p.iter().enumerate() {
            here += n.values[node] * place;
            let gradient = n.gradients[node];
            slope += DMat3::from_cols(place * gradient.x, place * gradient.y, place * gradient.z);
        }
        let step = slope.inverse() * (x - here);
        // far outside the map folds over; what is there is no good place anyway
        r = (r + step).clamp(DVec3::splat(-5.0), DVec3::splat(5.0));
        if !r.is_finite() {
            return nowhere;
        }
        if step.length() < 1e-10 {
            // the step that has just been taken was the last that matters: the next would be its square
            reached = true;
            break;
        }
    }
    if !reached {
        return nowhere;
    }
    let inside = clip(r);
    Located { weights: shape(inside.at.to_array()).values, outside: inside.outside }
}
