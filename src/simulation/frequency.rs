//! The largest frequency of all bodies at the present state, by Lanczos' recursion on M^(−½) K M^(−½).
//!
//! What k products show of the largest eigenvalue λ is a Ritz value θ ≤ λ. How much below it may be is known for a
//! start without preference (Kuczyński & Woźniakowski 1992, theorem 4.2): whatever the matrix,
//!
//! P(θ < (1 − ε) λ) ≤ 1.648 √n exp(−(2k − 1) √ε),
//!
//! so with a chance of δ of being wrong λ ≤ θ/(1 − ε), √ε = ln(1.648 √n/δ)/(2k − 1). Where the recursion exhausts the
//! space, θ = λ.
//!
//! The margin goes by the number of products, whatever the start: one that knows the eigenvector shows θ sooner, but
//! nothing above it can be ruled out with fewer. So what is saved is products whose margin buys too little: see
//! [`largest_worth`].

use super::tangent::Tangent;
use crate::components::*;
use crate::math::Scalar;
use bevy_ecs::prelude::*;

/// δ: the chance that a start is so unlucky that the margin is too small.
const BAD_LUCK: f64 = 1e-6;
/// What differences of forces may be wrong by, as a share of the eigenvalue.
const OF_DIFFERENCES: f64 = 1e-5;
/// The space is exhausted when what is left is so small, as a share of the eigenvalue.
const EXHAUSTED: f64 = 1e-7;
/// Vectors are kept, to be orthogonal to rounding, where there are at most so many free axes for each product: the
/// space can be exhausted there. In larger ones rounding repeats eigenvalues that were found, which adds none above the
/// largest (Paige 1980), and the vectors would take half as long as the products.
const KEPT_BELOW: usize = 20;

/// What a product costs, in steps. It is one evaluation of all forces in f64 by the kernel of all effects, and the
/// recursion.
pub(super) const PRODUCT: f64 = 2.0;
/// Products between two places at which the recursion may end early. The chance δ is that of each of them.
const BETWEEN_STOPS: usize = 4;

/// The largest eigenvalue of M⁻¹K.
#[derive(Clone, Copy, Debug)]
pub(super) struct Largest {
    /// The Ritz value: never above the eigenvalue (1/s²).
    pub at_least: f64,
    /// With the margin: never below it (1/s²); infinite after few products.
    pub at_most: f64,
    /// Products taken.
    pub products: usize,
}

/// ln(1.648 √n/δ) for so many free axes.
fn luck(free: usize) -> f64 {
    (1.648 * (free as f64).sqrt() / BAD_LUCK).ln()
}

/// Products that make the margin so small.
fn products_enough(free: usize, accuracy: f64) -> usize {
    (0.5 * (luck(free) / accuracy.sqrt() + 1.0)).ceil() as usize
}

/// The largest eigenvalue of M⁻¹K at the present state with held axes, known to the share `accuracy`. The columns on
/// the host must be up to date: see [`Tangent::reads`]. `None` where nothing can move, or forces are no numbers.
pub(super) fn largest_eigenvalue(world: &mut World, accuracy: f64) -> Option<Largest> {
    largest_worth(world, accuracy, None)
}

/// The same, where there are `steps` known only so well as is worth the products: that is how many will be taken when
/// the eigenvalue is at most so large, and [`PRODUCT`] what a product costs. It ends where the steps that all further
/// products could save, were θ the eigenvalue, are fewer than they cost; before the first where even nothing to resist
/// motion would save too little.
pub(super) fn largest_worth(world: &mut World, accuracy: f64, steps: Option<&dyn Fn(f64) -> f64>) -> Option<Largest> {
    let bodies = bodies(world);
    let roots = roots_of_mass(world, &bodies);
    let free = roots.iter().filter(|&&root| root > 0.0).count();
    if free == 0 {
        return None;
    }
    let (luck, enough) = (luck(free), products_enough(free, accuracy));
    let at_most = |ritz: f64, products: usize| {
        let margin = if products > 0 { (luck / (2.0 * products as f64 - 1.0)).powi(2) } else { f64::INFINITY };
        if margin < MOST_MARGIN { ritz / (1.0 - margin) * (1.0 + OF_DIFFERENCES) } else { f64::INFINITY }
    };
    let worth_more = |ritz: f64, products: usize| {
        let Some(steps) = steps else { return true };
        let all = |more: usize| PRODUCT * more as f64 + steps(at_most(ritz, products + more));
        let now = all(0);
        (1..=enough - products.min(enough)).any(|more| all(more) < now)
    };
    if !worth_more(0.0, 0) {
        return Some(Largest { at_least: 0.0, at_most: f64::INFINITY, products: 0 });
    }
    let mut tangent = Tangent::at_present(world, &bodies)?;
    let times = |x: &[f64], image: &mut [f64]| {
        let u: Vec<f64> = x.iter().zip(&roots).map(|(x, root)| x * root).collect();
        tangent.times(&u, image);
        image.iter_mut().zip(&roots).for_each(|(force, root)| *force *= root);
    };
    let found = lanczos(noise(&roots), enough, None, times, worth_more)?;
    let at_most = match found.exhausted {
        true => found.largest * (1.0 + OF_DIFFERENCES),
        false => at_most(found.largest, found.products),
    };
    Some(Largest { at_least: found.largest, at_most, products: found.products })
}

/// The share of a start that is noise, beside the shape that was known.
const NOISE: f64 = 0.3;

/// The largest eigenvalue of M⁻¹K at the present state, at least (1/s²), by few `products` from a start near its
/// eigenvector: the `shape` that was found last, and noise where `weights` (of each axis) say that it may be now. With
/// the new shape, √M u of all axes in f32. The columns on the host must be up to date: see [`Tangent::reads`]. `None`
/// where nothing can move, or forces are no numbers.
pub(super) fn largest_near(
    world: &mut World,
    shape: Option<&[f32]>,
    weights: &[f64],
    products: usize,
) -> Option<(f64, Vec<f32>)> {
    let bodies = bodies(world);
    let roots = roots_of_mass(world, &bodies);
    let scaled = |mut vector: Vec<f64>, to: f64| {
        let length = dot(&vector, &vector).sqrt();
        vector.iter_mut().for_each(|x| *x *= if length > 0.0 { to / length } else { 0.0 });
        vector
    };
    let weighted = noise(&roots).iter().zip(weights).map(|(noise, weight)| noise * weight).collect();
    let mut start = scaled(weighted, if shape.is_some() { NOISE } else { 1.0 });
    if let Some(shape) = shape.filter(|shape| shape.len() == roots.len()) {
        // axes that are held by now have no part
        let known = shape.iter().zip(&roots).map(|(&x, &root)| if root > 0.0 { f64::from(x) } else { 0.0 }).collect();
        start.iter_mut().zip(scaled(known, 1.0)).for_each(|(x, known)| *x += known);
    }
    let mut tangent = Tangent::at_present(world, &bodies)?;
    let times = |x: &[f64], image: &mut [f64]| {
        let u: Vec<f64> = x.iter().zip(&roots).map(|(x, root)| x * root).collect();
        tangent.times(&u, image);
        image.iter_mut().zip(&roots).for_each(|(force, root)| *force *= root);
    };
    let mut kept = Vec::new();
    let found = lanczos(start, products, Some(&mut kept), times, |_, _| true)?;
    let mut ritz = vec![0.0; roots.len()];
    for (share, vector) in eigenvector(&found).iter().zip(&kept) {
        ritz.iter_mut().zip(vector).for_each(|(x, basis)| *x += share * basis);
    }
    Some((found.largest, ritz.into_iter().map(|x| x as f32).collect()))
}

/// The eigenvector of the largest eigenvalue of the recursion's tridiagonal matrix: by inverse iteration beside it.
fn eigenvector(found: &Ritz) -> Vec<f64> {
    let count = found.diagonal.len();
    let shift = found.largest * (1.0 + 1e-9);
    let mut x = vec![1.0; count];
    for _ in 0..4 {
        // (T − shift) x, all of whose pivots are negative: Thomas' algorithm
        let mut pivots = vec![0.0; count];
        for i in 0..count {
            let off = if i > 0 { found.off_diagonal[i - 1] } else { 0.0 };
            pivots[i] = found.diagonal[i] - shift - if i > 0 { off * off / pivots[i - 1] } else { 0.0 };
            if i > 0 {
                x[i] -= off / pivots[i - 1] * x[i - 1];
            }
        }
        for i in (0..count).rev() {
            let next = if i + 1 < count { found.off_diagonal[i] * x[i + 1] } else { 0.0 };
            x[i] = (x[i] - next) / pivots[i];
        }
        let length = dot(&x, &x).sqrt();
        x.iter_mut().for_each(|x| *x /= length);
    }
    x
}

/// A margin so large says nothing.
const MOST_MARGIN: f64 = 0.99;

struct Ritz {
    largest: f64,
    products: usize,
    exhausted: bool,
    /// The tridiagonal matrix.
    diagonal: Vec<f64>,
    off_diagonal: Vec<f64>,
}

/// The largest Ritz value after `products` products, or as soon as more are not worth it; `None` when it is no positive
/// number. `all` takes the vectors of the recursion.
fn lanczos(
    start: Vec<f64>,
    products: usize,
    all: Option<&mut Vec<Vec<f64>>>,
    mut times: impl FnMut(&[f64], &mut [f64]),
    worth_more: impl Fn(f64, usize) -> bool,
) -> Option<Ritz> {
    let size = start.len();
    let dimensions = start.iter().filter(|&&x| x != 0.0).count();
    let keep = all.is_some() || dimensions <= KEPT_BELOW * products;
    let mut own = Vec::new();
    let kept: &mut Vec<Vec<f64>> = all.unwrap_or(&mut own);
    let (mut previous, mut vector, mut image) = (vec![0.0; size], start, vec![0.0; size]);
    let (mut diagonal, mut off_diagonal): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let (mut exhausted, mut scale) = (false, 0.0_f64);
    for _ in 0..products {
        let length = dot(&vector, &vector).sqrt();
        if !length.is_finite() {
            return None;
        }
        if length <= EXHAUSTED * scale || length == 0.0 || diagonal.len() == dimensions {
            exhausted = keep;
            break;
        }
        if !diagonal.is_empty() {
            off_diagonal.push(length);
        }
        vector.iter_mut().for_each(|x| *x /= length);
        times(&vector, &mut image);
        let along = dot(&image, &vector);
        let back = if diagonal.is_empty() { 0.0 } else { length };
        diagonal.push(along);
        if diagonal.len() % BETWEEN_STOPS == 0
            && !worth_more(largest_of_tridiagonal(&diagonal, &off_diagonal), diagonal.len())
        {
            break;
        }
        scale = scale.max(along.abs());
        for i in 0..size {
            image[i] -= along * vector[i] + back * previous[i];
        }
        std::mem::swap(&mut previous, &mut vector);
        std::mem::swap(&mut vector, &mut image);
        if keep {
            kept.push(previous.clone());
            // twice is enough (Parlett 1980)
            for _ in 0..2 {
                for basis in kept.iter() {
                    let part = dot(basis, &vector);
                    vector.iter_mut().zip(basis).for_each(|(x, b)| *x -= part * b);
                }
            }
        }
    }
    let largest = largest_of_tridiagonal(&diagonal, &off_diagonal);
    let products = diagonal.len();
    (largest.is_finite() && largest > 0.0).then_some(Ritz { largest, products, exhausted, diagonal, off_diagonal })
}

/// Bodies in a fixed order.
pub(super) fn bodies(world: &mut World) -> Vec<Entity> {
    let mut bodies: Vec<Entity> = world.query_filtered::<Entity, With<ConstrainedAxes>>().iter(world).collect();
    bodies.sort();
    bodies
}

/// 1/√M of every free axis, 0 of held and inactive ones. M is the mass that nodes are moved with.
pub(super) fn roots_of_mass(world: &World, bodies: &[Entity]) -> Vec<f64> {
    let mut roots = Vec::new();
    for &body in bodies {
        let (Some(mass), Some(axes)) = (world.get::<Mass>(body), world.get::<ConstrainedAxes>(body)) else { continue };
        let inertia = world.get::<InertialMass>(body).map_or(&mass.0, |inertial| &inertial.0);
        let root = |i: usize| {
            let mass = inertia.get(i / 3);
            let free = axes[i / 3] >> (i % 3) & 1 == 0 && mass > 0.0;
            if free { 1.0 / mass.sqrt() } else { 0.0 }
        };
        roots.extend((0..3 * inertia.len()).map(root));
    }
    roots
}

/// A start that prefers no direction, the same everywhere: independent numbers of a normal distribution (Marsaglia's
/// polar form of Box & Muller's).
pub(super) fn noise(roots: &[f64]) -> Vec<f64> {
    let mut state = 1_u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut normal = || {
        loop {
            let (a, b): (f64, f64) = (next(), next());
            let square = a * a + b * b;
            if square > 0.0 && square < 1.0 {
                return a * (-2.0 * square.ln() / square).sqrt();
            }
        }
    };
    roots.iter().map(|&root| if root > 0.0 { normal() } else { 0.0 }).collect()
}

/// Eight sums side by side, in f64: one alone waits for each addition.
pub(super) fn dot<T: Scalar>(a: &[T], b: &[T]) -> f64 {
    let (a, left) = a.as_chunks::<8>();
    let (b, others) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for i in 0..8 {
            sums[i] += a[i].to_f64() * b[i].to_f64();
        }
    }
    let rest: f64 = left.iter().zip(others).map(|(a, b)| a.to_f64() * b.to_f64()).sum();
    sums.iter().sum::<f64>() + rest
}

/// By bisection: as many eigenvalues are above x as the pivots of T − x that are positive.
fn largest_of_tridiagonal(diagonal: &[f64], off_diagonal: &[f64]) -> f64 {
    let above = |x: f64| {
        let mut pivot = f64::INFINITY;
        diagonal.iter().enumerate().any(|(i, d)| {
            let off = if i > 0 { off_diagonal[i - 1] } else { 0.0 };
            pivot = d - x - off * off / pivot;
            pivot > 0.0
        })
    };
    let side = |i: usize| off_diagonal.get(i).copied().unwrap_or(0.0).abs();
    let bound = |(i, d): (usize, &f64)| d + side(i) + if i > 0 { side(i - 1) } else { 0.0 };
    let (mut low, mut high) = (0.0, diagonal.iter().enumerate().map(bound).fold(0.0, f64::max));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if above(middle) { low = middle } else { high = middle }
    }
    high
}

#[cfg(test)]
mod tests;
