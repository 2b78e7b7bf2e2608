//! Neighbouring systems of a step that work node by node, in one pass over the nodes: what one writes the next finds in the
//! core's cache. On a GPU the same is one kernel (src/backend/node_stage.rs).

use super::registry::HostSystem;
use super::{boundary, gather, gravity, nodal_force, traction};
use crate::backend::cpu::{Cpu, Factors, NodeColumns, ROWS_A_TASK, move_nodes};
use crate::backend::step::step_number;
use crate::components::*;
use crate::error::Error;
use crate::math::SimdScalar;
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use bevy_ecs::system::IntoSystem;
use std::sync::atomic::{AtomicU32, Ordering};

/// What nodes have, and what the last system of a pass, `integrate`, moves.
#[derive(QueryData)]
#[query_data(mutable)]
pub(super) struct BodyColumns {
    body: Entity,
    mass: &'static Mass,
    fictitious: Option<&'static FictitiousMass>,
    internal: &'static mut InternalForce,
    external: Option<&'static mut ExternalForce>,
    axes: &'static ConstrainedAxes,
    damping: Option<&'static DampingCoefficient>,
    u: &'static mut Displacement,
    step: &'static mut DisplacementStep,
    compensation: Option<&'static mut DisplacementCompensation>,
    work: Option<&'static mut Work>,
    noticed: &'static mut FirstNonFinite,
}

/// Some rows of a body's columns, which no other task has.
pub(super) struct Rows<'a, T> {
    /// The first of them.
    pub first: usize,
    pub mass: &'a [T],
    pub inertia: &'a [T],
    pub internal: &'a mut [T],
    pub external: Option<&'a mut [T]>,
    pub axes: &'a [u32],
    pub damping: Option<&'a [T]>,
    pub u: &'a mut [T],
    pub step: &'a mut [T],
    /// Of displacements, and of steps.
    pub compensation: Option<[&'a mut [T]; 2]>,
    pub work: Option<&'a mut [T]>,
    pub sums: &'a mut [u32],
    pub kept: &'a mut [u32],
}

impl<'a, T> Rows<'a, T> {
    /// The first of them (a multiple of [`SPENT_ROWS`]), and the others.
    fn split(self, at: usize) -> (Self, Self) {
        let (mass, inertia, axes) = (self.mass.split_at(at), self.inertia.split_at(at), self.axes.split_at(at));
        let damping = self.damping.map(|all| all.split_at(at)).unzip();
        let internal = self.internal.split_at_mut(3 * at);
        let external = self.external.map(|all| all.split_at_mut(3 * at)).unzip();
        let (u, step) = (self.u.split_at_mut(3 * at), self.step.split_at_mut(3 * at));
        let compensation = self.compensation.map(|[of_u, of_step]| {
            let (of_u, of_step) = (of_u.split_at_mut(3 * at), of_step.split_at_mut(3 * at));
            ([of_u.0, of_step.0], [of_u.1, of_step.1])
        });
        let compensation = compensation.unzip();
        let work = self.work.map(|all| all.split_at_mut(WORK_NUMBERS * at)).unzip();
        let sums = self.sums.split_at_mut(self.sums.len().min(2 * at / SPENT_ROWS));
        let kept = self.kept.split_at_mut(self.kept.len().min(3 * at));
        macro_rules! part {
            ($number:tt, $first:expr) => {
                Rows {
                    first: $first,
                    mass: mass.$number,
                    inertia: inertia.$number,
                    internal: internal.$number,
                    external: external.$number,
                    axes: axes.$number,
                    damping: damping.$number,
                    u: u.$number,
                    step: step.$number,
                    compensation: compensation.$number,
                    work: work.$number,
                    sums: sums.$number,
                    kept: kept.$number,
                }
            };
        }
        (part!(0, self.first), part!(1, self.first + at))
    }

    /// Tasks of so many rows.
    fn tasks(mut self, rows: usize) -> Vec<Self> {
        let mut tasks = Vec::with_capacity(self.axes.len().div_ceil(rows));
        while self.axes.len() > rows {
            let (task, others) = self.split(rows);
            tasks.push(task);
            self = others;
        }
        tasks.push(self);
        tasks
    }
}

/// Something done to rows, in either precision.
pub(super) trait OnRows: Sync {
    fn on_rows<T: SimdScalar>(&self, rows: &mut Rows<'_, T>);
}

/// Takes all rows of a body through `before` and moves them, a task's rows at a time.
pub(super) fn pass_over(cpu: &Cpu, clock: &Clock, columns: BodyColumnsItem<'_, '_>, before: &impl OnRows) {
    let nodes = columns.axes.len();
    let BodyColumnsItem { mass, fictitious, axes, damping, mut internal, external, .. } = columns;
    let (mut u, mut step, mut noticed) = (columns.u, columns.step, columns.noticed);
    let inertia = fictitious.map_or(&mass.0, |fictitious| &fictitious.0);
    let external = external.map(|e| e.into_inner());
    let compensation = columns.compensation.map(|c| c.into_inner());
    let work = columns.work.map(|w| w.into_inner());
    // two words only where all work is booked
    let noted = noticed.0.len().min(SPENT_AT);
    let (found, words) = noticed.0.split_at_mut(noted);
    let (sums, kept) = words.split_at_mut(words.len().min(before_at(nodes) - SPENT_AT));
    macro_rules! run {
        ($internal:ident, $u:ident, $step:ident) => {{
            let rows = Rows {
                first: 0,
                mass: mass.slice(),
                inertia: inertia.slice(),
                internal: $internal,
                external: external.map(|e| e.slice_mut()),
                axes,
                damping: damping.map(|d| d.slice()),
                u: $u,
                step: $step,
                compensation: compensation.map(|c| c.0.slice_mut().split_at_mut(3 * nodes).into()),
                work: work.map(|w| w.0.slice_mut()),
                sums,
                kept,
            };
            move_rows(cpu, clock, rows, before)
        }};
    }
    let bad = match (&mut internal.0, &mut u.0, &mut step.0) {
        (Reals::F32(internal), Reals::F32(u), Reals::F32(step)) => run!(internal, u, step),
        (Reals::F64(internal), Reals::F64(u), Reals::F64(step)) => run!(internal, u, step),
        _ => None,
    };
    if let (Some(bad), u32::MAX) = (bad, found[0]) {
        (found[0], found[1]) = (bad, step_number(clock));
    }
}

/// Returns the lowest row whose displacement is no longer finite.
fn move_rows<T: SimdScalar>(cpu: &Cpu, clock: &Clock, rows: Rows<'_, T>, before: &impl OnRows) -> Option<u32> {
    let bad = AtomicU32::new(u32::MAX);
    let factors = Factors::of(clock);
    cpu.for_each(rows.tasks(ROWS_A_TASK).into_iter(), |mut rows| {
        before.on_rows(&mut rows);
        let columns = NodeColumns {
            first: rows.first,
            mass: rows.inertia,
            internal: rows.internal,
            external: rows.external.as_deref(),
            axes: rows.axes,
            damping: rows.damping,
            u: rows.u,
            step: rows.step,
            compensation: rows.compensation,
            work: rows.work,
            sums: rows.sums,
            kept: rows.kept,
        };
        if let Some(row) = move_nodes(cpu, columns, &factors) {
            bad.fetch_min(row, Ordering::Relaxed);
        }
    });
    Some(bad.into_inner()).filter(|&row| row != u32::MAX)
}

/// Nothing.
impl OnRows for () {
    fn on_rows<T: SimdScalar>(&self, _: &mut Rows<'_, T>) {}
}

/// The systems that a pass can hold, in whatever order the phases allow; it must hold the first and the last.
const OF_A_PASS: [&str; 6] = ["gather", "gravity", "nodal_force", "traction", "boundary", "integrate"];

/// Whether these systems, which follow one another in a step, can be one pass on the CPU.
pub(crate) fn is_a_pass(systems: &[&str]) -> bool {
    let ends = ["gather", "integrate"].iter().all(|end| systems.contains(end));
    ends && systems.iter().all(|system| OF_A_PASS.contains(system))
}

/// What a pass does to the rows of a body before it moves them.
struct Before<'a> {
    corners: Option<&'a Corners>,
    force: Option<&'a ElementForce>,
    loads: Vec<RowLoad<'a>>,
    motions: Vec<(&'a Prescribed, &'a [[f64; 4]])>,
}

enum RowLoad<'a> {
    Gravity([f64; 4]),
    NodalForce(&'a NodalForce, [f64; 4]),
    Traction(&'a Traction, [f64; 4]),
}

impl OnRows for Before<'_> {
    fn on_rows<T: SimdScalar>(&self, rows: &mut Rows<'_, T>) {
        let first = rows.first;
        if let (Some(corners), Some(force)) = (self.corners, self.force) {
            gather::sum_at(corners, force.slice(), first, rows.internal);
        }
        if let Some(external) = rows.external.as_deref_mut() {
            external.fill(T::default());
            for load in &self.loads {
                match load {
                    RowLoad::Gravity(acceleration) => gravity::pull(rows.mass, *acceleration, external),
                    RowLoad::NodalForce(load, force) => {
                        nodal_force::push(load, *force, first, rows.mass, external);
                    }
                    RowLoad::Traction(load, traction) => traction::pull(&load.faces, *traction, first, external),
                }
            }
        }
        for (set, motion) in &self.motions {
            boundary::move_rows(
                set,
                motion,
                first,
                rows.u,
                rows.compensation.as_ref().map(|[of_u, _]| &**of_u),
                rows.step,
                rows.kept,
            );
        }
    }
}

/// Several systems as one, in their order.
pub(crate) fn node_pass(systems: Vec<String>) -> HostSystem {
    type OfBodies<'w, 's, C> = Query<'w, 's, (&'static C, &'static OfBody)>;
    let pass = move |cpu: Res<Cpu>,
                     clock: Res<Clock>,
                     signals: Res<Signals>,
                     mut bodies: Query<(BodyColumns, Option<&Corners>, Option<&ElementForce>)>,
                     gravities: OfBodies<Gravity>,
                     forces: OfBodies<NodalForce>,
                     tractions: OfBodies<Traction>,
                     prescribed: OfBodies<Prescribed>|
          -> Result<(), Error> {
        let values = signals.values();
        for (columns, corners, force) in &mut bodies {
            let body = columns.body;
            let mut before = Before { corners, force, loads: Vec::new(), motions: Vec::new() };
            for system in &systems {
                match system.as_str() {
                    "gravity" => {
                        let own = gravities.iter().filter(|(_, of)| of.0 == body);
                        before.loads.extend(own.map(|(load, _)| RowLoad::Gravity(values[load.signal])));
                    }
                    "nodal_force" => {
                        let own = forces.iter().filter(|(_, of)| of.0 == body);
                        before.loads.extend(own.map(|(load, _)| RowLoad::NodalForce(load, values[load.signal])));
                    }
                    "traction" => {
                        let own = tractions.iter().filter(|(_, of)| of.0 == body);
                        before.loads.extend(own.map(|(load, _)| RowLoad::Traction(load, values[load.signal])));
                    }
                    "boundary" => {
                        let own = prescribed.iter().filter(|(_, of)| of.0 == body);
                        before.motions.extend(own.map(|(set, _)| (set, &values[set.signal..set.signal + 3])));
                    }
                    _ => {}
                }
            }
            pass_over(&cpu, &clock, columns, &before);
        }
        Ok(())
    };
    Box::new(IntoSystem::into_system(pass))
}
