//! Neighbouring systems of a step that work node by node, in one pass over the nodes: what one writes the next finds in the
//! core's cache. On a GPU the same is one kernel (src/backend/node_stage.rs).

use super::registry::HostSystem;
use super::{boundary, gather, gravity, nodal_force, pressure, traction};
use crate::backend::cpu::{Cpu, Factors, NodeColumns, ROWS_A_TASK, move_nodes};
use crate::backend::step::step_number;
use crate::components::*;
use crate::error::Error;
use crate::math::SimdScalar;
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use bevy_ecs::system::{IntoSystem, SystemParam};
use std::sync::atomic::{AtomicU32, Ordering};

/// What nodes have, and what the last system of a pass, `integrate`, moves.
#[derive(QueryData)]
#[query_data(mutable)]
pub(super) struct BodyColumns {
    body: Entity,
    rest: &'static RestPosition,
    mass: &'static Mass,
    fictitious: Option<&'static FictitiousMass>,
    internal: &'static mut InternalForce,
    external: Option<&'static mut ExternalForce>,
    axes: &'static ConstrainedAxes,
    damping: Option<&'static DampingCoefficient>,
    pub(super) u: &'static mut Displacement,
    step: &'static mut DisplacementStep,
    compensation: Option<&'static mut DisplacementCompensation>,
    work: Option<&'static mut Work>,
    first_non_finite: &'static mut FirstNonFinite,
    internal_work: Option<&'static mut InternalWork>,
    previous_prescribed: Option<&'static mut PreviousPrescribedStep>,
}

impl BodyColumnsItem<'_, '_> {
    /// All rows, in the run's precision.
    pub(super) fn columns<T: SimdScalar>(&mut self) -> NodeColumns<'_, T> {
        let nodes = self.axes.len();
        NodeColumns {
            first: 0,
            mass: self.mass.slice(),
            inertia: self.fictitious.map_or(self.mass.slice(), |fictitious| fictitious.slice()),
            internal: self.internal.slice_mut(),
            external: self.external.as_mut().map(|e| e.slice_mut()),
            axes: self.axes,
            damping: self.damping.map(|d| d.slice()),
            u: self.u.slice_mut(),
            step: self.step.slice_mut(),
            compensation: self.compensation.as_mut().map(|c| c.slice_mut().split_at_mut(3 * nodes).into()),
            work: self.work.as_mut().map(|w| w.slice_mut()),
            internal_work: self.internal_work.as_mut().map_or(&mut [], |work| work.as_mut_slice()),
            previous_prescribed: self.previous_prescribed.as_mut().map_or(&mut [], |step| step.as_mut_slice()),
        }
    }

    /// Notes the lowest row of a node whose displacement is no longer finite; `u32::MAX`: none.
    pub(super) fn note_astray(&mut self, row: u32, clock: &Clock) {
        if row != u32::MAX && self.first_non_finite[0] == u32::MAX {
            self.first_non_finite.copy_from_slice(&[row, step_number(clock)]);
        }
    }
}

/// Takes nodes through `before` and moves them, a task's rows at a time; without `observed` their forces go nowhere else. Returns the
/// lowest row whose displacement is no longer finite; `u32::MAX`: none.
pub(super) fn move_rows<T: SimdScalar>(
    cpu: &Cpu,
    factors: &Factors<T>,
    observed: bool,
    tasks: Vec<NodeColumns<'_, T>>,
    before: impl Fn(&mut NodeColumns<'_, T>) + Sync + Send,
) -> u32 {
    let astray = AtomicU32::new(u32::MAX);
    cpu.for_each(tasks.into_iter(), |mut rows| {
        rows.with_forces(observed, |rows| {
            before(rows);
            if let Some(row) = move_nodes(cpu, rows, factors) {
                astray.fetch_min(row, Ordering::Relaxed);
            }
        });
    });
    astray.into_inner()
}

/// Moves all nodes of a body, which each sums its forces first, where it does, and takes what acts on it.
pub(super) fn move_body(
    cpu: &Cpu,
    (clock, observed): (&Clock, bool),
    body: &mut BodyColumnsItem<'_, '_>,
    gather: Option<(&Corners, &ElementForce)>,
    on_rows: Option<&OnRows<'_>>,
) {
    let astray = match body.u.precision() {
        Precision::F32 => move_all::<f32>(cpu, (clock, observed), body, gather, on_rows),
        Precision::F64 => move_all::<f64>(cpu, (clock, observed), body, gather, on_rows),
    };
    body.note_astray(astray, clock);
}

fn move_all<T: SimdScalar>(
    cpu: &Cpu,
    (clock, observed): (&Clock, bool),
    body: &mut BodyColumnsItem<'_, '_>,
    gather: Option<(&Corners, &ElementForce)>,
    on_rows: Option<&OnRows<'_>>,
) -> u32 {
    let tasks = body.columns::<T>().tasks(ROWS_A_TASK);
    move_rows(cpu, &Factors::of(clock), observed, tasks, |rows| {
        if let Some((corners, force)) = gather {
            gather::sum_at(corners, force.slice(), rows.first, rows.internal);
        }
        if let Some(on_rows) = on_rows {
            on_rows.act(cpu, rows);
        }
    })
}

/// The systems that a pass can hold, in whatever order the phases allow; it must hold the first and the last.
const OF_A_PASS: [&str; 7] = ["gather", "gravity", "nodal_force", "pressure", "traction", "boundary", "integrate"];

/// Whether these systems, which follow one another in a step, can be one pass on the CPU.
pub(crate) fn is_a_pass(systems: &[&str]) -> bool {
    let ends = ["gather", "integrate"].iter().all(|end| systems.contains(end));
    ends && systems.iter().all(|system| OF_A_PASS.contains(system))
}

/// Loads and motions of a body, for some of its rows at a time.
#[derive(Default)]
pub(super) struct OnRows<'a> {
    loads: Vec<RowLoad<'a>>,
    motions: Vec<(&'a Prescribed, &'a [[f64; 4]])>,
}

enum RowLoad<'a> {
    Gravity([f64; 4]),
    NodalForce(&'a NodalForce, [f64; 4]),
    /// With the areas of its faces as they are at the beginning of the pass.
    Pressure(&'a Pressure, f64, Reals),
    Traction(&'a Traction, [f64; 4]),
}

impl OnRows<'_> {
    /// Sums the loads afresh, and says where constrained nodes go.
    pub(super) fn act<T: SimdScalar>(&self, cpu: &Cpu, rows: &mut NodeColumns<'_, T>) {
        let first = rows.first;
        if let Some(external) = rows.external.as_deref_mut() {
            external.fill(T::default());
            for load in &self.loads {
                match load {
                    RowLoad::Gravity(acceleration) => gravity::pull(cpu, rows.mass, *acceleration, external),
                    RowLoad::NodalForce(load, force) => {
                        nodal_force::push(load, *force, first, rows.mass, external);
                    }
                    RowLoad::Pressure(load, pressure, areas) => {
                        pressure::push(&load.faces, *pressure, areas, first, external);
                    }
                    RowLoad::Traction(load, traction) => traction::pull(&load.faces, *traction, first, external),
                }
            }
        }
        for (set, motion) in &self.motions {
            let lost = rows.compensation.as_ref().map(|[of_u, _]| &**of_u);
            boundary::move_rows(set, motion, first, rows.u, lost, rows.step, rows.previous_prescribed);
        }
    }
}

/// Loads and motions of bodies.
#[derive(SystemParam)]
pub(super) struct OnBodies<'w, 's> {
    signals: Res<'w, Signals>,
    gravities: Query<'w, 's, (&'static Gravity, &'static OfBody)>,
    forces: Query<'w, 's, (&'static NodalForce, &'static OfBody)>,
    pressures: Query<'w, 's, (&'static Pressure, &'static OfBody)>,
    tractions: Query<'w, 's, (&'static Traction, &'static OfBody)>,
    prescribed: Query<'w, 's, (&'static Prescribed, &'static OfBody)>,
}

impl OnBodies<'_, '_> {
    /// What these systems, in their order, do to the rows of a body.
    pub(super) fn of(&self, systems: &[String], columns: &BodyColumnsItem<'_, '_>) -> OnRows<'_> {
        let (values, body) = (self.signals.values(), columns.body);
        let mut rows = OnRows::default();
        for system in systems {
            match system.as_str() {
                "gravity" => {
                    let own = self.gravities.iter().filter(|(_, of)| of.0 == body);
                    rows.loads.extend(own.map(|(load, _)| RowLoad::Gravity(values[load.signal])));
                }
                "nodal_force" => {
                    let own = self.forces.iter().filter(|(_, of)| of.0 == body);
                    rows.loads.extend(own.map(|(load, _)| RowLoad::NodalForce(load, values[load.signal])));
                }
                "pressure" => {
                    let own = self.pressures.iter().filter(|(_, of)| of.0 == body);
                    rows.loads.extend(own.map(|(load, _)| {
                        let areas = pressure::areas(&load.faces, columns.rest, &columns.u);
                        RowLoad::Pressure(load, values[load.signal][0], areas)
                    }));
                }
                "traction" => {
                    let own = self.tractions.iter().filter(|(_, of)| of.0 == body);
                    rows.loads.extend(own.map(|(load, _)| RowLoad::Traction(load, values[load.signal])));
                }
                "boundary" => {
                    let own = self.prescribed.iter().filter(|(_, of)| of.0 == body);
                    rows.motions.extend(own.map(|(set, _)| (set, &values[set.signal..set.signal + 3])));
                }
                _ => {}
            }
        }
        rows
    }
}

/// Several systems as one, in their order.
pub(crate) fn node_pass(systems: Vec<String>) -> HostSystem {
    let pass = move |cpu: Res<Cpu>,
                     clock: Res<Clock>,
                     observed: Res<Observed>,
                     on_bodies: OnBodies,
                     mut bodies: Query<(BodyColumns, Option<&Corners>, Option<&ElementForce>)>|
          -> Result<(), Error> {
        for (mut body, corners, force) in &mut bodies {
            let on_rows = on_bodies.of(&systems, &body);
            move_body(&cpu, (&clock, observed.0), &mut body, corners.zip(force), Some(&on_rows));
        }
        Ok(())
    };
    Box::new(IntoSystem::into_system(pass))
}
