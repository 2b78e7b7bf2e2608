//! How far surfaces have moved, and what that allows to leave as it is: points that are far sleep, lists that hold all
//! that is near serve on.

use super::body_slices::{BodySlices, vector};
use super::survey::MARGIN;
use super::{MeetingColumns, Surface, SurfaceContacts, crossings};
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::contact::{Finder, Lists, Point};
use crate::math::Scalar;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::ops::Range;
use std::time::Instant;

/// Rows between two of a surface that are looked at with them: a gap costs more than these.
const GAP: u32 = 16;

/// Triangles whose normals a task finds.
const TRIANGLES_A_TASK: usize = 1024;

/// Numbers that are compared side by side: whole registers, and whole vectors.
const SIDE_BY_SIDE: usize = 24;

/// What rounding to f32 takes of a difference at most, and more.
const ROUNDING: f64 = 1e-6;

/// Where nodes were when the lists were made.
#[derive(Clone, Debug, Default)]
pub(super) struct Since {
    /// Bodies' numbers, and rows in which nodes of their surfaces are; few others are there.
    pub runs: Vec<(u32, Range<u32>)>,
    /// Displacements of these rows (m).
    u: Option<Reals>,
}

/// How nodes have moved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moved {
    /// How far at most two have come nearer to each other since the lists were made (m).
    pub nearer: f64,
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
        Self { runs, u: None }
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        let u = self.u.as_ref().map_or(0, |u| u.len() * if u.precision() == Precision::F32 { 4 } else { 8 });
        size_of_val(&self.runs[..]) + u
    }

    /// Remembers where nodes are.
    fn begin<T: Scalar>(&mut self, bodies: &[BodySlices<'_, T>]) {
        let count = self.runs.iter().map(|(_, rows)| 3 * rows.len()).sum();
        let precision = if size_of::<T>() == 4 { Precision::F32 } else { Precision::F64 };
        let u = match self.u.as_mut().filter(|u| u.len() == count && u.precision() == precision) {
            Some(u) => u,
            None => self.u.insert(Reals::zeros(precision, count)),
        };
        let mut left = u.slice_mut::<T>();
        for (body, rows) in &self.runs {
            let (of_run, others) = left.split_at_mut(3 * rows.len());
            of_run.copy_from_slice(&bodies[*body as usize].u[3 * rows.start as usize..3 * rows.end as usize]);
            left = others;
        }
    }
}

/// The least and the largest of numbers along three axes, axis after axis.
struct Extremes<T> {
    low: [T; SIDE_BY_SIDE],
    high: [T; SIDE_BY_SIDE],
    largest: [T; SIDE_BY_SIDE],
}

impl<T: Scalar> Extremes<T> {
    /// Looks at displacements, those before, and steps: whole vectors. What is no number is not seen here; it is what
    /// guards look for.
    #[inline(always)]
    fn see(&mut self, now: &[T], then: &[T], steps: &[T]) {
        let all = now.chunks(SIDE_BY_SIDE).zip(then.chunks(SIDE_BY_SIDE)).zip(steps.chunks(SIDE_BY_SIDE));
        for ((now, then), steps) in all {
            match (
                <&[T; SIDE_BY_SIDE]>::try_from(now),
                <&[T; SIDE_BY_SIDE]>::try_from(then),
                <&[T; SIDE_BY_SIDE]>::try_from(steps),
            ) {
                (Ok(now), Ok(then), Ok(steps)) => {
                    (0..SIDE_BY_SIDE).for_each(|i| self.one(i, now[i] - then[i], steps[i]))
                }
                _ => (0..now.len()).for_each(|i| self.one(i, now[i] - then[i], steps[i])),
            }
        }
    }

    #[inline(always)]
    fn one(&mut self, i: usize, moved: T, step: T) {
        self.low[i] = if moved < self.low[i] { moved } else { self.low[i] };
        self.high[i] = if moved > self.high[i] { moved } else { self.high[i] };
        let size = if step < T::default() { -step } else { step };
        self.largest[i] = if size > self.largest[i] { size } else { self.largest[i] };
    }
}

/// The task of looking at all runs, with the machine's registers.
struct See<'a, T>(&'a mut Extremes<T>, &'a [T], &'a [T], &'a [T]);

impl<T: Scalar> pulp::WithSimd for See<'_, T> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.0.see(self.1, self.2, self.3);
    }
}

/// How nodes have moved since the lists were made; `None` before there are any.
pub(super) fn moved<T: Scalar>(
    contacts: &SurfaceContacts,
    bodies: &Query<(Entity, MeetingColumns)>,
    cpu: &Cpu,
) -> Option<Moved> {
    let Since { runs, u } = &contacts.surface.since;
    let mut then = u.as_ref()?.slice::<T>();
    let (far, none) = (T::from_f64(f64::from(f32::MAX)), T::default());
    let [low, high] = [far, -far].map(|value| [value; SIDE_BY_SIDE]);
    let mut seen = Extremes { low, high, largest: [none; SIDE_BY_SIDE] };
    for (body, rows) in runs {
        let (_, columns) = bodies.get(contacts.bodies[*body as usize]).ok()?;
        let range = 3 * rows.start as usize..3 * rows.end as usize;
        let (of_run, others) = then.split_at(range.len());
        let [u, steps] = [&columns.nodes.u.0, &columns.nodes.step.0].map(|reals| &reals.slice::<T>()[range.clone()]);
        cpu.dispatch(See(&mut seen, u, of_run, steps));
        then = others;
    }
    let along = |axis: usize, of: &[T; SIDE_BY_SIDE], better: fn(f64, f64) -> f64| {
        of.iter().skip(axis).step_by(3).map(|number| number.to_f64()).reduce(better).unwrap_or(0.0)
    };
    let apart = |axis: usize| (along(axis, &seen.high, f64::max) - along(axis, &seen.low, f64::min)).max(0.0);
    let longest = seen.largest.iter().map(|number| number.to_f64()).fold(0.0, f64::max);
    let nearer = DVec3::new(apart(0), apart(1), apart(2)).length();
    Some(Moved { nearer: nearer * (1.0 + ROUNDING), step: longest * 3.0_f64.sqrt() * (1.0 + ROUNDING) })
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
    surface.since.begin(bodies);
    surface.figures.builds += 1;
    surface.figures.building += started.elapsed();
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
