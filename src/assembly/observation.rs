//! Probes: selections become rows.

use super::Assembly;
use crate::components::*;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::Quantity;
use bevy_ecs::prelude::*;

/// Spawns all probes.
pub(super) fn spawn(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    let time_step = world.resource::<Clock>().time_step;
    let scene = &assembly.scene.scene;
    for (name, probe) in &scene.probes {
        let every = probe.every.unwrap_or_else(|| scene.fields_every());
        let every = Cadence::new(every, time_step);
        let (what, peak) = (probe.what.clone(), probe.peak);
        let Some(on) = &probe.on else {
            // of a tool, whatever it touches
            world.spawn((Label(name.clone()), Probe { what, nodes: Vec::new(), elements: Vec::new(), every, peak }));
            continue;
        };
        let Some(body) = assembly.body(&probe.body) else { continue };
        let path = format!("probes.\"{name}\".on");
        let Some(picked) = assembly.pick(body, on, &path, diagnostics) else { continue };
        let of_elements = matches!(probe.what, Quantity::Stress | Quantity::VolumeRatio);
        let marks = if of_elements { picked.elements(&body.placed) } else { picked.nodes(&body.placed) };
        let marks = match marks {
            Ok(marks) => marks,
            Err(problem) => {
                diagnostics.error_at(path.as_str(), problem.message).notes(problem.notes);
                continue;
            }
        };
        let (mut nodes, mut elements) = (Vec::new(), Vec::new());
        if of_elements {
            let marked = marks.iter().zip(&body.element_rows).filter(|(marked, _)| **marked);
            elements = marked.map(|(_, &row)| row).collect();
        } else {
            nodes = body.rows_of(&marks);
        }
        world.spawn((Label(name.clone()), Probe { what, nodes, elements, every, peak }, OfBody(body.entity)));
    }
}

/// Whole steps nearest to a time, at least one.
pub fn steps_of(time: f64, time_step: f64) -> u64 {
    ((time / time_step).round() as u64).max(1)
}
