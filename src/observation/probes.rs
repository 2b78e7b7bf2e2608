//! Probes.

use super::fields::reaction;
use super::heading::Heading;
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::Error;
use crate::evaluation::{BlockView, ElementState, rest_volume};
use crate::scene::schema::Quantity;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// The columns of a probe's table.
pub fn header(what: &Quantity) -> Vec<Heading> {
    let columns: &[(&'static str, &'static str)] = match what {
        Quantity::Displacement => &[("ux", "m"), ("uy", "m"), ("uz", "m")],
        Quantity::Position => &[("x", "m"), ("y", "m"), ("z", "m")],
        Quantity::Velocity => &[("vx", "m/s"), ("vy", "m/s"), ("vz", "m/s")],
        Quantity::Reaction => &[("Rx", "N"), ("Ry", "N"), ("Rz", "N")],
        Quantity::Force { .. } => &[("force", "N")],
        Quantity::Moment { .. } => &[("Mx", "N m"), ("My", "N m"), ("Mz", "N m")],
        Quantity::Torque { .. } => &[("torque", "N m")],
        Quantity::Stress => &[("xx", "Pa"), ("yy", "Pa"), ("zz", "Pa"), ("xy", "Pa"), ("yz", "Pa"), ("xz", "Pa")],
        Quantity::VolumeRatio => &[("J", "1")],
        Quantity::RemovedVolume => &[("volume", "m³")],
        Quantity::ContactForce => &[("Fx", "N"), ("Fy", "N"), ("Fz", "N")],
        Quantity::ContactPressure => &[("pressure", "Pa")],
        Quantity::ContactArea => &[("area", "m²")],
        Quantity::ContactGap => &[("gap", "m")],
        Quantity::ContactSlip => &[("slip", "m")],
        Quantity::AttachmentForce { .. } => &[("Fx", "N"), ("Fy", "N"), ("Fz", "N")],
        Quantity::SutureLength { .. } => &[("length", "m")],
        Quantity::ToolForce { .. } => &[("Fx", "N"), ("Fy", "N"), ("Fz", "N")],
        Quantity::ToolTorque { .. } => &[("Tx", "N m"), ("Ty", "N m"), ("Tz", "N m")],
        Quantity::ToolPlace { .. } => &[("x", "m"), ("y", "m"), ("z", "m")],
        Quantity::ToolPose { .. } => {
            &[("x", "m"), ("y", "m"), ("z", "m"), ("rx", "degrees"), ("ry", "degrees"), ("rz", "degrees")]
        }
        Quantity::ToolVelocity { .. } => {
            &[("vx", "m/s"), ("vy", "m/s"), ("vz", "m/s"), ("wx", "rad/s"), ("wy", "rad/s"), ("wz", "rad/s")]
        }
    };
    Heading::all(&[&[("time", "s")][..], columns].concat())
}

/// What a probe sees at the present step.
///
/// Reactions are made of the forces at the beginning of the step that has just been taken; of implicit steps at its
/// end.
///
/// # Errors
/// What the GPU says.
pub fn observe_probe(world: &mut World, probe: Entity) -> Result<Vec<f64>, Error> {
    let (body, Some(probe)) = (world.get::<OfBody>(probe).map(|of| of.0), world.get::<Probe>(probe).cloned()) else {
        return Ok(Vec::new());
    };
    if let Some(tool) = probe.what.tool() {
        if matches!(probe.what, Quantity::ToolPose { .. } | Quantity::ToolVelocity { .. }) {
            let of_velocity = matches!(probe.what, Quantity::ToolVelocity { .. });
            return Ok(super::tools::way_of(world, tool, of_velocity).map(<[f64; 3]>::from).concat());
        }
        let reading = super::tools::read_tool(world, tool)?;
        return Ok(match probe.what {
            Quantity::ToolForce { .. } => reading.force,
            Quantity::ToolTorque { .. } => reading.torque,
            _ => reading.place,
        }
        .to_array()
        .to_vec());
    }
    if probe.what.attachment().is_some() {
        let number = probe.attachment.unwrap_or(usize::MAX);
        let reading = super::attachments::read_attachment(world, number)?.unwrap_or_default();
        let of_length = matches!(probe.what, Quantity::SutureLength { .. });
        return Ok(if of_length { vec![reading.length] } else { reading.force.to_array().to_vec() });
    }
    let Some(body) = body else { return Ok(Vec::new()) };
    if probe.what.is_of_contact() {
        return super::contact_fields::of_probe(world, body, &probe);
    }
    let columns: &[&str] = match probe.what {
        Quantity::Displacement | Quantity::Position => &[Displacement::NAME],
        Quantity::Velocity => &[DisplacementIncrement::NAME],
        Quantity::Reaction | Quantity::Force { .. } => &[InternalForce::NAME, ExternalForce::NAME],
        Quantity::Moment { .. } | Quantity::Torque { .. } => {
            &[InternalForce::NAME, ExternalForce::NAME, Displacement::NAME, DisplacementIncrement::NAME]
        }
        Quantity::RemovedVolume => &[RestShape::NAME],
        _ => &[Displacement::NAME, RestShape::NAME, ViscousMemory::NAME],
    };
    let of_body = |world: &World, entity: Entity| world.get::<OfBody>(entity).is_some_and(|of| of.0 == body);
    let entities: Vec<Entity> =
        world.query::<EntityRef>().iter(world).map(|e| e.id()).filter(|&e| e == body || of_body(world, e)).collect();
    bring_to_host(world, |entity, name| columns.contains(&name) && entities.contains(&entity))?;
    let mean = |of: &dyn Fn(usize) -> DVec3| {
        let sum: DVec3 = probe.nodes.iter().map(|&row| of(row as usize)).sum();
        (sum / probe.nodes.len().max(1) as f64).to_array().to_vec()
    };
    let clock = world.resource::<Clock>();
    let rate = clock.rate();
    // arms are where the forces were: at the beginning of the step, of implicit ones at its end
    let back = if clock.velocities_at_ends { 0.0 } else { 1.0 };
    let entity = world.entity(body);
    let vector = |reals: Option<&Reals>, row: usize| reals.map_or(DVec3::ZERO, |reals| reals.vector(row));
    let displacement = entity.get::<Displacement>().map(|u| &u.0);
    let step = entity.get::<DisplacementIncrement>().map(|d| &d.0);
    let rows = || probe.nodes.iter().map(|&row| row as usize);
    let force = |row: usize| reaction(entity, row);
    let held = || rows().map(force).sum::<DVec3>();
    let rest = entity.get::<RestPosition>();
    let place = |row: usize| rest.map_or(DVec3::ZERO, |rest| rest.0[row]) + vector(displacement, row);
    let arm = |row: usize, center: DVec3| place(row) - back * vector(step, row) - center;
    let moment = |center: DVec3| rows().map(|row| arm(row, center).cross(force(row))).sum::<DVec3>();
    Ok(match probe.what {
        Quantity::Displacement => mean(&|row| vector(displacement, row)),
        Quantity::Position => mean(&place),
        Quantity::Velocity => mean(&|row| vector(step, row) * rate),
        Quantity::Reaction => held().to_array().to_vec(),
        Quantity::Force { direction } => vec![held().dot(direction.normalize())],
        Quantity::Moment { center } => moment(center).to_array().to_vec(),
        Quantity::Torque { center, axis } => vec![moment(center).dot(axis.normalize())],
        Quantity::RemovedVolume => {
            let blocks = entity.get::<Authoring>().map_or(&[][..], |authoring| &authoring.blocks);
            vec![probe.volume - volume_left(blocks, &probe.elements, world)]
        }
        Quantity::Stress => element_mean(world, body, &probe, 0.0, |view, row, state| view.cauchy(row, state).to_vec()),
        _ => element_mean(world, body, &probe, 1.0, |_, _, state| vec![state.volume_ratio()]),
    })
}

/// The values themselves, or where the probe holds peaks those of the largest size so far, with these.
pub fn with_peaks(world: &World, probe: Entity, mut values: Vec<f64>) -> Vec<f64> {
    for (value, peak) in values.iter_mut().zip(peaks_so_far(world, probe).into_iter().flatten()) {
        // what is no number is larger than nothing, nor holds what comes after it off
        let is_larger = value.abs() > peak.abs();
        if !is_larger && !peak.is_nan() {
            *value = *peak;
        }
    }
    values
}

/// The values of the largest size that a probe which holds peaks has seen, if it has seen any: what another one saw
/// that had its name, before a snapshot, is not its own.
fn peaks_so_far(world: &World, probe: Entity) -> Option<&Vec<f64>> {
    let (probe, name) = (world.get::<Probe>(probe).filter(|probe| probe.peak)?, &world.get::<Label>(probe)?.0);
    let memory = world.get_resource::<GuardMemory>()?;
    let is_own = memory.probe_peaks_of.get(name).is_none_or(|of| *of == probe.of);
    memory.probe_peaks.get(name).filter(|peaks| is_own && peaks.len() + 1 == header(&probe.what).len())
}

/// Notes the values of the largest size so far of a probe that holds peaks.
pub(super) fn keep_peaks(world: &mut World, probe: Entity, peaks: &[f64]) {
    let found = world.get::<Probe>(probe).filter(|probe| probe.peak).zip(world.get::<Label>(probe));
    let Some((of, name)) = found.map(|(probe, name)| (probe.of.clone(), name.0.clone())) else { return };
    let mut memory = world.get_resource_or_init::<GuardMemory>();
    memory.probe_peaks_of.insert(name.clone(), of);
    memory.probe_peaks.insert(name, peaks.to_vec());
}

/// Volume at rest (m³) of those of some elements that are still there; `elements`: place of the block, and row there.
pub fn volume_left(blocks: &[Entity], elements: &[(u32, u32)], world: &World) -> f64 {
    let of_element = |&(place, row): &(u32, u32)| {
        let block = blocks[place as usize];
        let parts = world.get::<Block>(block).zip(world.get::<RestShape>(block));
        parts.map_or(0.0, |(block, shape)| rest_volume(block, row as usize, shape))
    };
    elements.iter().map(of_element).sum()
}

/// Mean over the probe's elements that are still there, by rest volume; where none is, what an undeformed one has.
fn element_mean(
    world: &World,
    body: Entity,
    probe: &Probe,
    undeformed: f64,
    of: impl Fn(&BlockView<'_>, usize, &ElementState) -> Vec<f64>,
) -> Vec<f64> {
    let length = header(&probe.what).len() - 1;
    let (mut sum, mut volume) = (vec![0.0; length], 0.0);
    let Some(authoring) = world.get::<Authoring>(body) else { return sum };
    let mut views: Vec<Option<BlockView<'_>>> = authoring.blocks.iter().map(|_| None).collect();
    for &(place, row) in &probe.elements {
        let (view, row) = (&mut views[place as usize], row as usize);
        if view.is_none() {
            *view = BlockView::now(world, authoring.blocks[place as usize]);
        }
        let Some(view) = view else { continue };
        let state = view.element(row);
        for (sum, value) in sum.iter_mut().zip(of(view, row, &state)) {
            *sum += state.volume * value;
        }
        volume += state.volume;
    }
    match volume > 0.0 {
        true => sum.iter_mut().for_each(|value| *value /= volume),
        false => sum.fill(undeformed),
    }
    sum
}
