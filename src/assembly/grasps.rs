//! Tools that take nodes along: selections become rows, and jaws that close on nothing are told.

use super::contacts::{geometries, instants, jumps, motion, reference};
use super::{Assembly, BodyParts};
use crate::components::*;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Attachment, Contact, Curve, Select};
use crate::tools::{Geometry, Solid};
use bevy_ecs::prelude::*;
use std::collections::BTreeMap;

/// Spawns what may hold each body.
pub(super) fn spawn(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    let scene = &assembly.scene.scene;
    if !scene.attachments.iter().any(|attachment| attachment.tool().is_some()) {
        return;
    }
    // what is wrong with tools that touch, too, has been said
    let mut said = Diagnostics::default();
    let touches = scene.contacts.iter().any(|contact| matches!(contact, Contact::Tool { .. }));
    let geometries = geometries(assembly.scene, world, if touches { &mut said } else { &mut *diagnostics });
    for (name, body) in &assembly.bodies {
        let mut marks: BTreeMap<u32, u32> = BTreeMap::new();
        let mut grasps = Vec::new();
        let reference = reference(&body.placed.mesh.points);
        for (number, attachment) in scene.attachments.iter().enumerate().filter(|(_, all)| all.holds(name)) {
            let Attachment::Grasp { tool, on, jaws, reach, closed, strength, .. } = attachment else { continue };
            // what is wrong with it has been said
            let (Some(found), Some(own)) = (scene.tools.get(tool), geometries.get(tool)) else { continue };
            let jaws = jaws.clone().and_then(|shape| Solid::new(shape, 0.0).ok()).map(Geometry::Analytic);
            let reach = reach.or((on.is_none() || jaws.is_some()).then_some(0.0));
            let path = format!("attachments[{number}].on");
            let Some(rows) = rows(assembly, body, on.as_ref(), &path, diagnostics) else { continue };
            let bit = 1 << grasps.len();
            rows.into_iter().for_each(|row| *marks.entry(row).or_default() |= bit);
            let mut signals = world.resource_mut::<Signals>();
            let signal = signals.add(Signal::Pose { motion: motion(found), reference });
            let closed = signals.add(Signal::Factor { curve: closed.clone() });
            let geometry = jaws.unwrap_or_else(|| own.clone());
            let tool =
                ToolContact { tool: tool.clone(), geometry, signal, friction: [0.0; 2], spring: None, swept: 0.0 };
            grasps.push(Grasp { number, tool, closed, reach, strength: strength.unwrap_or(f64::INFINITY) });
        }
        if grasps.is_empty() {
            continue;
        }
        let led = |grasp: &Grasp| scene.tools.get(&grasp.tool.tool).is_some_and(|tool| tool.port.is_some());
        let felt = grasps.iter().any(led);
        let (rows, masks) = marks.into_iter().unzip();
        let grasps = Grasps { grasps, reference, rows, masks, felt };
        let hold = Reals::zeros(assembly.precision, grasps.numbers() * grasps.rows.len());
        world.entity_mut(body.entity).insert((grasps, ToolHold(hold)));
    }
}

/// The rows of the nodes that a tool may hold.
fn rows(
    assembly: &Assembly<'_>,
    body: &BodyParts,
    on: Option<&Select>,
    path: &str,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<u32>> {
    let picked = assembly.pick(body, on.unwrap_or(&Select::All), path, diagnostics)?;
    match picked.nodes(&body.placed) {
        Ok(marks) => Some(body.rows_of(&marks)),
        Err(problem) => {
            diagnostics.error_at(path, problem.message).notes(problem.notes);
            None
        }
    }
}

/// Looks for tools that close where there is nothing, and warns of those that jump with what they hold.
pub(super) fn check(assembly: &Assembly<'_>, world: &World, diagnostics: &mut Diagnostics) {
    for (name, body) in &assembly.bodies {
        let Some(grasps) = world.get::<Grasps>(body.entity) else { continue };
        for (bit, grasp) in grasps.grasps.iter().enumerate() {
            in_jaws(assembly, (name, body), (grasps, grasp, bit), world, diagnostics);
            led_nodes(name, body, (grasps, grasp, bit), world, diagnostics);
        }
    }
    if world.resource::<Clock>().relaxation.is_some() {
        return;
    }
    let scene = &assembly.scene.scene;
    for (name, tool) in &scene.tools {
        if scene.attachments.iter().any(|attachment| attachment.tool() == Some(name)) {
            jumps(name, tool, "nodes that it holds are torn along", diagnostics);
        }
    }
}

/// Tells of a tool all of whose nodes are fixed or prescribed: no force could move them.
fn led_nodes(
    name: &str,
    body: &BodyParts,
    (grasps, grasp, bit): (&Grasps, &Grasp, usize),
    world: &World,
    diagnostics: &mut Diagnostics,
) {
    let Some(axes) = world.get::<ConstrainedAxes>(body.entity) else { return };
    let mut may = grasps.rows.iter().zip(&grasps.masks).filter(|(_, mask)| **mask >> bit & 1 == 1);
    if may.all(|(&row, _)| axes.hold(row as usize)) {
        let message =
            format!("all nodes of `{name}` that the tool `{}` may hold are fixed or prescribed", grasp.tool.tool);
        diagnostics
            .warn_at(format!("attachments[{}]", grasp.number).as_str(), message)
            .note("no force moves those: it bears nothing, and never breaks");
    }
}

/// Whether there is something in the jaws when they close for the first time: at the start that is known; later the
/// body may have gone elsewhere, and it is a warning.
fn in_jaws(
    assembly: &Assembly<'_>,
    (name, body): (&str, &BodyParts),
    (grasps, grasp, bit): (&Grasps, &Grasp, usize),
    world: &World,
    diagnostics: &mut Diagnostics,
) {
    let scene = &assembly.scene.scene;
    let (Some(tool), Some(attachment)) = (scene.tools.get(&grasp.tool.tool), scene.attachments.get(grasp.number))
    else {
        return;
    };
    let (Some(reach), Some((word, curve))) = (grasp.reach, attachment.curve()) else { return };
    // where hands and programs will be nobody knows
    let motion = motion(tool);
    if matches!(curve, Curve::Input { .. }) || motion.is_led() {
        return;
    }
    let path = format!("attachments[{}].{word}", grasp.number);
    let Some(closes) = instants(scene.duration).find(|&time| curve.value(time) >= 0.5) else {
        diagnostics.warn_at(path.as_str(), format!("the tool `{}` never closes: nothing is held", grasp.tool.tool));
        return;
    };
    let (Some(rest), Some(u)) = (world.get::<RestPosition>(body.entity), world.get::<Displacement>(body.entity)) else {
        return;
    };
    let pose = motion.meant(closes);
    let may = grasps.rows.iter().zip(&grasps.masks).filter(|(_, mask)| **mask >> bit & 1 == 1);
    let place = |row: usize| rest.0[row] + u.vector(row);
    let nearest = may
        .map(|(&row, _)| grasp.tool.geometry.distance(pose.inverse(place(row as usize))).0)
        .fold(f64::INFINITY, f64::min);
    if nearest <= reach {
        return;
    }
    let tool = &grasp.tool.tool;
    let far = format!("the nearest node is {:.3e} m from them, and `reach` is {reach:.3e} m", nearest.max(0.0));
    if closes == 0.0 && scene.start == Default::default() {
        let message = format!("there is nothing of `{name}` in the jaws of `{tool}`, which are closed at the start");
        diagnostics.error_at(path.as_str(), message).note(far).note("give `reach`, or nodes by `on` without `jaws`");
    } else {
        let message = format!("as `{name}` is at the start, nothing of it is in the jaws of `{tool}` when they close");
        diagnostics.warn_at(path.as_str(), message).note(format!("at {closes:.3e} s {far}"));
    }
}
