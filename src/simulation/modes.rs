//! The lowest natural frequencies of all bodies as they are held, and their shapes: the lowest eigenpairs of M^(−½) K
//! M^(−½) at the present state, matrix-free, by subspace iteration with a Chebyshev filter (Zhou, Saad, Tiago &
//! Chelikowsky 2006).
//!
//! The filter is a polynomial that is at most 1 on what is not wanted, [a, b], and grows as fast as any below a. With b
//! the bound of the largest eigenvalue that the stable step is found from and a a Ritz value above those that are
//! wanted, a few filters of some hundred products each separate the lowest modes, also where several have the same
//! frequency (as bending of a square bar).

use super::Simulation;
use super::frequency::{bodies, dot, largest_eigenvalue, noise, roots_of_mass};
use super::tangent::Tangent;
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::Error;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;

/// Vectors beside those that are wanted: they bound the filter, and those nearest to it converge slowly.
const EXTRA_VECTORS: usize = 6;
/// Products of a filter, at most: more would let the quickest-growing modes swamp the others in rounding.
const DEGREE: (usize, usize) = (20, 400);
/// What a filter may make a wanted mode larger than those beside it by: then they are separated anew.
const GROWTH: f64 = 1e6;
/// Residuals ‖Ax − λx‖ are small enough at this share of the Ritz value: λ is then wrong by its square over the gap.
const TOLERANCE: f64 = 1e-5;
/// Filters after which what has been found is given out as it is.
const FILTERS: usize = 60;
/// Eigenvalues below this share of the largest one are those of a body that nothing holds: rigid motion.
const RIGID: f64 = 1e-9;

/// A natural mode.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Mode {
    /// Its frequency (Hz); 0 of rigid motion.
    pub frequency: f64,
    /// ‖(K − ω²M) φ‖ as a share, in the norm of the mass: the frequency is known to half its square over the gap to the
    /// next.
    pub residual: f64,
    /// Shares of all mass that is free to move along x, y and z (effective modal masses).
    pub effective_mass: [f64; 3],
    /// The shape of each body in the author's order, of any amplitude (the largest displacement is 1).
    #[serde(skip)]
    pub shapes: BTreeMap<String, Vec<DVec3>>,
}

impl Simulation {
    /// The `count` lowest natural modes at the present state, bodies as they are held, viscosity as for sudden motion,
    /// without damping. None where nothing can move. Costs some thousand evaluations of the forces.
    ///
    /// Stiffness is that of elements, and what holds bodies are constraints: glue, ties, sutures, grasps and contact
    /// take no part, so that of what they hold frequencies are too low.
    ///
    /// # Errors
    /// What the GPU says; states whose forces are no numbers.
    pub fn modes(&mut self, count: usize) -> Result<Vec<Mode>, Error> {
        self.settle()?;
        bring_to_host(&mut self.world, |_, name| column_is(name, Tangent::reads))?;
        let bodies = bodies(&mut self.world);
        let roots = roots_of_mass(&self.world, &bodies);
        let free = roots.iter().filter(|&&root| root > 0.0).count();
        if free == 0 || count == 0 {
            return Ok(Vec::new());
        }
        let none = || Error::Options("the forces of the present state are no numbers: it has no natural modes".into());
        let top = largest_eigenvalue(&mut self.world, 0.1).ok_or_else(none)?.at_most;
        let mut tangent = Tangent::at_present(&self.world, &bodies).ok_or_else(none)?;
        let mut image = vec![0.0; roots.len()];
        let pairs = lowest(&roots, count.min(free), top, |x, y| {
            let u: Vec<f64> = x.iter().zip(&roots).map(|(x, root)| x * root).collect();
            // from both sides: a mode that turns more than it strains is known to the square of the difference
            tangent.times(&u, y);
            let back: Vec<f64> = u.iter().map(|u| -u).collect();
            tangent.times(&back, &mut image);
            y.iter_mut().zip(&image).zip(&roots).for_each(|((y, other), root)| *y = 0.5 * (*y - other) * root);
        });
        Ok(pairs.into_iter().map(|pair| self.mode(pair, &bodies, &roots, top)).collect())
    }

    fn mode(&self, pair: Pair, bodies: &[Entity], roots: &[f64], top: f64) -> Mode {
        let along = |axis: usize| {
            let rows = || pair.vector.iter().zip(roots).skip(axis).step_by(3).filter(|(_, root)| **root > 0.0);
            let all: f64 = rows().map(|(_, root)| 1.0 / (root * root)).sum();
            let moves = rows().map(|(x, root)| x / root).sum::<f64>().powi(2);
            if all > 0.0 { moves / all } else { 0.0 }
        };
        let largest = pair.vector.chunks(3).zip(roots.chunks(3)).map(|(x, root)| moved(x, root).length());
        let largest = largest.fold(f64::MIN_POSITIVE, f64::max);
        let (mut shapes, mut from) = (BTreeMap::new(), 0);
        for &body in bodies {
            let length = self.world.get::<Displacement>(body).map_or(0, |u| u.len());
            let of = |row: usize| {
                let at = from + 3 * row;
                moved(&pair.vector[at..at + 3], &roots[at..at + 3]) / largest
            };
            if let (Some(label), Some(authoring)) = (self.world.get::<Label>(body), self.world.get::<Authoring>(body)) {
                shapes.insert(label.0.clone(), authoring.node_rows.iter().map(|&row| of(row as usize)).collect());
            }
            from += length;
        }
        let rigid = pair.value.abs() <= RIGID * top;
        let frequency = if rigid { 0.0 } else { pair.value.max(0.0).sqrt() / std::f64::consts::TAU };
        Mode { frequency, residual: pair.residual, effective_mass: [0, 1, 2].map(along), shapes }
    }
}

fn moved(x: &[f64], roots: &[f64]) -> DVec3 {
    DVec3::new(x[0] * roots[0], x[1] * roots[1], x[2] * roots[2])
}

/// An eigenvalue, its vector of length 1, and its residual as a share.
struct Pair {
    value: f64,
    vector: Vec<f64>,
    residual: f64,
}

/// The lowest eigenpairs of a symmetric matrix whose eigenvalues lie between 0 and `top`; axes without a root stay 0.
fn lowest(roots: &[f64], count: usize, top: f64, mut times: impl FnMut(&[f64], &mut [f64])) -> Vec<Pair> {
    let free = roots.iter().filter(|&&root| root > 0.0).count();
    let width = (count + EXTRA_VECTORS.max(count / 2)).min(free);
    let mut basis: Vec<Vec<f64>> = noise(&roots.repeat(width)).chunks(roots.len()).map(<[f64]>::to_vec).collect();
    orthonormalise(&mut basis);
    let (mut cut, mut degree) = (0.1 * top, DEGREE.0);
    let mut pairs = Vec::new();
    for filter in 0..FILTERS {
        if width < free {
            basis.iter_mut().for_each(|vector| chebyshev(vector, degree, (cut, top), &mut times));
            orthonormalise(&mut basis);
        }
        let images: Vec<Vec<f64>> = basis
            .iter()
            .map(|vector| {
                let mut image = vec![0.0; vector.len()];
                times(vector, &mut image);
                image
            })
            .collect();
        let product = |i: usize, j: usize| 0.5 * (dot(&basis[i], &images[j]) + dot(&basis[j], &images[i]));
        let projected = (0..width).map(|i| (0..width).map(|j| product(i, j)).collect()).collect();
        let (values, rotation) = eigen(projected);
        basis = combine(&basis, &rotation);
        let images = combine(&images, &rotation);
        let residual = |number: usize| {
            let apart = basis[number].iter().zip(&images[number]).map(|(x, y)| (y - values[number] * x).powi(2));
            apart.sum::<f64>().sqrt() / values[number].abs().max(RIGID * top)
        };
        let done = (0..count).all(|number| residual(number) <= TOLERANCE);
        if done || filter + 1 == FILTERS || width == free {
            let pair = |number: usize| Pair {
                value: values[number],
                vector: basis[number].clone(),
                residual: residual(number),
            };
            pairs = (0..count).map(pair).collect();
            break;
        }
        // all that lies beyond the vectors beside is damped; how many products make the lowest grow enough
        cut = values[width - 1].clamp(1e-12 * top, 0.9 * top);
        let rate = (2.0 * (cut - values[0]).max(1e-12 * cut) / (top - cut)).sqrt();
        degree = ((GROWTH.ln() / (2.0 * rate)) as usize).clamp(DEGREE.0, DEGREE.1);
    }
    pairs
}

/// The vector under the Chebyshev polynomial of the first kind of a degree, with [a, b] mapped to [−1, 1].
fn chebyshev(vector: &mut Vec<f64>, degree: usize, (a, b): (f64, f64), times: &mut impl FnMut(&[f64], &mut [f64])) {
    let (half, middle) = (0.5 * (b - a), 0.5 * (a + b));
    let mut image = vec![0.0; vector.len()];
    times(vector, &mut image);
    let mut before = std::mem::take(vector);
    let mut now: Vec<f64> = image.iter().zip(&before).map(|(y, x)| (y - middle * x) / half).collect();
    for _ in 1..degree {
        times(&now, &mut image);
        for i in 0..now.len() {
            before[i] = 2.0 * (image[i] - middle * now[i]) / half - before[i];
        }
        std::mem::swap(&mut before, &mut now);
        // what grows without end keeps its direction
        let largest = now.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        if largest > 1e100 {
            now.iter_mut().chain(&mut before).for_each(|x| *x /= largest);
        }
    }
    *vector = now;
}

/// Gram and Schmidt's way, twice; a vector that depends on those before it becomes one of the noise.
fn orthonormalise(basis: &mut [Vec<f64>]) {
    for number in 0..basis.len() {
        let (before, rest) = basis.split_at_mut(number);
        let vector = &mut rest[0];
        for _ in 0..2 {
            let length = dot(vector, vector).sqrt();
            vector.iter_mut().for_each(|x| *x /= length.max(f64::MIN_POSITIVE));
            for other in before.iter() {
                let part = dot(other, vector);
                vector.iter_mut().zip(other).for_each(|(x, o)| *x -= part * o);
            }
        }
        let length = dot(vector, vector).sqrt();
        vector.iter_mut().for_each(|x| *x /= length.max(f64::MIN_POSITIVE));
    }
}

/// Sums of vectors by the columns of a rotation.
fn combine(vectors: &[Vec<f64>], rotation: &[Vec<f64>]) -> Vec<Vec<f64>> {
    (0..vectors.len())
        .map(|column| {
            let mut sum = vec![0.0; vectors[0].len()];
            for (vector, row) in vectors.iter().zip(rotation) {
                sum.iter_mut().zip(vector).for_each(|(sum, x)| *sum += row[column] * x);
            }
            sum
        })
        .collect()
}

/// Eigenvalues of a small symmetric matrix, ascending, and its eigenvectors as columns: Jacobi's cyclic rotations
/// (Golub & Van Loan 2013, §8.5).
fn eigen(mut matrix: Vec<Vec<f64>>) -> (Vec<f64>, Vec<Vec<f64>>) {
    let size = matrix.len();
    let mut vectors: Vec<Vec<f64>> = (0..size).map(|i| (0..size).map(|j| f64::from(i == j)).collect()).collect();
    for _ in 0..30 {
        for p in 0..size {
            for q in p + 1..size {
                if matrix[p][q] == 0.0 {
                    continue;
                }
                let theta = (matrix[q][q] - matrix[p][p]) / (2.0 * matrix[p][q]);
                let tangent = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
                let sine = tangent * cosine;
                let turn = |a: f64, b: f64| (cosine * a - sine * b, sine * a + cosine * b);
                for row in matrix.iter_mut().chain(&mut vectors) {
                    (row[p], row[q]) = turn(row[p], row[q]);
                }
                for k in 0..size {
                    (matrix[p][k], matrix[q][k]) = turn(matrix[p][k], matrix[q][k]);
                }
            }
        }
    }
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|&a, &b| matrix[a][a].total_cmp(&matrix[b][b]));
    let values = order.iter().map(|&i| matrix[i][i]).collect();
    (values, vectors.iter().map(|row| order.iter().map(|&i| row[i]).collect()).collect())
}

#[cfg(test)]
mod tests;
