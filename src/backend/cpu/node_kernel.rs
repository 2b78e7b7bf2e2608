//! Central differences for all nodes of a body, a register full at a time.

mod factors;
mod one_by_one;

pub use factors::Factors;

use super::{Cpu, ROWS_A_TASK};
use crate::components::{COMPENSATION_NUMBERS, SPENT_ROWS, WORK_NUMBERS};
use crate::math::{LANES, Real, SimdScalar};
use one_by_one::{Sum, add_to_sum, move_node};
use pulp::{Simd, WithSimd};

/// What moves a body's nodes; layouts as in [`components`](crate::components).
pub struct NodeColumns<'a, T> {
    /// Mass (kg).
    pub mass: &'a [T],
    /// Forces of elements (N).
    pub internal: &'a [T],
    /// Loads (N).
    pub external: Option<&'a [T]>,
    /// Which axes are constrained, as bits.
    pub axes: &'a [u32],
    /// Damping coefficients (kg/s).
    pub damping: Option<&'a [T]>,
    /// What is the same for all nodes.
    pub factors: Factors<T>,
    /// Bits of the last steps (m) along prescribed axes; none where nothing is moved as told or all work is booked.
    pub kept: &'a [u32],
}

/// Returns the lowest row whose displacement is no longer finite.
pub fn move_nodes<T: SimdScalar>(
    cpu: &Cpu,
    inputs: &NodeColumns<'_, T>,
    u: &mut [T],
    step: &mut [T],
    compensation: Option<&mut [T]>,
    work: Option<&mut [T]>,
    spent: &mut [u32],
) -> Option<u32> {
    let bad = std::sync::atomic::AtomicU32::new(u32::MAX);
    let mut compensations = compensation.map(|c| c.chunks_mut(COMPENSATION_NUMBERS * ROWS_A_TASK));
    let mut works = work.map(|w| w.chunks_mut(WORK_NUMBERS * ROWS_A_TASK));
    // none where the whole work is booked
    let mut sums = spent.chunks_mut(2 * ROWS_A_TASK / SPENT_ROWS);
    let tasks = u.chunks_mut(3 * ROWS_A_TASK).zip(step.chunks_mut(3 * ROWS_A_TASK)).enumerate().map(|(task, rows)| {
        (
            task * ROWS_A_TASK,
            rows,
            compensations.as_mut().and_then(Iterator::next),
            works.as_mut().and_then(Iterator::next),
            sums.next().unwrap_or_default(),
        )
    });
    cpu.for_each(tasks, |(first, (u, step), compensation, work, sums)| {
        if let Some(row) = cpu.dispatch_widest(Rows { inputs, first, u, step, compensation, work, sums }) {
            bad.fetch_min(row as u32, std::sync::atomic::Ordering::Relaxed);
        }
    });
    Some(bad.into_inner()).filter(|&row| row != u32::MAX)
}

/// Rows of a task, from `first` on.
struct Rows<'a, T> {
    inputs: &'a NodeColumns<'a, T>,
    first: usize,
    u: &'a mut [T],
    step: &'a mut [T],
    compensation: Option<&'a mut [T]>,
    work: Option<&'a mut [T]>,
    sums: &'a mut [u32],
}

impl<T: SimdScalar> WithSimd for Rows<'_, T> {
    type Output = Option<usize>;

    /// The lowest row whose displacement is no longer finite.
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Option<usize> {
        let rows = self.u.len() / 3;
        let mut bad = None;
        for from in (0..rows).step_by(SPENT_ROWS) {
            let to = rows.min(from + SPENT_ROWS);
            let mass = &self.inputs.mass[self.first + from..self.first + to];
            let whole = to - from == SPENT_ROWS && self.work.is_none() && mass.iter().all(|&mass| mass > T::default());
            let (spent, finite) = if whole { self.chunk(simd, from) } else { self.one_by_one(from, to) };
            add_to_sum(self.sums.get_mut(2 * (from / SPENT_ROWS)..), spent);
            if bad.is_none() && !finite {
                let is_bad = |row: &usize| !self.u[3 * row..3 * row + 3].iter().all(|u| u.to_f64().is_finite());
                bad = (from..to).find(is_bad).map(|row| self.first + row);
            }
        }
        bad
    }
}

/// Components of a chunk's nodes.
const NUMBERS: usize = 3 * SPENT_ROWS;

impl<T: SimdScalar> Rows<'_, T> {
    /// Any nodes, one after the other. Returns the work against internal forces (J), and whether displacements are finite.
    fn one_by_one(&mut self, from: usize, to: usize) -> (f64, bool) {
        let (mut spent, mut finite) = (0.0, true);
        for row in from..to {
            let at = 3 * row..3 * row + 3;
            let lost = COMPENSATION_NUMBERS * row..COMPENSATION_NUMBERS * (row + 1);
            let lost = self.compensation.as_mut().map(|c| &mut c[lost]);
            let mut sum = Sum { u: &mut self.u[at.clone()], step: &mut self.step[at], lost };
            let work = self.work.as_mut().map(|w| &mut w[WORK_NUMBERS * row..WORK_NUMBERS * (row + 1)]);
            spent += move_node(self.inputs, self.first + row, &mut sum, work);
            // what is not finite in one component is not finite in the sum
            finite &= (sum.u[0] + sum.u[1] + sum.u[2]).to_f64().is_finite();
        }
        (spent, finite)
    }

    /// [`SPENT_ROWS`] nodes with mass whose work is not booked: the same operations in the same order as one by one, for
    /// registers full of components.
    #[inline(always)]
    fn chunk<S: Simd>(&mut self, simd: S, from: usize) -> (f64, bool) {
        let inputs = self.inputs;
        let first = self.first + from;
        let nodes = self.nodes(simd, first);
        let numbers = 3 * first..3 * first + NUMBERS;
        let internal = &inputs.internal[numbers.clone()];
        let external = inputs.external.map(|all| &all[numbers]);
        let u = &mut self.u[3 * from..3 * from + NUMBERS];
        let step = &mut self.step[3 * from..3 * from + NUMBERS];
        let mut work = [T::default(); NUMBERS];
        let mut lost = self.compensation.as_mut().map(|all| {
            let own = &mut all[COMPENSATION_NUMBERS * from..COMPENSATION_NUMBERS * (from + SPENT_ROWS)];
            let apart = apart(own);
            (own, apart)
        });
        let zero = T::splat(simd, T::default());
        let force = T::splat(simd, inputs.factors.force);
        let mut astray = zero;
        let mut at = 0;
        while at < NUMBERS {
            let inner = T::load(simd, &internal[at..]);
            let outer = match external {
                Some(external) => T::load(simd, &external[at..]),
                None => zero,
            };
            let free = T::load(simd, &nodes.free[at..]);
            let before = T::load(simd, &step[at..]);
            let mut change = force * ((outer - inner) * T::load(simd, &nodes.per_mass[at..]));
            if nodes.damped {
                change = (change - T::load(simd, &nodes.damping[at..]) * before) * T::load(simd, &nodes.shrink[at..]);
            }
            let old = T::load(simd, &u[at..]);
            let (after, new);
            match &mut lost {
                None => {
                    after = free.if_positive(before + change, before);
                    new = old + after;
                }
                Some((_, [of_u, of_step])) => {
                    let exact = change - T::load(simd, &of_step[at..]);
                    let rounded = before + exact;
                    let left = free.if_positive((rounded - before) - exact, zero);
                    after = free.if_positive(rounded, before);
                    let exact = (after - left) - T::load(simd, &of_u[at..]);
                    new = old + exact;
                    T::store(left, &mut of_step[at..]);
                    T::store((new - old) - exact, &mut of_u[at..]);
                }
            }
            T::store(after, &mut step[at..]);
            T::store(new, &mut u[at..]);
            // what is no number stays none
            astray += new * zero;
            T::store(inner * (before + after), &mut work[at..]);
            at += T::width::<S>();
        }
        if let Some((own, apart)) = lost {
            together(own, &apart);
        }
        let mut lanes = [T::default(); LANES];
        T::store(astray, &mut lanes);
        let finite = lanes.iter().all(|&lane| lane == T::default());
        if self.sums.is_empty() {
            return (0.0, finite);
        }
        let step = &self.step[3 * from..3 * from + NUMBERS];
        (self.spent(first, &nodes.free, &mut work, step), finite)
    }

    /// What each component needs of its node.
    #[inline(always)]
    fn nodes<S: Simd>(&self, simd: S, first: usize) -> Nodes<T> {
        let Factors { half_step, divide, relaxation, .. } = self.inputs.factors;
        let (zero, one) = (T::default(), T::from_f64(1.0));
        let rows = first..first + SPENT_ROWS;
        let mut nodes = Nodes {
            per_mass: [zero; NUMBERS],
            damping: [zero; NUMBERS],
            shrink: [zero; NUMBERS],
            free: [one; NUMBERS],
            damped: self.inputs.damping.is_some() || relaxation > zero,
        };
        let mut per_mass = [zero; SPENT_ROWS];
        let mass = &self.inputs.mass[rows.clone()];
        let mut at = 0;
        while at < SPENT_ROWS {
            T::store(T::splat(simd, one) / T::load(simd, &mass[at..]), &mut per_mass[at..]);
            at += T::width::<S>();
        }
        for (three, per_mass) in nodes.per_mass.chunks_exact_mut(3).zip(per_mass) {
            three.copy_from_slice(&[per_mass; 3]);
        }
        if nodes.damped {
            for (row, per_mass) in per_mass.into_iter().enumerate() {
                let coefficient = self.inputs.damping.map_or(zero, |all| all[first + row]);
                let a = coefficient * half_step * per_mass + relaxation;
                let shrink = if a > zero { one / (one + divide * a) } else { one };
                nodes.damping[3 * row..3 * row + 3].copy_from_slice(&[(one + divide) * a; 3]);
                nodes.shrink[3 * row..3 * row + 3].copy_from_slice(&[shrink; 3]);
            }
        }
        for (row, &axes) in self.inputs.axes[rows].iter().enumerate().filter(|(_, axes)| **axes != 0) {
            for i in (0..3).filter(|i| axes >> i & 1 == 1) {
                nodes.free[3 * row + i] = zero;
            }
        }
        nodes
    }

    /// Work against internal forces (J), from internal forces times twice the mean step; where a step is prescribed, the one
    /// before it was kept apart.
    #[inline(always)]
    fn spent(&self, first: usize, free: &[T; NUMBERS], work: &mut [T; NUMBERS], step: &[T]) -> f64 {
        let kept = self.inputs.kept.get(3 * first..3 * first + NUMBERS);
        if let Some(kept) = kept {
            for (at, &bits) in kept.iter().enumerate().filter(|(at, _)| free[*at] == T::default()) {
                let last = T::from_f64(f64::from(f32::from_bits(bits)));
                work[at] = self.inputs.internal[3 * first + at] * (last + step[at]);
            }
        }
        let mut sums = [0.0; 4];
        for four in work.chunks_exact(12) {
            for (sum, work) in sums.iter_mut().zip(four.chunks_exact(3)) {
                *sum += (self.inputs.factors.booked * (work[0] + work[1] + work[2])).to_f64();
            }
        }
        0.5 * ((sums[0] + sums[1]) + (sums[2] + sums[3]))
    }
}

/// What each component of a chunk needs of its node.
struct Nodes<T> {
    per_mass: [T; NUMBERS],
    damping: [T; NUMBERS],
    shrink: [T; NUMBERS],
    /// 1, or 0 along constrained axes.
    free: [T; NUMBERS],
    damped: bool,
}

/// What rounding left out of displacements, and of steps.
#[inline(always)]
fn apart<T: SimdScalar>(lost: &[T]) -> [[T; NUMBERS]; 2] {
    let mut apart = [[T::default(); NUMBERS]; 2];
    let [of_u, of_step] = &mut apart;
    let nodes = lost.chunks_exact(COMPENSATION_NUMBERS);
    for ((node, u), step) in nodes.zip(of_u.chunks_exact_mut(3)).zip(of_step.chunks_exact_mut(3)) {
        u.copy_from_slice(&node[..3]);
        step.copy_from_slice(&node[3..]);
    }
    apart
}

#[inline(always)]
fn together<T: SimdScalar>(lost: &mut [T], [of_u, of_step]: &[[T; NUMBERS]; 2]) {
    let nodes = lost.chunks_exact_mut(COMPENSATION_NUMBERS);
    for ((node, u), step) in nodes.zip(of_u.chunks_exact(3)).zip(of_step.chunks_exact(3)) {
        node[..3].copy_from_slice(u);
        node[3..].copy_from_slice(step);
    }
}
