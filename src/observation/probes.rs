//! Probes.

use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::Error;
use crate::evaluation::{BlockView, ElementState};
use crate::scene::schema::Quantity;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// The columns of a probe's table.
pub fn header(what: Quantity) -> Vec<&'static str> {
    let columns: &[&str] = match what {
        Quantity::Displacement => &["ux (m)", "uy (m)", "uz (m)"],
        Quantity::Position => &["x (m)", "y (m)", "z (m)"],
        Quantity::Velocity => &["vx (m/s)", "vy (m/s)", "vz (m/s)"],
        Quantity::Reaction => &["Rx (N)", "Ry (N)", "Rz (N)"],
        Quantity::Stress => &["xx (Pa)", "yy (Pa)", "zz (Pa)", "xy (Pa)", "yz (Pa)", "xz (Pa)"],
        Quantity::VolumeRatio => &["J"],
    };
    std::iter::once("time (s)").chain(columns.iter().copied()).collect()
}

/// What a probe sees at the present step.
///
/// Reactions are made of the forces at the beginning of the step that has just been taken.
///
/// # Errors
/// What the GPU says.
pub fn observe_probe(world: &mut World, probe: Entity) -> Result<Vec<f64>, Error> {
    let (Some(body), Some(probe)) = (world.get::<OfBody>(probe).map(|of| of.0), world.get::<Probe>(probe).cloned())
    else {
        return Ok(Vec::new());
    };
    let columns: &[&str] = match probe.what {
        Quantity::Displacement | Quantity::Position => &[Displacement::NAME],
        Quantity::Velocity => &[DisplacementStep::NAME],
        Quantity::Reaction => &[InternalForce::NAME, ExternalForce::NAME],
        Quantity::Stress | Quantity::VolumeRatio => &[Displacement::NAME, RestShape::NAME, ViscousMemory::NAME],
    };
    let of_body = |world: &World, entity: Entity| world.get::<OfBody>(entity).is_some_and(|of| of.0 == body);
    let entities: Vec<Entity> =
        world.query::<EntityRef>().iter(world).map(|e| e.id()).filter(|&e| e == body || of_body(world, e)).collect();
    bring_to_host(world, |entity, name| columns.contains(&name) && entities.contains(&entity))?;
    let mean = |of: &dyn Fn(usize) -> DVec3| {
        let sum: DVec3 = probe.nodes.iter().map(|&row| of(row as usize)).sum();
        (sum / probe.nodes.len().max(1) as f64).to_array().to_vec()
    };
    let rate = world.resource::<Clock>().rate();
    let entity = world.entity(body);
    let vector = |reals: Option<&Reals>, row: usize| reals.map_or(DVec3::ZERO, |reals| reals.vector(row));
    let displacement = entity.get::<Displacement>().map(|u| &u.0);
    Ok(match probe.what {
        Quantity::Displacement => mean(&|row| vector(displacement, row)),
        Quantity::Position => {
            let rest = entity.get::<RestPosition>();
            mean(&|row| rest.map_or(DVec3::ZERO, |rest| rest.0[row]) + vector(displacement, row))
        }
        Quantity::Velocity => {
            let step = entity.get::<DisplacementStep>().map(|d| &d.0);
            mean(&|row| vector(step, row) * rate)
        }
        Quantity::Reaction => {
            let internal = entity.get::<InternalForce>().map(|f| &f.0);
            let external = entity.get::<ExternalForce>().map(|f| &f.0);
            let force = |row: u32| vector(internal, row as usize) - vector(external, row as usize);
            probe.nodes.iter().map(|&row| force(row)).sum::<DVec3>().to_array().to_vec()
        }
        Quantity::Stress => element_mean(world, body, &probe, |view, row, state| view.cauchy(row, state).to_vec()),
        Quantity::VolumeRatio => element_mean(world, body, &probe, |_, _, state| vec![state.volume_ratio()]),
    })
}

/// Mean over the probe's elements that are still there, by rest volume.
fn element_mean(
    world: &World,
    body: Entity,
    probe: &Probe,
    of: impl Fn(&BlockView<'_>, usize, &ElementState) -> Vec<f64>,
) -> Vec<f64> {
    let length = header(probe.what).len() - 1;
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
    if volume > 0.0 {
        sum.iter_mut().for_each(|value| *value /= volume);
    }
    sum
}
