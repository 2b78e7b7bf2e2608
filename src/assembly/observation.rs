//! Probes: selections become rows.

use super::Assembly;
use crate::components::*;
use crate::observation::volume_left;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Quantity, Select};
use crate::snapshot::hash_of;
use bevy_ecs::prelude::*;

/// Spawns all probes.
pub(super) fn spawn(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    let time_step = world.resource::<Clock>().time_step;
    let scene = &assembly.scene.scene;
    for (name, probe) in &scene.probes {
        let every = probe.every.unwrap_or_else(|| scene.fields_every());
        let every = Cadence::new(every, time_step);
        let (what, peak) = (probe.what.clone(), probe.peak);
        let of = format!("{:016x}", hash_of(&(&what, &probe.body, &probe.on)));
        let attachments = scene.attachments.iter().enumerate();
        let named = |wanted: &String| {
            attachments.clone().find(|(number, of)| of.name(*number).as_ref() == Some(wanted)).map(|(number, _)| number)
        };
        let attachment = probe.what.attachment().and_then(named);
        let whole = Select::All;
        let of_volume = what == Quantity::RemovedVolume;
        let Some(on) = probe.on.as_ref().or(of_volume.then_some(&whole)) else {
            // of a tool, whatever it touches, or of an attachment
            let (nodes, elements) = (Vec::new(), Vec::new());
            let probe = Probe { what, nodes, elements, volume: 0.0, attachment, every, peak, of };
            world.spawn((Label(name.clone()), probe));
            continue;
        };
        let Some(body) = assembly.body(&probe.body) else { continue };
        let path = format!("probes.\"{name}\".on");
        let Some(picked) = assembly.pick(body, on, &path, diagnostics) else { continue };
        let of_elements = probe.what.is_of_elements();
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
        let volume = if of_volume { volume_left(&body.blocks, &elements, world) } else { 0.0 };
        world.spawn((
            Label(name.clone()),
            Probe { what, nodes, elements, volume, attachment, every, peak, of },
            OfBody(body.entity),
        ));
    }
}

/// Whole steps nearest to a time, at least one.
pub fn steps_of(time: f64, time_step: f64) -> u64 {
    ((time / time_step).round() as u64).max(1)
}
