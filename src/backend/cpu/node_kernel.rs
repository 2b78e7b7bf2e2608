//! Central differences for nodes of a body, a register full at a time.

mod declared;
mod foreseen;
mod node_columns;
mod one_by_one;
mod own_rows;

pub(crate) use declared::Asked;
pub use declared::{Declared, Undeclared};
pub use foreseen::Foreseen;
pub(crate) use node_columns::Met;
pub use node_columns::{NodeColumns, Touches};
pub use own_rows::{NodeShare, OwnRows};

use super::Cpu;
use crate::components::{Clock, WORK_NUMBERS};
use crate::math::{LANES, Real, Scalar, SimdScalar};
use one_by_one::{OneNode, Sum, add_to_sum, move_node};
use pulp::{Simd, WithSimd};

/// What a step multiplies forces and damping with.
#[derive(Clone, Copy)]
pub struct IntegrationCoefficients<T> {
    /// Δt times the time between the middles of the last and of this step (see [`Clock::half_step_interval`]), times
    /// the force scale of a static analysis (s²).
    pub force: T,
    /// Half the time between the middles, in the first step Δt/2 (s).
    pub half_step: T,
    /// 1, in the first step 0.
    pub after_first: T,
    /// 1/Δt (1/s).
    pub rate: T,
    /// Share of a step's work that is counted, the time between the middles over Δt: 1, in the first step ½.
    pub work_factor: T,
    /// a of a static analysis, else 0.
    pub relaxation: T,
}

impl<T: Scalar> IntegrationCoefficients<T> {
    /// In the step that begins at the clock's time.
    pub fn of(clock: &Clock) -> Self {
        let (dt, between, first) = (clock.time_step, clock.half_step_interval(), clock.step == 0);
        let (force_scale, damping) =
            clock.relaxation.map_or((1.0, 0.0), |relaxation| (relaxation.force_scale, relaxation.damping));
        Self {
            force: T::from_f64(force_scale * dt * between),
            half_step: T::from_f64(0.5 * if first { dt } else { between }),
            after_first: T::from_f64(if first { 0.0 } else { 1.0 }),
            rate: T::from_f64(1.0 / dt),
            work_factor: T::from_f64(between / dt),
            relaxation: T::from_f64(damping),
        }
    }
}

/// Moves nodes. Returns the lowest row whose displacement is no longer finite.
pub fn move_nodes<T: SimdScalar>(
    cpu: &Cpu,
    columns: &mut NodeColumns<'_, T>,
    coefficients: &IntegrationCoefficients<T>,
) -> Option<u32> {
    for column in [
        Asked::InertialMass,
        Asked::InternalForce,
        Asked::ExternalForce,
        Asked::ConstrainedAxes,
        Asked::DampingCoefficient,
    ] {
        columns.reads(column);
    }
    columns.writes(Asked::Displacement);
    columns.writes(Asked::DisplacementIncrement);
    cpu.dispatch_widest(Task { columns, coefficients }).map(|row| row as u32)
}

struct Task<'a, 'c, T> {
    columns: &'a mut NodeColumns<'c, T>,
    coefficients: &'a IntegrationCoefficients<T>,
}

impl<T: SimdScalar> WithSimd for Task<'_, '_, T> {
    type Output = Option<usize>;

    /// The lowest row whose displacement is no longer finite.
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Option<usize> {
        let rows = self.columns.rows();
        let mut bad = None;
        for from in (0..rows).step_by(ROWS_A_CHUNK) {
            let to = rows.min(from + ROWS_A_CHUNK);
            let mass = &self.columns.inertia[from..to];
            let plain = self.columns.work.is_none() && mass.iter().all(|&mass| mass > T::default());
            let (internal_work, finite) = if plain { self.chunk(simd, from, to) } else { self.one_by_one(from, to) };
            if let Some(sum) = self.columns.sum_of(from) {
                add_to_sum(sum, internal_work);
            }
            if bad.is_none() && !finite {
                let u = &self.columns.u;
                let is_bad = |row: &usize| !u[3 * row..3 * row + 3].iter().all(|u| u.to_f64().is_finite());
                bad = (from..to).find(is_bad).map(|row| self.columns.first + row);
            }
        }
        bad
    }
}

/// Nodes whose work is summed before it is added to that of the steps before.
pub(crate) const ROWS_A_CHUNK: usize = 64;

impl<T: SimdScalar> Task<'_, '_, T> {
    /// Any nodes, one after the other. Returns the work against internal forces (J), and whether displacements are
    /// finite.
    fn one_by_one(&mut self, from: usize, to: usize) -> (f64, bool) {
        let (mut internal_work, mut finite) = (0.0, true);
        for row in from..to {
            let at = 3 * row..3 * row + 3;
            let columns = &mut self.columns;
            let node = OneNode::of(columns, row);
            let compensation = columns.compensation.as_mut();
            let compensation = compensation.map(|[of_u, of_step]| [&mut of_u[at.clone()], &mut of_step[at.clone()]]);
            let mut sum = Sum { u: &mut columns.u[at.clone()], step: &mut columns.step[at], compensation };
            let work = columns.work.as_mut().map(|w| &mut w[WORK_NUMBERS * row..WORK_NUMBERS * (row + 1)]);
            internal_work += move_node(&node, self.coefficients, &mut sum, work);
            // what is not finite in one component is not finite in the sum
            finite &= (sum.u[0] + sum.u[1] + sum.u[2]).to_f64().is_finite();
        }
        (internal_work, finite)
    }

    /// At most [`ROWS_A_CHUNK`] nodes with mass whose work is not counted: the same operations in the same order as one
    /// by one, for registers full of components.
    #[inline(always)]
    fn chunk<S: Simd>(&mut self, simd: S, from: usize, to: usize) -> (f64, bool) {
        let coefficients = self.coefficients;
        let columns = &mut *self.columns;
        let numbers = 3 * from..3 * to;
        let mut chunk = Chunk {
            internal: &columns.internal[numbers.clone()],
            external: columns.external.as_ref().map(|all| &all[numbers.clone()]),
            u: &mut columns.u[numbers.clone()],
            step: &mut columns.step[numbers.clone()],
            compensation: columns
                .compensation
                .as_mut()
                .map(|compensation| compensation.each_mut().map(|all| &mut all[numbers.clone()])),
            force: T::splat(simd, coefficients.force),
            non_finite: T::splat(simd, T::default()),
            internal_work: T::splat(simd, T::default()),
        };
        let width = T::width::<S>();
        for node in (from..to).step_by(width) {
            let nodes = node..to.min(node + width);
            let constants = Constants {
                mass: &columns.inertia[nodes.clone()],
                damping: columns.damping.map(|all| &all[nodes.clone()]),
                axes: &columns.axes[nodes.clone()],
                coefficients,
            };
            let [a, b, c] = constants.of_components(simd);
            let at = 3 * (node - from);
            if nodes.len() == width {
                chunk.register::<true>(simd, at, a);
                chunk.register::<true>(simd, at + width, b);
                chunk.register::<true>(simd, at + 2 * width, c);
            } else {
                chunk.register::<false>(simd, at, a);
                chunk.register::<false>(simd, at + width, b);
                chunk.register::<false>(simd, at + 2 * width, c);
            }
        }
        let lanes = |register| {
            let mut lanes = [T::default(); LANES];
            T::store(register, &mut lanes);
            lanes
        };
        let finite = lanes(chunk.non_finite).iter().all(|&lane| lane == T::default());
        if columns.internal_work.is_empty() {
            return (0.0, finite);
        }
        let mut internal_work: f64 = lanes(chunk.internal_work).iter().map(|lane| lane.to_f64()).sum();
        // along prescribed axes the last step was kept apart
        for (row, axes) in (from..to).map(|row| (row, columns.axes[row])).filter(|&(_, axes)| axes != 0) {
            for at in (0..3).filter(|i| axes >> i & 1 == 1).map(|i| 3 * row + i) {
                let last = columns.previous_prescribed.get(at).map_or(0.0, |&step| f64::from(step));
                internal_work += columns.internal[at].to_f64() * (last + columns.step[at].to_f64());
            }
        }
        (0.5 * coefficients.work_factor.to_f64() * internal_work, finite)
    }
}

/// What some nodes have, at most a register full.
struct Constants<'a, T> {
    mass: &'a [T],
    damping: Option<&'a [T]>,
    axes: &'a [u32],
    coefficients: &'a IntegrationCoefficients<T>,
}

/// What a register full of components needs.
struct OfComponents<V> {
    per_mass: V,
    /// (1 + after_first) a, and what the step shrinks with.
    damping: Option<[V; 2]>,
    /// 1, or 0 along constrained axes.
    free: Option<V>,
}

impl<T: SimdScalar> Constants<'_, T> {
    #[inline(always)]
    fn of_components<S: Simd>(&self, simd: S) -> [OfComponents<T::Vector<S>>; 3] {
        let IntegrationCoefficients { half_step, after_first, relaxation, .. } = *self.coefficients;
        let splat = |number: T| T::splat(simd, number);
        let (zero, one) = (T::default(), T::from_f64(1.0));
        let mass = T::load_part(simd, self.mass);
        // places without a node have no mass
        let per_mass = mass.if_positive(splat(one) / mass, splat(zero));
        let [x, y, z] = T::broadcast3(per_mass);
        let damping = (self.damping.is_some() || relaxation > zero).then(|| {
            let coefficient = self.damping.map_or(splat(zero), |all| T::load_part(simd, all));
            let a = coefficient * splat(half_step) * per_mass + splat(relaxation);
            let shrink = a.if_positive(splat(one) / (splat(one) + splat(after_first) * a), splat(one));
            let ([ax, ay, az], [sx, sy, sz]) = (T::broadcast3(splat(one + after_first) * a), T::broadcast3(shrink));
            [[ax, sx], [ay, sy], [az, sz]]
        });
        let [dx, dy, dz] = match damping {
            Some([x, y, z]) => [Some(x), Some(y), Some(z)],
            None => [None; 3],
        };
        let [fx, fy, fz] = match self.axes.iter().fold(0, |all, axes| all | axes) {
            0 => [None; 3],
            _ => {
                let [x, y, z] = self.free(simd);
                [Some(x), Some(y), Some(z)]
            }
        };
        [
            OfComponents { per_mass: x, damping: dx, free: fx },
            OfComponents { per_mass: y, damping: dy, free: fy },
            OfComponents { per_mass: z, damping: dz, free: fz },
        ]
    }

    #[inline(always)]
    fn free<S: Simd>(&self, simd: S) -> [T::Vector<S>; 3] {
        let mut free = [T::from_f64(1.0); 3 * LANES];
        for (three, axes) in free.chunks_exact_mut(3).zip(self.axes) {
            for i in (0..3).filter(|i| axes >> i & 1 == 1) {
                three[i] = T::default();
            }
        }
        let width = T::width::<S>();
        [T::load(simd, &free), T::load(simd, &free[width..]), T::load(simd, &free[2 * width..])]
    }
}

/// The columns of a chunk's nodes, and what is summed over them.
struct Chunk<'a, T: SimdScalar, S: Simd> {
    internal: &'a [T],
    external: Option<&'a [T]>,
    u: &'a mut [T],
    step: &'a mut [T],
    compensation: Option<[&'a mut [T]; 2]>,
    force: T::Vector<S>,
    /// Not 0 where a displacement is not finite.
    non_finite: T::Vector<S>,
    /// Internal forces times twice the mean step, but along constrained axes.
    internal_work: T::Vector<S>,
}

impl<T: SimdScalar, S: Simd> Chunk<'_, T, S> {
    /// A register full of components, or with `WHOLE` false what is left of them.
    #[inline(always)]
    fn register<const WHOLE: bool>(&mut self, simd: S, at: usize, constants: OfComponents<T::Vector<S>>) {
        let at = if WHOLE { at } else { at.min(self.u.len()) };
        macro_rules! load {
            ($from:expr) => {
                if WHOLE { T::load(simd, &$from[at..]) } else { T::load_part(simd, &$from[at..]) }
            };
        }
        macro_rules! store {
            ($value:expr, $to:expr) => {
                if WHOLE { T::store::<S>($value, &mut $to[at..]) } else { T::store_part::<S>($value, &mut $to[at..]) }
            };
        }
        let zero = T::splat(simd, T::default());
        let inner = load!(self.internal);
        let outer = match self.external {
            Some(external) => load!(external),
            None => zero,
        };
        let before = load!(self.step);
        let mut change = self.force * ((outer - inner) * constants.per_mass);
        if let Some([damping, shrink]) = constants.damping {
            change = (change - damping * before) * shrink;
        }
        let old = load!(self.u);
        let if_free = |moved: T::Vector<S>, held: T::Vector<S>| match constants.free {
            Some(free) => free.if_positive(moved, held),
            None => moved,
        };
        let (after, new);
        match &mut self.compensation {
            None => {
                after = if_free(before + change, before);
                new = old + after;
            }
            Some([of_u, of_step]) => {
                let exact = change - load!(of_step);
                let rounded = before + exact;
                let left = if_free((rounded - before) - exact, zero);
                after = if_free(rounded, before);
                let exact = (after - left) - load!(of_u);
                new = old + exact;
                store!(left, of_step);
                store!((new - old) - exact, of_u);
            }
        }
        store!(after, self.step);
        store!(new, self.u);
        // what is no number stays none
        self.non_finite += new * zero;
        self.internal_work += if_free(inner * (before + after), zero);
    }
}
