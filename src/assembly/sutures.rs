//! Sutures: points become weights of nodes.

use super::anchors::{anchor, begin_elsewhere};
use super::contacts::{bounds, reference};
use super::{Assembly, BodyParts};
use crate::components::*;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::Attachment;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;

/// Spawns all sutures.
pub(super) fn spawn(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    let mut sutures = Sutures::default();
    let mut of_body: BTreeMap<Entity, usize> = BTreeMap::new();
    let mut corners = Vec::new();
    for (number, attachment) in assembly.scene.scene.attachments.iter().enumerate() {
        let Attachment::Suture { from, to, stiffness, length, tighten, curve, strength, .. } = attachment else {
            continue;
        };
        let ends = [("from", from), ("to", to)].map(|(field, point)| {
            let body = assembly.body(&point.body)?;
            let name = assembly.scene.scene.body_meant(&point.body)?;
            corners.extend(<[DVec3; 2]>::from(bounds(&body.placed.mesh.points)));
            anchor(name, body, point.at, &format!("attachments[{number}].{field}.at"), diagnostics)
        });
        let [Some((first, _)), Some((second, _))] = ends else { continue };
        let place = of_body.entry(first.body).or_default();
        sutures.all.push(Suture {
            number,
            ends: [first, second],
            stiffness: *stiffness,
            length: *length,
            tighten: *tighten,
            signal: world.resource_mut::<Signals>().add(Signal::Factor { curve: curve.clone() }),
            strength: strength.unwrap_or(f64::INFINITY),
            place: *place,
        });
        *place += 1;
    }
    if sutures.all.is_empty() {
        return;
    }
    sutures.reference = reference(&corners);
    for (body, count) in of_body {
        world.entity_mut(body).insert(SutureState(Reals::zeros(assembly.precision, SUTURE_NUMBERS * count)));
    }
    insert_rows(assembly, &sutures, world);
    world.insert_resource(sutures);
}

/// Tells bodies which of their nodes are pulled, and how stiffly.
fn insert_rows(assembly: &Assembly<'_>, sutures: &Sutures, world: &mut World) {
    let mut rows: BTreeMap<Entity, BTreeMap<u32, f64>> = BTreeMap::new();
    for suture in &sutures.all {
        let sum: f64 = suture.ends.iter().flat_map(|end| &end.nodes).map(|(_, weight)| weight.abs()).sum();
        for end in &suture.ends {
            for &(row, weight) in &end.nodes {
                *rows.entry(end.body).or_default().entry(row).or_default() += sum * suture.stiffness * weight.abs();
            }
        }
    }
    for (body, rows) in rows {
        let mass = |row: u32| world.get::<Mass>(body).map_or(0.0, |mass| mass.get(row as usize));
        let masses = rows.keys().map(|&row| mass(row)).collect();
        let forces = vec![DVec3::ZERO; rows.len()];
        let column = SutureForce(Reals::zeros(assembly.precision, 3 * rows.len()));
        let (rows, stiffness) = rows.into_iter().unzip();
        world.entity_mut(body).insert((Sutured { rows, stiffness, masses, forces }, column));
    }
}

/// Finds how long sutures are, where the scene leaves it to how far their points are apart at the start.
pub(super) fn measure(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    let Some(mut sutures) = world.remove_resource::<Sutures>() else { return };
    let reference = sutures.reference;
    for suture in &mut sutures.all {
        let [from, to] = [0, 1].map(|end| begins(&suture.ends[end], assembly, reference, world));
        let length = from.distance(to);
        if length <= 1e-12 * (from.length() + to.length()) {
            diagnostics
                .error_at(
                    format!("attachments[{}].to", suture.number).as_str(),
                    "both points of the suture are one place",
                )
                .note("a thread goes from one point to another; what touches is held by `Tie` or `Glue`");
        }
        if let Some(mut state) = world.get_mut::<SutureState>(suture.ends[0].body) {
            // until the first step tells
            state.set(SUTURE_NUMBERS * suture.place + 3, length);
        }
        let length = *suture.length.get_or_insert(length);
        if suture.tighten > length {
            diagnostics
                .error_at(
                    format!("attachments[{}].tighten", suture.number).as_str(),
                    format!("it draws in {:.3e} m of a thread that is {length:.3e} m long", suture.tighten),
                )
                .note("no thread is shorter than 0 m");
        }
    }
    world.insert_resource(sutures);
}

/// Where an end begins (m, from a reference): of a body that is brought from its rest shape to where its mesh has it
/// before the first step, there.
fn begins(end: &Anchor, assembly: &Assembly<'_>, reference: DVec3, world: &World) -> DVec3 {
    let brought = |body: &&BodyParts| body.entity == end.body && body.placed.is_shown_elsewhere();
    let Some(body) = assembly.bodies.values().find(brought).filter(|_| !begin_elsewhere(assembly)) else {
        return at_start(end, reference, world);
    };
    let points = body.placed.points();
    let node = |row: u32| body.node_rows.iter().position(|&own| own == row);
    let of = |&(row, weight): &(u32, f64)| weight * (node(row).map_or(reference, |node| points[node]) - reference);
    end.nodes.iter().map(of).sum()
}

/// Where an end is (m, from a reference) before anything is brought to rest.
pub(super) fn at_start(end: &Anchor, reference: DVec3, world: &World) -> DVec3 {
    let (Some(rest), Some(u)) = (world.get::<RestPosition>(end.body), world.get::<Displacement>(end.body)) else {
        return DVec3::ZERO;
    };
    let of = |&(row, weight): &(u32, f64)| weight * (rest.0[row as usize] - reference + u.vector(row as usize));
    end.nodes.iter().map(of).sum()
}
