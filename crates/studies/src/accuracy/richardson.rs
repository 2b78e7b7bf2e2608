//! Richardson's extrapolation: from three meshes to the limit of infinitely small cells, with its uncertainty.
//!
//! Where a result q behaves as q(h) = q₀ + C hᵖ, three cell sizes determine p, C and q₀ (L. F. Richardson 1911; P. J.
//! Roache, *Verification and Validation in Computational Science and Engineering*, 1998).

/// Orders at which three results count as following a power of the cell size.
const CREDIBLE: std::ops::RangeInclusive<f64> = 0.5..=4.0;
/// The order that displacements of linear elements have in smooth problems.
const FORMAL: f64 = 2.0;
/// The order that two results are taken to have, which cannot show theirs: that of displacements beside clamped edges.
const ASSUMED: f64 = 1.0;
/// How many times the spread of three results is uncertain that follow no power of the cell size, and how many times
/// their difference that of two (Roache's factor of safety).
const LOST: f64 = 3.0;
/// The least share of the extrapolated step that is taken for uncertain (Roache's factor 1.25 for three meshes).
const FLOOR: f64 = 0.25;
/// Rates at which differences grow from doubling to doubling where elements lock: displacements then grow with the
/// square of the cells along an edge, and no faster (with some room). What grows faster is a first difference that
/// happens to be small.
const LOCKED: std::ops::RangeInclusive<f64> = 1.0..=4.5;

/// A limit and how well it is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// The extrapolated values.
    pub values: Vec<f64>,
    /// How far they may be off, in the norm that was asked for.
    pub uncertainty: f64,
    /// The observed order; `None` where the three results do not follow a power of the cell size.
    pub order: Option<f64>,
}

/// Extrapolates three results to cell size 0: `results[i]` was had with cells of size `sizes[i]`, descending. `norm`
/// measures differences.
///
/// Where the observed order p is credible, the limit is the extrapolation by it, and its uncertainty is how far the
/// extrapolation by another order lies from it, but at least a quarter of the extrapolated step. The other order is the
/// formal one, 2, where p is below it; where p is above it, which is luck and no convergence, it lies as far below,
/// twice over, down to 1. Elsewhere nothing is extrapolated: the limit is the finest result, and its uncertainty three
/// times the largest distance between the three. Where the second difference goes the way of the first and is larger by
/// no more than locking elements make it, results run apart, and two more doublings at the same rate are added to that
/// distance.
pub fn extrapolate(sizes: [f64; 3], results: [&[f64]; 3], norm: impl Fn(&[f64]) -> f64) -> Limit {
    let [coarse, middle, fine] = results;
    let (first, second) = (difference(coarse, middle), difference(middle, fine));
    let (far, near) = (norm(&first), norm(&second));
    let scale = norm(fine).max(norm(coarse));
    // three equal results: they are the limit, as far as numbers go
    if far.max(near) <= 1e-12 * scale {
        return Limit { values: fine.to_vec(), uncertainty: far.max(near).max(1e-14 * scale), order: None };
    }
    let same_way = first.iter().zip(&second).map(|(a, b)| a * b).sum::<f64>() > 0.0;
    let order = same_way.then(|| order(sizes, far / near)).flatten().filter(|order| CREDIBLE.contains(order));
    let Some(order) = order else {
        let spread = far.max(near).max(norm(&difference(coarse, fine)));
        let growth = near / far;
        let more = if same_way && LOCKED.contains(&growth) { near * (growth + growth * growth) } else { 0.0 };
        return Limit { values: fine.to_vec(), uncertainty: LOST * (spread + more), order };
    };
    let by = |order: f64| gain(sizes, order);
    let values: Vec<f64> = fine.iter().zip(&second).map(|(fine, second)| fine - by(order) * second).collect();
    let other = if order > FORMAL { (3.0 * FORMAL - 2.0 * order).max(ASSUMED) } else { FORMAL };
    let uncertainty = near * (by(order) - by(other)).abs().max(FLOOR * by(order));
    Limit { values, uncertainty, order: Some(order) }
}

/// Extrapolates two results, as [`extrapolate`] does three: by order 1, since they show none. The uncertainty is twice
/// their difference; the error of the finer one is then at most three times the difference, enough down to order 0.42.
pub fn extrapolate_two(sizes: [f64; 2], results: [&[f64]; 2], norm: impl Fn(&[f64]) -> f64) -> Limit {
    let [middle, fine] = results;
    let last = difference(middle, fine);
    let by = gain_of_two(sizes);
    let values = fine.iter().zip(&last).map(|(fine, last)| fine - by * last).collect();
    let near = norm(&last);
    Limit { values, uncertainty: ((LOST - 1.0) * by * near).max(1e-14 * norm(fine)), order: None }
}

/// How many times the difference of two results their limit lies beyond the finer one.
pub fn gain_of_two([middle, fine]: [f64; 2]) -> f64 {
    gain([middle, middle, fine], ASSUMED)
}

/// How many times the last difference the limit of three results is uncertain where surfaces touch, whatever order
/// shows: which nodes touch changes with the mesh, and a force with them from one mesh to the next, as much as the
/// radius of contact is known, to a cell. The limit is between the finest result and its extrapolation by order 1.
pub fn doubt_of_contact([_, middle, fine]: [f64; 3], order: f64) -> f64 {
    let by = |order: f64| gain([middle, middle, fine], order);
    by(order).max((by(ASSUMED) - by(order)).abs())
}

/// How many times the last difference the extrapolation goes beyond the finest result.
fn gain([_, middle, fine]: [f64; 3], order: f64) -> f64 {
    fine.powf(order) / (middle.powf(order) - fine.powf(order))
}

/// The order p at which (h₁ᵖ − h₂ᵖ) / (h₂ᵖ − h₃ᵖ) is the ratio of the differences.
fn order([h1, h2, h3]: [f64; 3], ratio: f64) -> Option<f64> {
    let of = |p: f64| (h1.powf(p) - h2.powf(p)) / (h2.powf(p) - h3.powf(p));
    let (mut low, mut high) = (0.01, 12.0);
    if !(of(low)..=of(high)).contains(&ratio) {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if of(middle) < ratio { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}
