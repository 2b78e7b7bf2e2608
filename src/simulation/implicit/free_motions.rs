//! Rigid motions of pieces of bodies that no constraint holds.

mod unresisted;

pub(super) use unresisted::Unresisted;

use super::axes::Axes;
use super::preconditioner::pieces;
use crate::components::*;
use crate::math::digits_beside;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::fmt;

/// A pivot below this share of the largest is rounding.
const DEPENDENT: f64 = 1e-9;

/// u = t + w × (x − middle) of the nodes of a piece.
#[derive(Clone, Debug)]
pub(super) struct FreeMotion {
    body: String,
    /// Whether something may touch the body, and whether it is glued or tied: no constraint, but it may hold it.
    pub may_touch: bool,
    pub is_tied: bool,
    /// How many pieces the body has.
    pieces: usize,
    /// Nodes among those of all bodies, and where they are from the middle (m).
    nodes: Vec<(usize, DVec3)>,
    middle: DVec3,
    translation: DVec3,
    /// rad/m.
    rotation: DVec3,
}

/// Of all pieces of all bodies, at the present displacements.
pub(super) fn free_motions(world: &World, axes: &Axes, free: &[bool]) -> Vec<FreeMotion> {
    let mut motions = Vec::new();
    for (body, range) in axes.each() {
        let (Some(rest), Some(u)) = (world.get::<RestPosition>(body), world.get::<Displacement>(body)) else {
            continue;
        };
        let (pieces, [may_touch, is_tied]) = (pieces(world, body), may_hold(world, body));
        let name = world.get::<Label>(body).map(|label| label.0.clone()).unwrap_or_default();
        for piece in &pieces {
            let place = |node: usize| rest.0[node] + u.vector(node);
            let middle = piece.iter().map(|&node| place(node)).sum::<DVec3>() / piece.len() as f64;
            let first = range.start / 3;
            let nodes: Vec<(usize, DVec3)> = piece.iter().map(|&node| (first + node, place(node) - middle)).collect();
            for [rotation, translation] in without_constraint(&nodes, reach(&nodes), free) {
                let (body, nodes) = (name.clone(), nodes.clone());
                motions.push(FreeMotion {
                    body,
                    may_touch,
                    is_tied,
                    pieces: pieces.len(),
                    nodes,
                    middle,
                    translation,
                    rotation,
                });
            }
        }
    }
    motions
}

/// How far nodes are from the middle (m) at most; more than nothing.
fn reach(nodes: &[(usize, DVec3)]) -> f64 {
    nodes.iter().map(|(_, arm)| arm.length()).fold(f64::MIN_POSITIVE, f64::max)
}

/// Whether springs of contact or threads may hold a body, and whether glue may.
fn may_hold(world: &World, body: Entity) -> [bool; 2] {
    let of = world.entity(body);
    let meets = of.contains::<ToolTouch>() || of.contains::<SurfaceTouch>() || of.contains::<Sutured>();
    [meets, world.get_resource::<Glue>().is_some_and(|glue| glue.bodies.contains(&body))]
}

/// Rotations (rad/m) and translations that move no held axis: the null space of Σ c cᵀ over these, c what each of six
/// motions moves such an axis by. Where it can be, they are translations.
fn without_constraint(nodes: &[(usize, DVec3)], size: f64, free: &[bool]) -> Vec<[DVec3; 2]> {
    let mut gram = [[0.0; 6]; 6];
    for (node, arm) in nodes {
        for axis in (0..3).filter(|axis| !free[3 * node + axis]) {
            let unit = DVec3::AXES[axis];
            // (w × arm)·e = (arm × e)·w
            let (turn, along) = ((*arm / size).cross(unit).to_array(), unit.to_array());
            let moved: [f64; 6] = std::array::from_fn(|i| if i < 3 { turn[i] } else { along[i - 3] });
            (0..6).for_each(|i| (0..6).for_each(|j| gram[i][j] += moved[i] * moved[j]));
        }
    }
    let vector = |numbers: &[f64]| DVec3::from_slice(numbers);
    null_space(gram).iter().map(|motion| [vector(&motion[..3]) / size, vector(&motion[3..])]).collect()
}

/// By Gauss-Jordan elimination of a positive semi-definite matrix; what is left over are the last unknowns.
fn null_space(mut a: [[f64; 6]; 6]) -> Vec<[f64; 6]> {
    let largest = (0..6).map(|i| a[i][i]).fold(0.0, f64::max);
    let (mut pivots, mut row) = ([None; 6], 0);
    for column in 0..6 {
        let Some(best) = (row..6).max_by(|&i, &j| a[i][column].abs().total_cmp(&a[j][column].abs())) else { break };
        if a[best][column].abs() <= DEPENDENT * largest {
            continue;
        }
        a.swap(row, best);
        let pivot = a[row];
        a[row] = pivot.map(|entry| entry / pivot[column]);
        for other in (0..6).filter(|&other| other != row) {
            let (factor, whole) = (a[other][column], a[row]);
            (0..6).for_each(|j| a[other][j] -= factor * whole[j]);
        }
        pivots[column] = Some(row);
        row += 1;
    }
    let of_free = |free: usize| {
        std::array::from_fn(|column| match pivots[column] {
            Some(row) => -a[row][free],
            None => f64::from(u8::from(column == free)),
        })
    };
    (0..6).filter(|&column| pivots[column].is_none()).map(of_free).collect()
}

impl FreeMotion {
    /// How it moves a node that is so far from the middle (m).
    fn along(&self, arm: DVec3) -> DVec3 {
        self.translation + self.rotation.cross(arm)
    }

    /// How it moves all axes.
    pub fn axes(&self, count: usize) -> Reals {
        let mut axes = Reals::zeros(Precision::F64, count);
        for (node, arm) in &self.nodes {
            axes.set_vector(*node, self.along(*arm));
        }
        axes
    }

    /// The work of forces (N) on all axes along it, and the sum of its parts' sizes.
    pub fn work(&self, forces: &Reals) -> (f64, f64) {
        let of_node = |(node, arm): &(usize, DVec3)| {
            let along = self.along(*arm);
            (0..3).map(|i| along[i] * forces.get(3 * node + i)).collect::<Vec<f64>>()
        };
        let parts: Vec<f64> = self.nodes.iter().flat_map(of_node).collect();
        (parts.iter().sum(), parts.iter().map(|part| part.abs()).sum())
    }
}

impl fmt::Display for FreeMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let in_words = |v: DVec3, digits| {
            let [x, y, z] = v.to_array().map(|x| rounded(x, digits));
            format!("({x}, {y}, {z})")
        };
        let (of_places, of_directions) = (digits_beside(reach(&self.nodes)), digits_beside(1.0));
        let what = match self.pieces {
            1 => format!("body {}", self.body),
            _ => format!("a piece of body {} about {}", self.body, in_words(self.middle, of_places)),
        };
        let square = self.rotation.length_squared();
        if square > 0.0 {
            let through = self.middle + self.rotation.cross(self.translation) / square;
            let axis = self.rotation / square.sqrt();
            let (axis, through) = (in_words(axis, of_directions), in_words(through, of_places));
            return write!(f, "{what} turns about {axis} through {through}");
        }
        write!(f, "{what} moves along {}", in_words(self.translation.normalize_or_zero(), of_directions))
    }
}

/// To so many digits after the point, without those of rounding.
fn rounded(x: f64, digits: usize) -> f64 {
    let parts = 10_f64.powi(digits as i32);
    (x * parts).round() / parts + 0.0
}

#[cfg(test)]
mod tests;
