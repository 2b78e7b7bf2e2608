//! One node after the other: those at the end of a column, those without mass, those whose work is counted.

use super::{IntegrationCoefficients, NodeColumns};
use crate::math::Scalar;

/// A displacement and its step, summed with what rounding left out of both.
pub(super) struct Sum<'a, T> {
    pub(super) u: &'a mut [T],
    pub(super) step: &'a mut [T],
    /// Of the displacement, and of the step.
    pub(super) compensation: Option<[&'a mut [T]; 2]>,
}

impl<T: Scalar> Sum<'_, T> {
    /// Makes the step longer. At a small Δt the change has few digits in common with the step, and is lost without
    /// compensation.
    #[inline(always)]
    fn push(&mut self, i: usize, change: T) {
        match &mut self.compensation {
            None => self.step[i] += change,
            Some([_, compensation]) => compensated_add(&mut self.step[i], &mut compensation[i], change),
        }
    }

    /// Takes the step.
    #[inline(always)]
    fn go(&mut self, i: usize, constrained: bool) {
        match &mut self.compensation {
            None => self.u[i] += self.step[i],
            Some([of_u, of_step]) => {
                // what boundary wrote is the whole of a constrained step
                if constrained {
                    of_step[i] = T::default();
                }
                let exact = self.step[i] - of_step[i];
                compensated_add(&mut self.u[i], &mut of_u[i], exact);
            }
        }
    }
}

/// sum += change, where `lost` is what rounding has made of the sum too much (Kahan 1965).
#[inline(always)]
fn compensated_add<T: Scalar>(sum: &mut T, compensation: &mut T, change: T) {
    let exact = change - *compensation;
    let rounded = *sum + exact;
    *compensation = (rounded - *sum) - exact;
    *sum = rounded;
}

/// Adds to a number that is kept as two of f32.
pub(super) fn add_to_sum(sum: &mut [f32], part: f64) {
    let [high, low, ..] = sum else { return };
    let total = f64::from(*high) + f64::from(*low) + part;
    *high = total as f32;
    *low = (total - f64::from(*high)) as f32;
}

/// What moves one node.
pub(super) struct OneNode<T> {
    mass: T,
    axes: u32,
    damping: T,
    internal: [T; 3],
    external: [T; 3],
    /// The last step (m), which prescribed axes need.
    previous_prescribed: Option<[f32; 3]>,
}

impl<T: Scalar> OneNode<T> {
    pub(super) fn of(columns: &NodeColumns<'_, T>, row: usize) -> Self {
        let three = |all: &[T]| [all[3 * row], all[3 * row + 1], all[3 * row + 2]];
        Self {
            mass: columns.inertia[row],
            axes: columns.axes[row],
            damping: columns.damping.map_or(T::default(), |all| all[row]),
            internal: three(columns.internal),
            external: columns.external.as_deref().map_or([T::default(); 3], three),
            previous_prescribed: columns.previous_prescribed.get(3 * row..3 * row + 3).map(|d| [d[0], d[1], d[2]]),
        }
    }
}

/// Returns the work against internal forces (J).
#[inline(always)]
pub(super) fn move_node<T: Scalar>(
    node: &OneNode<T>,
    coefficients: &IntegrationCoefficients<T>,
    sum: &mut Sum<'_, T>,
    mut work: Option<&mut [T]>,
) -> f64 {
    let (zero, one) = (T::default(), T::from_f64(1.0));
    let IntegrationCoefficients { force: force_factor, half_step, after_first, rate, work_factor, relaxation } =
        *coefficients;
    let (mass, axes) = (node.mass, node.axes);
    if mass <= zero {
        sum.step.fill(zero);
        return 0.0;
    }
    let per_mass = one / mass;
    let coefficient = node.damping;
    let a = coefficient * half_step * per_mass + relaxation;
    let shrink = if a > zero { one / (one + after_first * a) } else { one };
    let mut internal_work = zero;
    for i in 0..3 {
        let internal = node.internal[i];
        let external = node.external[i];
        let constrained = axes >> i & 1 == 1;
        let before = sum.step[i];
        if !constrained {
            let pushed = force_factor * ((external - internal) * per_mass);
            sum.push(i, (pushed - (one + after_first) * a * before) * shrink);
        }
        sum.go(i, constrained);
        let step = sum.step[i];
        let last = match node.previous_prescribed {
            Some(previous) if constrained => T::from_f64(f64::from(previous[i])),
            _ => before,
        };
        internal_work += internal * (last + step);
        if let Some(work) = &mut work {
            // forces at the beginning of the step work along the mean of the steps before and after, in the first step
            // along half of it: so the balance of the scheme is exact in the middle of each step
            let before = if constrained { std::mem::replace(&mut work[4 + i], step) } else { before };
            let mean = T::from_f64(0.5) * (before + step);
            let along = work_factor * mean;
            let compensation = coefficient * rate * mean * along;
            work[0] += external * along;
            work[1] += compensation;
            work[3] += internal * along;
            if constrained {
                work[2] += (internal - external) * along + compensation;
            }
        }
    }
    0.5 * (work_factor * internal_work).to_f64()
}
