//! How far surfaces have moved: at most what the steps of their nodes add up to, and now and then what it really is.

use super::body_slices::{BodySlices, vector};
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::math::{Extremes, ROUNDING, Scalar, See};
use glam::DVec3;
use std::ops::Range;

/// Steps that are added up before it is looked where nodes are.
const STEPS_ADDED_UP: u32 = 64;

/// Where nodes were at some time, and how far they have moved since.
#[derive(Clone, Debug)]
pub(super) struct Mark {
    /// Displacements of the rows that are looked at (m); `None` before that time.
    u: Option<Reals>,
    /// How far at most two nodes have come nearer to each other since (m).
    pub moved: f64,
}

impl Default for Mark {
    fn default() -> Self {
        Self { u: None, moved: f64::INFINITY }
    }
}

/// How the nodes of surfaces move.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion {
    /// Bodies' numbers, and rows in which nodes of their surfaces are, and no others: what is found must not depend on
    /// what rows are beside them.
    runs: Vec<(u32, Range<u32>)>,
    /// Since the lists were made.
    pub lists: Mark,
    /// Since shortlists were begun.
    pub shortlists: Mark,
    /// How far two nodes have gone against each other at most, step by step since some time (m); infinite where
    /// displacements are not what steps make of them.
    pub gone: f64,
    /// How far the fastest node went in the last step, at most (m).
    pub largest: f64,
    /// How far nodes went in it, at least and at most, along each axis (m).
    last: [DVec3; 2],
    /// Steps since it was looked where nodes are, and what rounding may have added to each (m).
    added_up: u32,
    rounding: f64,
    /// Where one node of each run of rows was last (m), and how long a step was (s): who writes other displacements
    /// than steps make is seen there.
    watched: Vec<DVec3>,
    time_step: f64,
}

/// Displacements of a body by its number, and the last steps (m).
pub(super) trait Moving<'a, T: Scalar>: Fn(u32) -> Option<[&'a [T]; 2]> {}
impl<'a, T: Scalar, F: Fn(u32) -> Option<[&'a [T]; 2]>> Moving<'a, T> for F {}

impl Motion {
    /// Of surfaces with these nodes: bodies' numbers and rows, both ascending.
    pub fn of(nodes: &[(u32, u32)]) -> Self {
        let mut runs: Vec<(u32, Range<u32>)> = Vec::new();
        for &(body, row) in nodes {
            match runs.last_mut().filter(|(other, rows)| *other == body && row == rows.end) {
                Some((_, rows)) => rows.end = row + 1,
                None => runs.push((body, row..row + 1)),
            }
        }
        Self { runs, ..Self::default() }
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        let of =
            |mark: &Mark| mark.u.as_ref().map_or(0, |u| u.len() * if u.precision() == Precision::F32 { 4 } else { 8 });
        let marks = of(&self.lists) + of(&self.shortlists);
        size_of_val(&self.runs[..]) + size_of_val(&self.watched[..]) + marks
    }

    /// Notes that the lists are made, with nodes where they are.
    pub fn mark_lists<T: Scalar>(&mut self, bodies: &[BodySlices<'_, T>]) {
        self.lists.set(&self.runs, bodies);
    }

    /// Notes that shortlists are begun, likewise.
    pub fn mark_shortlists<T: Scalar>(&mut self, bodies: &[BodySlices<'_, T>]) {
        self.shortlists.set(&self.runs, bodies);
    }

    /// Takes the last step into account: nodes have come nearer by what they went apart in it, at most. Along axes that
    /// are told `boundary` has written the next step over that one, which was seen when it was the next. Where
    /// displacements are not what steps make of them (on the way to equilibrium, in implicit steps, after a change
    /// of the step, where somebody else has written them), or many steps have been added up, it is looked where
    /// nodes are.
    pub fn follow<'a, T: Scalar>(&mut self, moving: &impl Moving<'a, T>, clock: &Clock, cpu: &Cpu) {
        let mut steps = Extremes::none();
        let mut as_stepped = self.watched.len() == self.runs.len();
        as_stepped &= clock.relaxation.is_none() && clock.springs.is_none() && clock.time_step == self.time_step;
        self.time_step = clock.time_step;
        self.watched.resize(self.runs.len(), DVec3::NAN);
        let mut before = self.watched.iter_mut();
        for runs in self.runs.chunk_by(|a, b| a.0 == b.0) {
            let Some([u, step]) = moving(runs[0].0) else { continue };
            for ((_, rows), before) in runs.iter().zip(&mut before) {
                cpu.dispatch(See { seen: &mut steps, now: &step[numbers(rows)], then: None });
                let [now, went] = [u, step].map(|all| vector(all, rows.start as usize));
                let size = ROUNDING * ROUNDING * (before.length_squared() + now.length_squared());
                as_stepped &= now.distance_squared(*before + went) <= size;
                *before = now;
            }
        }
        self.largest = steps.longest();
        self.added_up += 1;
        let seen = std::mem::replace(&mut self.last, steps.bounds());
        let apart = apart(seen, self.last) + self.rounding;
        self.lists.moved += apart;
        self.shortlists.moved += apart;
        self.gone = if as_stepped { self.gone + apart } else { f64::INFINITY };
        if !as_stepped || self.added_up >= STEPS_ADDED_UP {
            self.look(moving, cpu);
        }
    }

    /// Looks where nodes are.
    pub fn look<'a, T: Scalar>(&mut self, moving: &impl Moving<'a, T>, cpu: &Cpu) {
        let see = |then: Option<&[T]>| {
            let (mut seen, mut before) = (Extremes::none(), 0);
            for (body, rows) in &self.runs {
                let then = then.map(|then| &then[before..before + 3 * rows.len()]);
                before += 3 * rows.len();
                let Some([u, _]) = moving(*body) else { continue };
                cpu.dispatch(See { seen: &mut seen, now: &u[numbers(rows)], then });
            }
            seen
        };
        let moved = [&self.lists, &self.shortlists].map(|mark| Some(see(Some(mark.u.as_ref()?.slice::<T>())).apart()));
        // each step rounds the displacements of both nodes
        let epsilon = if size_of::<T>() == 4 { f64::from(f32::EPSILON) } else { f64::EPSILON };
        let farthest = see(None).longest() + f64::from(STEPS_ADDED_UP) * self.largest;
        (self.added_up, self.rounding) = (0, 2.0 * epsilon * farthest);
        for (mark, moved) in [&mut self.lists, &mut self.shortlists].into_iter().zip(moved) {
            mark.moved = moved.unwrap_or(f64::INFINITY);
        }
    }
}

impl Mark {
    fn set<T: Scalar>(&mut self, runs: &[(u32, Range<u32>)], bodies: &[BodySlices<'_, T>]) {
        let count = runs.iter().map(|(_, rows)| 3 * rows.len()).sum();
        let precision = if size_of::<T>() == 4 { Precision::F32 } else { Precision::F64 };
        if !self.u.as_ref().is_some_and(|u| u.len() == count && u.precision() == precision) {
            self.u = None;
        }
        let mut left = self.u.get_or_insert_with(|| Reals::zeros(precision, count)).slice_mut::<T>();
        for (body, rows) in runs {
            let (of_run, others) = left.split_at_mut(3 * rows.len());
            of_run.copy_from_slice(&bodies[*body as usize].u[numbers(rows)]);
            left = others;
        }
        self.moved = 0.0;
    }
}

/// How far apart vectors are at most that lie within any of two boxes, and a little more.
fn apart([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> f64 {
    (b.max(d) - a.min(c)).length() * (1.0 + ROUNDING)
}

/// The numbers of vectors in these rows.
fn numbers(rows: &Range<u32>) -> Range<usize> {
    3 * rows.start as usize..3 * rows.end as usize
}

#[cfg(test)]
mod tests;
