//! Energies and mass.

use super::heading::Heading;
use crate::backend::cpu::{Cpu, ROWS_A_TASK};
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::Error;
use crate::evaluation::BlockView;
use crate::math::lane_place;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// All columns.
const HEADER: [(&str, &str); 11] = [
    ("time", "s"),
    ("kinetic", "J"),
    ("strain", "J"),
    ("hourglass", "J"),
    ("removed", "J"),
    ("load work", "J"),
    ("damping loss", "J"),
    ("constraint work", "J"),
    ("internal work", "J"),
    ("contact loss", "J"),
    ("scheme loss", "J"),
];

/// The columns of `energy.csv`; a static analysis counts no work, only what touches something loses energy to that, and
/// only implicit steps lose some.
pub fn energy_header(at_rest: bool, implicit: bool, touches: bool) -> Vec<Heading> {
    let of_contact = if touches { &HEADER[9..10] } else { &[] };
    let of_scheme = if implicit { &HEADER[10..] } else { &[] };
    match at_rest {
        true => Heading::all(&HEADER[..5]),
        false => Heading::all(&[&HEADER[..9], of_contact, of_scheme].concat()),
    }
}

/// What stands in them after the time; `touches`: whether what contact takes has a column.
pub(super) fn values(e: &Energies, touches: bool) -> Vec<f64> {
    let of_contact = touches.then(|| e.contact_loss.unwrap_or(0.0));
    let works = [e.load_work, e.damping_loss, e.constraint_work, e.internal_work, of_contact, e.scheme_loss];
    let held = [e.kinetic, e.strain, e.hourglass, e.removed];
    held.into_iter().chain(works.into_iter().flatten()).collect()
}

/// Total mass of all bodies (kg), inactive nodes and removed elements left out.
///
/// # Errors
/// What the GPU says.
pub fn mass(world: &mut World) -> Result<f64, Error> {
    bring_to_host(world, |_, name| name == Mass::NAME)?;
    Ok(world.query::<&Mass>().iter(world).map(|mass| mass.sum()).sum())
}

/// Momentum that has gone with removed elements (kg m/s).
///
/// # Errors
/// What the GPU says.
pub fn removed_momentum(world: &mut World) -> Result<DVec3, Error> {
    bring_to_host(world, |_, name| name == RemovedMomentum::NAME)?;
    Ok(world.query::<&RemovedMomentum>().iter(world).map(momentum_of).sum())
}

fn momentum_of(momenta: &RemovedMomentum) -> DVec3 {
    let vector = |row: usize| DVec3::from_array([0, 1, 2].map(|i| momenta.get(lane_place(row, 3, i))));
    (0..momenta.len() / 3).map(vector).sum()
}

/// The energies of all bodies at the present step.
///
/// # Errors
/// What the GPU says.
pub fn energies(world: &mut World) -> Result<Energies, Error> {
    let wanted = [
        Displacement::NAME,
        DisplacementIncrement::NAME,
        Mass::NAME,
        InertialMass::NAME,
        Work::NAME,
        SchemeLoss::NAME,
        OwnNumbers::NAME,
        RestShape::NAME,
        RemovedEnergy::NAME,
        RemovedWork::NAME,
    ];
    bring_to_host(world, |_, name| wanted.contains(&name))?;
    let rate = world.resource::<Clock>().rate();
    let mut sum = Energies::default();
    type Masses<'a> = (&'a Mass, Option<&'a InertialMass>);
    let mut bodies = world.query::<(Entity, Masses<'_>, &DisplacementIncrement, &ConstrainedAxes, Option<&Work>)>();
    for (_, (mass, inertia), step, axes, work) in bodies.iter(world) {
        // what moves is all that resists acceleration
        let mass = inertia.map_or(&mass.0, |inertia| &inertia.0);
        let kinetic = |row: usize, along: &dyn Fn(usize) -> bool| {
            let v = step.vector(row) * rate;
            let square: f64 = (0..3).filter(|&i| along(i)).map(|i| v[i] * v[i]).sum();
            0.5 * mass.get(row) * square
        };
        let rows = 0..mass.len();
        sum.kinetic += rows.clone().map(|row| kinetic(row, &|_| true)).sum::<f64>();
        if let Some(work) = work {
            let [of_loads, damped, of_constraints, internal] = work_done(work);
            // constraints also give the kinetic energy of what they move
            let moved = rows.clone().map(|row| kinetic(row, &|i| axes[row] >> i & 1 == 1)).sum::<f64>();
            *sum.load_work.get_or_insert(0.0) += of_loads;
            *sum.damping_loss.get_or_insert(0.0) += damped;
            *sum.constraint_work.get_or_insert(0.0) += of_constraints + moved;
            *sum.internal_work.get_or_insert(0.0) += internal;
        }
    }
    for loss in world.query::<&SchemeLoss>().iter(world) {
        *sum.scheme_loss.get_or_insert(0.0) += loss.sum();
    }
    for held in world.get_resource::<HeldEnergies>().cloned().unwrap_or_default().0 {
        if let Some(energy) = held(world)? {
            *sum.held.get_or_insert(0.0) += energy;
        }
    }
    super::free_tools::add_energies(world, &mut sum);
    sum.contact_loss = super::contacts::loss(world)?;
    let blocks: Vec<Entity> = world.query_filtered::<Entity, With<Block>>().iter(world).collect();
    for entity in blocks {
        let (strain, hourglass) = block_energies(world, entity);
        sum.strain += strain;
        sum.hourglass += hourglass;
        if let Some(removed) = world.get::<RemovedEnergy>(entity) {
            sum.removed += removed.sum();
        }
        // nor do they take back what they gave to mass that is gone
        if let (Some(total), Some(given)) = (&mut sum.constraint_work, world.get::<RemovedWork>(entity)) {
            *total += given.sum();
        }
    }
    Ok(sum)
}

/// Of all nodes the work (J) done by loads, against damping, by constraints and against internal forces.
fn work_done(work: &Work) -> [f64; 4] {
    [0, 1, 2, 3].map(|i| (0..work.len() / WORK_NUMBERS).map(|row| work.get(WORK_NUMBERS * row + i)).sum())
}

/// What of the energies that are added up from step to step is no finite number: what it is of, and the number.
pub(super) fn not_finite(world: &mut World) -> Result<Option<(&'static str, f64)>, Error> {
    let wanted = [Work::NAME, RemovedEnergy::NAME, RemovedWork::NAME, RemovedMomentum::NAME];
    bring_to_host(world, |_, name| wanted.contains(&name))?;
    let mut sums: Vec<(&'static str, f64)> = Vec::new();
    for work in world.query::<&Work>().iter(world) {
        let names =
            ["the work of loads", "the loss to damping", "the work of constraints", "the work against internal forces"];
        sums.extend(names.into_iter().zip(work_done(work)));
    }
    for (energy, work, momenta) in world.query::<(&RemovedEnergy, &RemovedWork, &RemovedMomentum)>().iter(world) {
        sums.push(("the energy of removed elements", energy.sum()));
        sums.push(("the work of constraints on removed elements", work.sum()));
        sums.push(("the momentum of removed elements", momenta.sum()));
    }
    Ok(sums.into_iter().find(|(_, value)| !value.is_finite()))
}

/// Displacements in the middle of the last step, where velocities are: only there do the energies add up.
fn middle_of_step(world: &World, body: Entity) -> Option<Reals> {
    let (u, step) = (world.get::<Displacement>(body)?, world.get::<DisplacementIncrement>(body)?);
    let back = world.resource::<Clock>().back_to_middle();
    let middle = |i: usize| u.get(i) - back * step.get(i);
    Some(Reals::from_f64(Precision::F64, (0..u.len()).map(middle)))
}

/// Elastic and hourglass energy of a block (J), summed in a fixed order.
fn block_energies(world: &World, entity: Entity) -> (f64, f64) {
    let parts = (|| {
        let displacement = &middle_of_step(world, world.get::<Block>(entity)?.body)?;
        let view = BlockView::under(world, entity, displacement)?;
        let task = |task: usize| {
            let rows = task * ROWS_A_TASK..view.block.count.min((task + 1) * ROWS_A_TASK);
            rows.fold((0.0, 0.0), |(strain, hourglass), row| {
                let state = view.element(row);
                let energy = view.energy(row, &state) * state.volume;
                (strain + energy, hourglass + state.hourglass_energy(row, view.shape))
            })
        };
        Some(world.resource::<Cpu>().map(view.block.count.div_ceil(ROWS_A_TASK), task))
    })();
    parts.unwrap_or_default().into_iter().fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1))
}
