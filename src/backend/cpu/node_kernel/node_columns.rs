//! What moves nodes, and how it is shared out among tasks.

use super::declared::{Declared, Undeclared};
use super::own_rows::OwnRows;
use super::{Foreseen, IntegrationCoefficients};
use crate::components::{GROUP_ROWS, MEETING_NUMBERS, WORK_NUMBERS};
use crate::math::{Scalar, SimdScalar, vector_at};
use glam::DVec3;
use std::sync::atomic::AtomicU32;

/// Some rows of a body's node columns, which no other task has; layouts as in [`components`](crate::components). A node
/// system asks for those that are among its [columns](crate::systems::NodeSystem::Columns): asking for another ends the
/// run with an error that names both, for the system might share a pass with what writes it.
pub struct NodeColumns<'a, T> {
    /// Row of the first node.
    pub first: usize,
    /// Where nodes are at rest (m).
    pub rest: &'a [DVec3],
    /// Forces of all elements of the body (N), of which [`Corners`](crate::components::Corners) tells whose they are.
    pub(crate) element_force: &'a [T],
    /// The lowest row of a node whose displacement is no longer finite; `u32::MAX`: none.
    pub(crate) non_finite: &'a AtomicU32,
    /// What a system asked for that it has not declared.
    pub(crate) undeclared: &'a Undeclared,
    /// What the system has declared whose turn it is.
    pub(crate) declared: Declared,
    /// Mass that weighs (kg).
    pub(crate) mass: &'a [T],
    /// Mass that is slow to move (kg): in a static analysis another one.
    pub(crate) inertia: &'a [T],
    /// Forces of elements (N).
    pub(crate) internal: &'a mut [T],
    /// Loads (N).
    pub(crate) external: Option<&'a mut [T]>,
    /// Which axes are constrained, as bits.
    pub(crate) axes: &'a [u32],
    /// Damping coefficients (kg/s).
    pub(crate) damping: Option<&'a [T]>,
    /// Displacements (m).
    pub(crate) u: &'a mut [T],
    /// Steps (m).
    pub(crate) step: &'a mut [T],
    /// What rounding left out of displacements, and of steps.
    pub(crate) compensation: Option<[&'a mut [T]; 2]>,
    /// Work counted.
    pub(crate) work: Option<&'a mut [T]>,
    /// Work against internal forces: a sum and its remainder for each row that is a multiple of [`GROUP_ROWS`], and one
    /// at the end of all; none where the whole work is accumulated.
    pub(crate) internal_work: &'a mut [f32],
    /// The last steps (m) along prescribed axes; none where nothing is prescribed or the whole work is accumulated.
    pub(crate) previous_prescribed: &'a mut [f32],
    /// What tools do to those that they may touch; none where there are no tools.
    pub(crate) touches: Option<Touches<'a, T>>,
    /// What tools do to those that they may hold; none where none may.
    pub(crate) holds: Option<Touches<'a, T>>,
    /// What others do to them; none where none may.
    pub(crate) met: Option<Met<'a, T>>,
    /// What systems have for themselves.
    pub(crate) own: OwnRows<'a, T>,
}

/// What tools do to some nodes.
pub struct Touches<'a, T> {
    /// The nodes' rows in the body, ascending.
    pub rows: &'a [u32],
    /// See [`ToolTouch`](crate::components::ToolTouch) and [`ToolHold`](crate::components::ToolHold): `numbers` for
    /// each of them.
    pub values: &'a mut [T],
    /// How many.
    pub numbers: usize,
}

impl<'a, T> Touches<'a, T> {
    /// Those of rows before one.
    fn take(&mut self, until: usize) -> Self {
        let count = self.rows.partition_point(|&row| (row as usize) < until);
        let numbers = self.numbers;
        Touches { rows: first(&mut self.rows, count), values: first_mut(&mut self.values, numbers * count), numbers }
    }

    fn again(&mut self) -> Touches<'_, T> {
        Touches { rows: self.rows, values: &mut *self.values, numbers: self.numbers }
    }
}

/// What contact between surfaces does to nodes.
pub(crate) struct Met<'a, T> {
    /// See [`ContactForce`](crate::components::ContactForce): three numbers a node (N).
    pub force: &'a [T],
    /// See [`SurfaceTouch`](crate::components::SurfaceTouch).
    pub touch: &'a mut [T],
}

impl<'a, T> Met<'a, T> {
    /// That of the first so many nodes.
    fn take(&mut self, rows: usize) -> Self {
        Met { force: first(&mut self.force, 3 * rows), touch: first_mut(&mut self.touch, MEETING_NUMBERS * rows) }
    }

    fn again(&mut self) -> Met<'_, T> {
        Met { force: self.force, touch: &mut *self.touch }
    }
}

impl<T: SimdScalar> NodeColumns<'_, T> {
    /// Does a task with them; without `observed` forces are in a place of the task's own, which is gone afterwards.
    pub fn with_forces<R>(&mut self, observed: bool, task: impl FnOnce(&mut NodeColumns<'_, T>) -> R) -> R {
        if observed {
            return task(self);
        }
        T::with_spare(2 * self.internal.len(), |spare| {
            let (internal, external) = spare.split_at_mut(self.internal.len());
            task(&mut NodeColumns {
                first: self.first,
                rest: self.rest,
                element_force: self.element_force,
                non_finite: self.non_finite,
                undeclared: self.undeclared,
                declared: self.declared,
                mass: self.mass,
                inertia: self.inertia,
                internal,
                external: self.external.is_some().then_some(external),
                axes: self.axes,
                damping: self.damping,
                u: &mut *self.u,
                step: &mut *self.step,
                compensation: self.compensation.as_mut().map(|both| both.each_mut().map(|all| &mut **all)),
                work: self.work.as_deref_mut(),
                internal_work: &mut *self.internal_work,
                previous_prescribed: &mut *self.previous_prescribed,
                touches: self.touches.as_mut().map(Touches::again),
                holds: self.holds.as_mut().map(Touches::again),
                met: self.met.as_mut().map(Met::again),
                own: self.own.again(),
            })
        })
    }
}

impl<T: Scalar> NodeColumns<'_, T> {
    /// Displacement of one of these nodes (m).
    pub fn displacement(&self, row: usize) -> DVec3 {
        vector_at(self.displacements(), 3 * row)
    }

    /// Where one of these nodes is (m).
    pub fn place(&self, row: usize) -> DVec3 {
        self.rest[row] + self.displacement(row)
    }

    /// Displacement of one of these nodes (m), without what rounding has made of the sum of its steps: who corrects
    /// steps by where nodes are would push by that, m ulp(u)/Δt². Among the columns of who asks is
    /// [`DisplacementCompensation`](crate::components::DisplacementCompensation).
    pub(crate) fn exact_displacement(&self, row: usize) -> DVec3 {
        let left = self.compensation.as_ref().map_or(DVec3::ZERO, |[of_u, _]| vector_at(of_u, 3 * row));
        self.displacement(row) - left
    }

    /// Where `integrate` will take one of these nodes, from what its loads are by now.
    pub fn foresee(&self, coefficients: &IntegrationCoefficients<f64>, row: usize) -> Foreseen {
        let vector = |all: &[T]| vector_at(all, 3 * row);
        let force = self.external_force().map_or(DVec3::ZERO, vector) - vector(self.internal_force());
        let damping = self.damping().map_or(0.0, |all| all[row].to_f64());
        coefficients.foresee(self.inertia()[row].to_f64(), damping, self.axes()[row], vector(self.increments()), force)
    }

    /// Notes that one of these nodes goes farther (m) than contact between surfaces has foreseen when it counted what
    /// it takes, with `work_factor` for each joule.
    pub(crate) fn note_farther(&mut self, row: usize, farther: DVec3, work_factor: f64) {
        if let Some(Met { force, touch }) = &mut self.met {
            let given = 0.5 * work_factor * vector_at(force, 3 * row).dot(farther);
            let loss = &mut touch[MEETING_NUMBERS * row + 7];
            *loss = T::from_f64(loss.to_f64() - given);
        }
    }

    /// Adds to the load on one of these nodes (N), which a system may that has `&mut ExternalForce` among its
    /// [columns](crate::systems::NodeSystem::Columns).
    pub fn add_load(&mut self, row: usize, force: DVec3) {
        if let Some(external) = self.external_force_mut() {
            for (load, part) in external[3 * row..3 * row + 3].iter_mut().zip(force.to_array()) {
                *load = T::from_f64(load.to_f64() + part);
            }
        }
    }
}

impl<'a, T> NodeColumns<'a, T> {
    /// How many nodes.
    pub fn rows(&self) -> usize {
        self.axes.len()
    }

    /// Takes the first so many of them away.
    pub fn take(&mut self, rows: usize) -> Self {
        let places = 2 * self.places_until(rows);
        let until = self.first + rows;
        let taken = NodeColumns {
            first: self.first,
            rest: first(&mut self.rest, rows),
            element_force: self.element_force,
            non_finite: self.non_finite,
            undeclared: self.undeclared,
            declared: self.declared,
            mass: first(&mut self.mass, rows),
            inertia: first(&mut self.inertia, rows),
            internal: first_mut(&mut self.internal, 3 * rows),
            external: self.external.as_mut().map(|all| first_mut(all, 3 * rows)),
            axes: first(&mut self.axes, rows),
            damping: self.damping.as_mut().map(|all| first(all, rows)),
            u: first_mut(&mut self.u, 3 * rows),
            step: first_mut(&mut self.step, 3 * rows),
            compensation: self.compensation.as_mut().map(|both| both.each_mut().map(|all| first_mut(all, 3 * rows))),
            work: self.work.as_mut().map(|all| first_mut(all, WORK_NUMBERS * rows)),
            internal_work: first_mut(&mut self.internal_work, places),
            previous_prescribed: first_mut(&mut self.previous_prescribed, 3 * rows),
            touches: self.touches.as_mut().map(|all| all.take(until)),
            holds: self.holds.as_mut().map(|all| all.take(until)),
            met: self.met.as_mut().map(|all| all.take(rows)),
            own: self.own.take(rows),
        };
        self.first += rows;
        taken
    }

    /// Tasks of so many rows.
    pub fn tasks(self, rows: usize) -> Tasks<'a, T> {
        Tasks { rest: Some(self), rows }
    }

    /// Sums of work of the rows before one.
    fn places_until(&self, row: usize) -> usize {
        (self.first + row).div_ceil(GROUP_ROWS) - self.first.div_ceil(GROUP_ROWS)
    }

    /// The place to which the work of rows from `row` on is added: theirs, or the last of this task.
    pub(super) fn sum_of(&mut self, row: usize) -> Option<&mut [f32]> {
        let place = self.places_until(row).min((self.internal_work.len() / 2).checked_sub(1)?);
        Some(&mut self.internal_work[2 * place..2 * place + 2])
    }
}

/// Rows of a body in tasks: see [`NodeColumns::tasks`].
pub struct Tasks<'a, T> {
    /// None after the last.
    rest: Option<NodeColumns<'a, T>>,
    rows: usize,
}

impl<'a, T> Iterator for Tasks<'a, T> {
    type Item = NodeColumns<'a, T>;

    fn next(&mut self) -> Option<Self::Item> {
        match &mut self.rest {
            Some(rest) if rest.rows() > self.rows => Some(rest.take(self.rows)),
            last => last.take(),
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.rest.as_ref().map_or(0, |rest| rest.rows().div_ceil(self.rows).max(1));
        (left, Some(left))
    }
}

/// Takes the first so many away, if there are any.
pub(super) fn first<'a, X>(all: &mut &'a [X], count: usize) -> &'a [X] {
    let (taken, others) = all.split_at(count.min(all.len()));
    *all = others;
    taken
}

pub(super) fn first_mut<'a, X>(all: &mut &'a mut [X], count: usize) -> &'a mut [X] {
    let count = count.min(all.len());
    let (taken, others) = std::mem::take(all).split_at_mut(count);
    *all = others;
    taken
}

#[cfg(test)]
mod tests;
