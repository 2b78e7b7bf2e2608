//! Attachments: selections become rows.

use super::Assembly;
use super::contacts::{geometries, jumps, motion, reference};
use crate::components::*;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Attachment, Select};
use bevy_ecs::prelude::*;
use std::collections::BTreeMap;

/// Spawns what may hold each body.
pub(super) fn spawn(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    let scene = &assembly.scene.scene;
    if scene.attachments.is_empty() {
        return;
    }
    // what is wrong with tools that touch, too, has been said
    let mut said = Diagnostics::default();
    let touches = scene.contacts.iter().any(|contact| matches!(contact, crate::scene::schema::Contact::Tool { .. }));
    let geometries = geometries(assembly.scene, if touches { &mut said } else { &mut *diagnostics });
    for (name, body) in &assembly.bodies {
        let mut marks: BTreeMap<u32, u32> = BTreeMap::new();
        let mut grasps = Vec::new();
        let reference = reference(&body.placed.mesh.points);
        for (number, attachment) in scene.attachments.iter().enumerate() {
            let Attachment::Grasp { tool, body: of, on, reach, closed, strength } = attachment;
            if of.as_ref().is_some_and(|of| of != name) {
                continue;
            }
            // what is wrong with it has been said
            let (Some(found), Some(geometry)) = (scene.tools.get(tool), geometries.get(tool)) else { continue };
            let path = format!("attachments[{number}].on");
            let Some(picked) = assembly.pick(body, on.as_ref().unwrap_or(&Select::All), &path, diagnostics) else {
                continue;
            };
            let rows = match picked.nodes(&body.placed) {
                Ok(marks) => body.rows_of(&marks),
                Err(problem) => {
                    diagnostics.error_at(path.as_str(), problem.message).notes(problem.notes);
                    continue;
                }
            };
            let bit = 1 << grasps.len();
            rows.into_iter().for_each(|row| *marks.entry(row).or_default() |= bit);
            let mut signals = world.resource_mut::<Signals>();
            let signal = signals.add(Signal::Pose { motion: motion(found), reference });
            let closed = signals.add(Signal::Switch { curve: closed.clone() });
            let reach = reach.or(on.is_none().then_some(0.0));
            let tool = ToolContact { tool: tool.clone(), geometry: geometry.clone(), signal, friction: [0.0; 2] };
            grasps.push(Grasp { tool, closed, reach, strength: strength.unwrap_or(f64::INFINITY) });
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

/// Warns of tools that jump with what they hold.
pub(super) fn check(assembly: &Assembly<'_>, world: &World, diagnostics: &mut Diagnostics) {
    if world.resource::<Clock>().relaxation.is_some() {
        return;
    }
    let scene = &assembly.scene.scene;
    for (name, tool) in &scene.tools {
        let holds = |attachment: &Attachment| matches!(attachment, Attachment::Grasp { tool, .. } if tool == name);
        if scene.attachments.iter().any(holds) {
            jumps(name, tool, "nodes that it holds are torn along", diagnostics);
        }
    }
}
