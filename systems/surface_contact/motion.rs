//! How far surfaces have moved, and what that allows to leave as it is: points that are far sleep, lists that hold all
//! that is near serve on.

use super::body_slices::{BodySlices, vector};
use super::survey::MARGIN;
use super::{MeetingColumns, Surface, SurfaceContacts, crossings};
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::contact::{Finder, Lists, Point, Shortlist, Stays};
use crate::math::Scalar;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::ops::Range;
use std::time::Instant;

/// Rows between two of a surface that are looked at with them: a gap costs more than these.
const GAP: u32 = 16;

/// Triangles whose normals a task finds.
const TRIANGLES_A_TASK: usize = 1024;

/// How far nodes may move before shortlists are begun anew, in edges: at least and at most; and for how many steps of
/// the fastest node, between these.
const STAYS: [f64; 2] = [2e-3, 2e-2];
const STEPS_OF_SHORTLISTS: f64 = 20.0;

/// Numbers that are compared side by side: whole registers, and whole vectors.
const SIDE_BY_SIDE: usize = 24;

/// What rounding to f32 takes of a difference at most, and more.
const ROUNDING: f64 = 1e-6;

/// Where nodes were when the lists were made, and when shortlists were begun.
#[derive(Clone, Debug, Default)]
pub(super) struct Since {
    /// Bodies' numbers, and rows in which nodes of their surfaces are; few others are there.
    pub runs: Vec<(u32, Range<u32>)>,
    /// Displacements of these rows (m).
    lists: Option<Reals>,
    /// The same when shortlists were begun.
    shortlists: Option<Reals>,
}

/// How nodes have moved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moved {
    /// How far at most two have come nearer to each other since the lists were made (m).
    pub nearer: f64,
    /// The same since shortlists were begun, if they are.
    pub lately: Option<f64>,
    /// How far none has gone in the last step (m).
    pub step: f64,
}

impl Since {
    /// Of surfaces with these nodes: bodies' numbers and rows, both ascending.
    pub fn of(nodes: &[(u32, u32)]) -> Self {
        let mut runs: Vec<(u32, Range<u32>)> = Vec::new();
        for &(body, row) in nodes {
            match runs.last_mut().filter(|(other, rows)| *other == body && row < rows.end + GAP) {
                Some((_, rows)) => rows.end = row + 1,
                None => runs.push((body, row..row + 1)),
            }
        }
        Self { runs, lists: None, shortlists: None }
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        let of =
            |u: &Option<Reals>| u.as_ref().map_or(0, |u| u.len() * if u.precision() == Precision::F32 { 4 } else { 8 });
        size_of_val(&self.runs[..]) + of(&self.lists) + of(&self.shortlists)
    }
}

/// Remembers where the nodes of these rows are.
fn remember<T: Scalar>(runs: &[(u32, Range<u32>)], u: &mut Option<Reals>, bodies: &[BodySlices<'_, T>]) {
    let count = runs.iter().map(|(_, rows)| 3 * rows.len()).sum();
    let precision = if size_of::<T>() == 4 { Precision::F32 } else { Precision::F64 };
    if !u.as_ref().is_some_and(|u| u.len() == count && u.precision() == precision) {
        *u = None;
    }
    let mut left = u.get_or_insert_with(|| Reals::zeros(precision, count)).slice_mut::<T>();
    for (body, rows) in runs {
        let (of_run, others) = left.split_at_mut(3 * rows.len());
        of_run.copy_from_slice(&bodies[*body as usize].u[3 * rows.start as usize..3 * rows.end as usize]);
        left = others;
    }
}

/// The least and the largest of numbers along three axes, axis after axis.
#[derive(Clone, Copy)]
struct Extremes<T> {
    low: [T; SIDE_BY_SIDE],
    high: [T; SIDE_BY_SIDE],
}

impl<T: Scalar> Extremes<T> {
    fn none() -> Self {
        let far = T::from_f64(f64::from(f32::MAX));
        Self { low: [far; SIDE_BY_SIDE], high: [-far; SIDE_BY_SIDE] }
    }

    /// Sees as many numbers as there are, side by side at most. What is no number is not seen here; it is what guards
    /// look for.
    #[inline(always)]
    fn see(&mut self, numbers: &[T; SIDE_BY_SIDE], count: usize) {
        for i in 0..count {
            self.low[i] = if numbers[i] < self.low[i] { numbers[i] } else { self.low[i] };
            self.high[i] = if numbers[i] > self.high[i] { numbers[i] } else { self.high[i] };
        }
    }

    /// The largest distance between two vectors that were seen (m), and a little more.
    fn apart(&self) -> f64 {
        let along = |axis: usize, of: &[T; SIDE_BY_SIDE], better: fn(f64, f64) -> f64| {
            of.iter().skip(axis).step_by(3).map(|number| number.to_f64()).reduce(better).unwrap_or(0.0)
        };
        let apart = |axis: usize| (along(axis, &self.high, f64::max) - along(axis, &self.low, f64::min)).max(0.0);
        DVec3::new(apart(0), apart(1), apart(2)).length() * (1.0 + ROUNDING)
    }

    /// The longest vector that was seen is not longer than this (m).
    fn longest(&self) -> f64 {
        let both = self.low.iter().map(|number| -number.to_f64()).chain(self.high.iter().map(|number| number.to_f64()));
        both.fold(0.0, f64::max) * 3.0_f64.sqrt() * (1.0 + ROUNDING)
    }
}

/// What is seen of nodes: how they have moved since the lists were made and since shortlists were begun, and their last
/// steps.
struct Seen<T> {
    moved: [Extremes<T>; 2],
    steps: Extremes<T>,
}

/// The task of looking at a run: displacements now, those before, and steps.
struct See<'a, T>(&'a mut Seen<T>, &'a [T], [Option<&'a [T]>; 2], &'a [T]);

impl<T: Scalar> See<'_, T> {
    #[inline(always)]
    fn some(&mut self, at: usize, count: usize) {
        let of = |all: &[T]| {
            let mut numbers = [T::default(); SIDE_BY_SIDE];
            numbers[..count].copy_from_slice(&all[at..at + count]);
            numbers
        };
        let now = of(self.1);
        for (seen, then) in self.0.moved.iter_mut().zip(self.2) {
            let Some(then) = then.map(of) else { continue };
            let mut moved = now;
            (0..SIDE_BY_SIDE).for_each(|i| moved[i] = now[i] - then[i]);
            seen.see(&moved, count);
        }
        self.0.steps.see(&of(self.3), count);
    }
}

impl<T: Scalar> pulp::WithSimd for See<'_, T> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(mut self, _: S) {
        let whole = self.1.len() / SIDE_BY_SIDE * SIDE_BY_SIDE;
        (0..whole).step_by(SIDE_BY_SIDE).for_each(|at| self.some(at, SIDE_BY_SIDE));
        self.some(whole, self.1.len() - whole);
    }
}

/// How nodes have moved since the lists were made; `None` before there are any.
pub(super) fn moved<T: Scalar>(
    contacts: &SurfaceContacts,
    bodies: &Query<(Entity, MeetingColumns)>,
    cpu: &Cpu,
) -> Option<Moved> {
    let Since { runs, lists, shortlists } = &contacts.surface.since;
    let then = [Some(lists.as_ref()?.slice::<T>()), shortlists.as_ref().map(|u| u.slice::<T>())];
    let mut seen = Seen { moved: [Extremes::none(); 2], steps: Extremes::none() };
    let mut before = 0;
    for (body, rows) in runs {
        let (_, columns) = bodies.get(contacts.bodies[*body as usize]).ok()?;
        let range = 3 * rows.start as usize..3 * rows.end as usize;
        let of_run = then.map(|then| then.map(|then| &then[before..before + range.len()]));
        before += range.len();
        let [u, steps] = [&columns.nodes.u.0, &columns.nodes.step.0].map(|reals| &reals.slice::<T>()[range.clone()]);
        cpu.dispatch(See(&mut seen, u, of_run, steps));
    }
    let [nearer, lately] = seen.moved.map(|moved| moved.apart());
    Some(Moved { nearer, lately: shortlists.is_some().then_some(lately), step: seen.steps.longest() })
}

/// How far the fastest node of a surface went in the last step (m).
pub(super) fn largest_step<T: Scalar>(contacts: &SurfaceContacts, bodies: &[BodySlices<'_, T>]) -> f64 {
    let squares = |of_body: &[(u32, u32)]| {
        let steps = bodies[of_body[0].0 as usize].step;
        of_body.iter().map(|&(_, row)| vector(steps, row as usize).length_squared()).fold(0.0, f64::max)
    };
    contacts.surface.nodes.chunk_by(|a, b| a.0 == b.0).map(squares).fold(0.0, f64::max).sqrt()
}

/// How far faces must be looked at when the fastest node goes so far in a step (m).
pub(super) fn reach(contacts: &SurfaceContacts, largest: f64) -> f64 {
    4.0 * largest + MARGIN * contacts.edge
}

/// Sees where some nodes are.
fn place<T: Scalar>(contacts: &mut SurfaceContacts, bodies: &[BodySlices<'_, T>], of: Option<&[u32]>) {
    let SurfaceContacts { surface, reference, .. } = contacts;
    let (nodes, places) = (&surface.nodes, &mut surface.places);
    let place = |node: usize| {
        let (body, row) = nodes[node];
        let (of_body, row) = (&bodies[body as usize], row as usize);
        of_body.rest[row] - *reference + vector(of_body.u, row)
    };
    match of {
        Some(some) => some.iter().for_each(|&node| places[node as usize] = place(node as usize)),
        None => places.iter_mut().enumerate().for_each(|(node, at)| *at = place(node)),
    }
}

/// Makes the lists anew where they may not hold all that is within `reach` (m) and thickness; gives how far nodes have
/// moved since they were made (m).
pub(super) fn search<T: Scalar>(
    contacts: &mut SurfaceContacts,
    bodies: &[BodySlices<'_, T>],
    (reach, moved): (f64, Option<Moved>),
    cpu: &Cpu,
) -> f64 {
    let farthest = contacts.farthest(reach);
    // what is no number is no bound
    if let Some(moved) = moved.filter(|moved| farthest + moved.nearer <= contacts.surface.lists.radius) {
        return moved.nearer;
    }
    let started = Instant::now();
    place(contacts, bodies, None);
    let mut trees = std::mem::take(&mut contacts.surface.trees);
    let meets = |point: u32, face: u32, of_face: bool| contacts.meets(point, face, of_face);
    let Surface { triangles, points, places, apart, .. } = &contacts.surface;
    trees.iter_mut().for_each(|tree| tree.refit(|number| triangles.corners(places, number)));
    let finder = Finder { surfaces: triangles, points, meets: &meets, apart };
    // reach is four steps of the fastest and a little: of what is fast lists serve some steps, too
    let skin = contacts.skin * (contacts.edge + 40.0 * reach).min(4.0 * contacts.edge);
    let lists = Lists::find(&finder, &trees, places, farthest + skin, cpu);
    let listed = lists.points.iter().map(|&point| points[point as usize]);
    let listed: Vec<Point> = listed.collect();
    (contacts.surface.trees, contacts.surface.lists) = (trees, lists);
    crossings::list(contacts, farthest + skin);
    let surface = &mut contacts.surface;
    let among: Vec<u32> = surface.lists.triangles.iter().copied().chain(surface.crossings.triangles()).collect();
    let near = surface.triangles.neighbourhood(listed.into_iter(), &among);
    surface.wake.clear();
    surface.wake.resize(surface.lists.points.len(), 0.0);
    surface.near = near;
    let Since { runs, lists, .. } = &mut surface.since;
    remember(runs, lists, bodies);
    // they are begun when somebody looks
    surface.shortlists.clear();
    surface.figures.builds += 1;
    surface.figures.building += started.elapsed();
    0.0
}

/// Begins shortlists anew where nodes have moved farther than these allow for, or faces are looked at that are farther
/// away; gives how far nodes have moved since then (m).
pub(super) fn follow_shortlists<T: Scalar>(
    contacts: &mut SurfaceContacts,
    bodies: &[BodySlices<'_, T>],
    (reach, largest): (f64, f64),
    moved: Option<Moved>,
) -> f64 {
    let edge = contacts.edge;
    let Surface { since, shortlists, stays, lists, .. } = &mut contacts.surface;
    let begun = !shortlists.is_empty() && reach <= stays.reach;
    // what is no number is no bound
    if let Some(lately) = moved.and_then(|moved| moved.lately).filter(|&lately| begun && lately <= stays.moved) {
        return lately;
    }
    remember(&since.runs, &mut since.shortlists, bodies);
    shortlists.clear();
    shortlists.resize(lists.points.len(), Shortlist::UNKNOWN);
    let moved = (STEPS_OF_SHORTLISTS * largest).clamp(STAYS[0] * edge, STAYS[1] * edge);
    *stays = Stays { moved, reach: 2.0 * reach };
    0.0
}

/// Sees where the nodes are that are near something, and which way triangles look.
pub(super) fn update_places<T: Scalar>(contacts: &mut SurfaceContacts, bodies: &[BodySlices<'_, T>], cpu: &Cpu) {
    let near = std::mem::take(&mut contacts.surface.near);
    place(contacts, bodies, Some(&near.nodes));
    let Surface { triangles, places, normals, fresh, .. } = &mut contacts.surface;
    fresh.resize(near.triangles.len(), DVec3::ZERO);
    let tasks = fresh.chunks_mut(TRIANGLES_A_TASK).zip(near.triangles.chunks(TRIANGLES_A_TASK));
    cpu.for_each(tasks, |(fresh, numbers)| {
        fresh.iter_mut().zip(numbers).for_each(|(normal, &number)| *normal = triangles.normal(places, number));
    });
    near.triangles.iter().zip(&*fresh).for_each(|(&number, normal)| normals[number as usize] = *normal);
    contacts.surface.near = near;
}
