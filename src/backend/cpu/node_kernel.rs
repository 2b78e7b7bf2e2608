//! Central differences for all nodes of a body, a register full at a time.

mod factors;
mod one_by_one;

pub use factors::Factors;

use super::Cpu;
use crate::components::{SPENT_ROWS, WORK_NUMBERS};
use crate::math::{LANES, Real, SimdScalar};
use one_by_one::{OneNode, Sum, add_to_sum, move_node};
use pulp::{Simd, WithSimd};

/// What moves a body's nodes, or some of them one after the other; layouts as in [`components`](crate::components).
pub struct NodeColumns<'a, T> {
    /// Row of the first node.
    pub first: usize,
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
    /// Displacements (m).
    pub u: &'a mut [T],
    /// Steps (m).
    pub step: &'a mut [T],
    /// What rounding left out of displacements, and of steps.
    pub compensation: Option<[&'a mut [T]; 2]>,
    /// Work booked.
    pub work: Option<&'a mut [T]>,
    /// Work against internal forces, of every so many nodes; none where the whole work is booked.
    pub sums: &'a mut [u32],
    /// Bits of the last steps (m) along prescribed axes; none where nothing is moved as told or all work is booked.
    pub kept: &'a [u32],
}

/// Moves nodes. Returns the lowest row whose displacement is no longer finite.
pub fn move_nodes<T: SimdScalar>(cpu: &Cpu, columns: NodeColumns<'_, T>, factors: &Factors<T>) -> Option<u32> {
    cpu.dispatch_widest(Rows { columns, factors }).map(|row| row as u32)
}

struct Rows<'a, T> {
    columns: NodeColumns<'a, T>,
    factors: &'a Factors<T>,
}

impl<T: SimdScalar> WithSimd for Rows<'_, T> {
    type Output = Option<usize>;

    /// The lowest row whose displacement is no longer finite.
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Option<usize> {
        let rows = self.columns.u.len() / 3;
        let mut bad = None;
        for from in (0..rows).step_by(SPENT_ROWS) {
            let to = rows.min(from + SPENT_ROWS);
            let mass = &self.columns.mass[from..to];
            let whole =
                to - from == SPENT_ROWS && self.columns.work.is_none() && mass.iter().all(|&mass| mass > T::default());
            let (spent, finite) = if whole { self.chunk(simd, from) } else { self.one_by_one(from, to) };
            add_to_sum(self.columns.sums.get_mut(2 * (from / SPENT_ROWS)..), spent);
            if bad.is_none() && !finite {
                let u = &self.columns.u;
                let is_bad = |row: &usize| !u[3 * row..3 * row + 3].iter().all(|u| u.to_f64().is_finite());
                bad = (from..to).find(is_bad).map(|row| self.columns.first + row);
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
            let columns = &mut self.columns;
            let node = OneNode::of(columns, row);
            let lost = columns.compensation.as_mut();
            let lost = lost.map(|[of_u, of_step]| [&mut of_u[at.clone()], &mut of_step[at.clone()]]);
            let mut sum = Sum { u: &mut columns.u[at.clone()], step: &mut columns.step[at], lost };
            let work = columns.work.as_mut().map(|w| &mut w[WORK_NUMBERS * row..WORK_NUMBERS * (row + 1)]);
            spent += move_node(&node, self.factors, &mut sum, work);
            // what is not finite in one component is not finite in the sum
            finite &= (sum.u[0] + sum.u[1] + sum.u[2]).to_f64().is_finite();
        }
        (spent, finite)
    }

    /// [`SPENT_ROWS`] nodes with mass whose work is not booked: the same operations in the same order as one by one, for
    /// registers full of components.
    #[inline(always)]
    fn chunk<S: Simd>(&mut self, simd: S, from: usize) -> (f64, bool) {
        let nodes = self.nodes(simd, from);
        let columns = &mut self.columns;
        let numbers = 3 * from..3 * from + NUMBERS;
        let internal = &columns.internal[numbers.clone()];
        let external = columns.external.map(|all| &all[numbers.clone()]);
        let u = &mut columns.u[numbers.clone()];
        let step = &mut columns.step[numbers.clone()];
        // where a step is prescribed, the work takes another one, kept apart
        let kept = columns.kept.get(numbers.clone());
        let mut work = [T::default(); NUMBERS];
        let lost = columns.compensation.as_mut();
        let mut lost = lost.map(|[of_u, of_step]| [&mut of_u[numbers.clone()], &mut of_step[numbers.clone()]]);
        let zero = T::splat(simd, T::default());
        let force = T::splat(simd, self.factors.force);
        let (mut astray, mut spent) = (zero, zero);
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
                Some([of_u, of_step]) => {
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
            let along = inner * (before + after);
            match kept {
                Some(_) => T::store(along, &mut work[at..]),
                None => spent += along,
            }
            at += T::width::<S>();
        }
        let mut lanes = [T::default(); LANES];
        T::store(astray, &mut lanes);
        let finite = lanes.iter().all(|&lane| lane == T::default());
        if self.columns.sums.is_empty() {
            return (0.0, finite);
        }
        if kept.is_some() {
            return (self.spent(from, &nodes.free, &mut work), finite);
        }
        let mut lanes = [T::default(); LANES];
        T::store(spent, &mut lanes);
        let spent: f64 = lanes.iter().map(|lane| lane.to_f64()).sum();
        (0.5 * self.factors.booked.to_f64() * spent, finite)
    }

    /// What each component needs of its node.
    #[inline(always)]
    fn nodes<S: Simd>(&self, simd: S, from: usize) -> Nodes<T> {
        let Factors { half_step, divide, relaxation, .. } = *self.factors;
        let columns = &self.columns;
        let (zero, one) = (T::default(), T::from_f64(1.0));
        let rows = from..from + SPENT_ROWS;
        let mut nodes = Nodes {
            per_mass: [zero; NUMBERS],
            damping: [zero; NUMBERS],
            shrink: [zero; NUMBERS],
            free: [one; NUMBERS],
            damped: columns.damping.is_some() || relaxation > zero,
        };
        let mut per_mass = [zero; SPENT_ROWS];
        let mass = &columns.mass[rows.clone()];
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
                let coefficient = columns.damping.map_or(zero, |all| all[from + row]);
                let a = coefficient * half_step * per_mass + relaxation;
                let shrink = if a > zero { one / (one + divide * a) } else { one };
                nodes.damping[3 * row..3 * row + 3].copy_from_slice(&[(one + divide) * a; 3]);
                nodes.shrink[3 * row..3 * row + 3].copy_from_slice(&[shrink; 3]);
            }
        }
        for (row, &axes) in columns.axes[rows].iter().enumerate().filter(|(_, axes)| **axes != 0) {
            for i in (0..3).filter(|i| axes >> i & 1 == 1) {
                nodes.free[3 * row + i] = zero;
            }
        }
        nodes
    }

    /// Work against internal forces (J), from internal forces times twice the mean step; where a step is prescribed, the one
    /// before it was kept apart.
    #[inline(always)]
    fn spent(&self, from: usize, free: &[T; NUMBERS], work: &mut [T; NUMBERS]) -> f64 {
        let columns = &self.columns;
        let numbers = 3 * from..3 * from + NUMBERS;
        let (internal, step) = (&columns.internal[numbers.clone()], &columns.step[numbers.clone()]);
        let kept = columns.kept.get(numbers);
        if let Some(kept) = kept {
            for (at, &bits) in kept.iter().enumerate().filter(|(at, _)| free[*at] == T::default()) {
                let last = T::from_f64(f64::from(f32::from_bits(bits)));
                work[at] = internal[at] * (last + step[at]);
            }
        }
        let mut sums = [0.0; 4];
        for four in work.chunks_exact(12) {
            for (sum, work) in sums.iter_mut().zip(four.chunks_exact(3)) {
                *sum += (self.factors.booked * (work[0] + work[1] + work[2])).to_f64();
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
