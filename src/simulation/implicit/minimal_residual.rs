//! The minimal residual method for the linear system of a path of equilibria, whose operator need not be positive
//! (Paige & Saunders 1975), with a preconditioner that is (Elman, Silvester & Wathen 2014, section 4.1).

use super::axes::Axes;
use super::conjugate_gradients::Stop;
use super::preconditioner::Preconditioner;
use super::sums::Sums;
use super::vectors::{clear, copy, update};
use crate::components::Reals;
use crate::error::Error;

/// A pivot below this share of the largest is rounding of products.
const ROUNDING: f64 = 1e-7;

/// Vectors over all axes.
pub(super) struct Vectors([Reals; 7]);

impl Vectors {
    /// Of all axes.
    pub fn of(axes: &Axes) -> Self {
        Self([(); 7].map(|()| axes.zeros()))
    }
}

/// How a solve went.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solved {
    pub iterations: u64,
    /// Whether the operator is negative along some direction that the solve has met.
    pub gives_way: bool,
}

/// x ≈ A⁻¹ b from x = 0, to a residual whose norm rᵀ B r, B the preconditioner, is a share of that of b.
///
/// The signs of the pivots of the Lanczos matrix are those of eigenvalues of A in the space that the solve has seen.
pub(super) fn solve(
    sums: &Sums,
    b: &Reals,
    x: &mut Reals,
    Vectors(vectors): &mut Vectors,
    preconditioner: &mut dyn Preconditioner,
    stop: Stop,
    mut times: impl FnMut(&Reals, &mut Reals) -> Result<(), Error>,
) -> Result<Solved, Error> {
    vectors.iter_mut().for_each(clear);
    let [v_before, v, z, image, w_before, w, z_next] = vectors;
    clear(x);
    copy(v, b);
    preconditioner.apply(sums.cpu(), v, z);
    let mut gamma = sums.dot(z, v).max(0.0).sqrt();
    let (first, mut eta, mut gamma_before) = (gamma, gamma, 1.0);
    let (mut cosines, mut sines) = ([1.0, 1.0], [0.0, 0.0]);
    let (mut pivot, mut largest, mut gives_way) = (1.0, 0.0_f64, false);
    if first == 0.0 {
        return Ok(Solved { iterations: 0, gives_way });
    }
    for iteration in 1..=stop.most {
        update(z, |_, z| z / gamma);
        times(z, image)?;
        let delta = sums.dot(image, z);
        // v becomes the next vector of Lanczos, and the one before it what it was
        for i in 0..x.len() {
            let next = image.get(i) - delta / gamma * v.get(i) - gamma / gamma_before * v_before.get(i);
            v_before.set(i, v.get(i));
            v.set(i, next);
        }
        preconditioner.apply(sums.cpu(), v, z_next);
        let gamma_next = sums.dot(z_next, v).max(0.0).sqrt();
        pivot = if iteration == 1 { delta } else { delta - gamma * gamma / pivot };
        largest = largest.max(delta.abs());
        gives_way |= pivot < -ROUNDING * largest;
        let [c_before, c] = cosines;
        let [s_before, s] = sines;
        let diagonal = c * delta - c_before * s * gamma;
        let length = diagonal.hypot(gamma_next);
        let [two, one] = [s_before * gamma, s * delta + c_before * c * gamma];
        cosines = [c, diagonal / length];
        sines = [s, gamma_next / length];
        for i in 0..x.len() {
            let next = (z.get(i) - two * w_before.get(i) - one * w.get(i)) / length;
            w_before.set(i, w.get(i));
            w.set(i, next);
            x.set(i, x.get(i) + cosines[1] * eta * next);
        }
        eta *= -sines[1];
        // what is no number does not go on
        let goes_on = eta.abs() > stop.tolerance * first && gamma_next > 0.0;
        if !goes_on {
            return Ok(Solved { iterations: iteration, gives_way });
        }
        std::mem::swap(z, z_next);
        (gamma_before, gamma) = (gamma, gamma_next);
    }
    Ok(Solved { iterations: stop.most, gives_way })
}

#[cfg(test)]
mod tests;
