//! Tools that take elements: names become mouths, selections the author's places.

use super::contacts::{motion, reference};
use super::{Assembly, BodyParts};
use crate::components::*;
use crate::evaluation::rest_volume;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Contact, Threshold, Tool, When};
use crate::tools::{Shape, Solid};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// A reach below this share of an element that a tool is kept out of finds none: centroids are farther below faces.
const HARDLY: f64 = 0.1;

/// Tells of a reach that ends above the centroids of elements whose nodes keep outside of the tool.
pub(super) fn check(
    assembly: &Assembly<'_>,
    body: &BodyParts,
    (when, path): (&When, &str),
    world: &World,
    diagnostics: &mut Diagnostics,
) {
    let When::InTool { tool, reach, .. } = when else { return };
    let keeps_out = |contact: &Contact| matches!(contact, Contact::Tool { tool: of, .. } if of == tool);
    let across = mean_volume(body, world).cbrt();
    if *reach < HARDLY * across && assembly.scene.scene.contacts.iter().any(keeps_out) {
        diagnostics
            .warn_at(
                path,
                format!("`{tool}` takes elements whose centroids are within {reach:.1e} m, and it stays outside"),
            )
            .note(format!("elements are {across:.1e} m across: nothing, or hardly anything, comes within its reach"));
    }
}

/// Adds a tool that takes marked elements of a body.
pub(super) fn add(assembly: &Assembly<'_>, body: &BodyParts, marks: &[bool], when: &When, world: &mut World) {
    let When::InTool { tool: name, reach, rate, threshold, bore, burst, curve, crumb } = when else { return };
    let Some(tool) = assembly.scene.scene.tools.get(name) else { return };
    let Some(mouth) = mouth(tool, *bore) else { return };
    let mut removals = world
        .get::<ToolRemovals>(body.entity)
        .cloned()
        .unwrap_or_else(|| ToolRemovals { all: Vec::new(), reference: reference(&body.placed.mesh.points) });
    let mut signals = world.resource_mut::<Signals>();
    let pose = signals.add(Signal::Pose { motion: motion(tool), reference: removals.reference });
    let amplitude = DVec3::X * rate.unwrap_or(1.0);
    let fastest = rate.unwrap_or(0.0) * curve.largest(assembly.scene.scene.duration).max(0.0);
    let rate = signals.add(Signal::Load { curve: curve.clone(), amplitude });
    let threshold = threshold.map(|threshold| match threshold {
        Threshold::StretchAbove(limit) => (Measure::Stretch, limit),
        Threshold::EnergyDensityAbove(limit) => (Measure::EnergyDensity, limit),
    });
    let crumb = crumb.unwrap_or_else(|| CRUMB * mean_volume(body, world));
    let rows = |&block: &Entity| world.get::<Block>(block).map_or(0, |block| block.count);
    let mut numbers: Vec<Vec<u32>> = body.blocks.iter().map(|block| vec![u32::MAX; rows(block)]).collect();
    let mut largest = 0.0_f64;
    for (number, (&(block, row), &marked)) in (0..).zip(body.element_rows.iter().zip(marks)) {
        if marked {
            numbers[block as usize][row as usize] = number;
            largest = largest.max(volume(body, (block, row), world));
        }
    }
    let (tool, reach, burst) = (name.clone(), *reach, *burst);
    removals.all.push(ToolRemoval {
        tool,
        mouth,
        reach,
        pose,
        rate,
        fastest,
        threshold,
        crumb,
        burst,
        largest,
        numbers,
    });
    let intake = Reals::zeros(assembly.precision, INTAKE_NUMBERS * removals.all.len());
    let list = vec![0; removals.words(body.element_rows.len())];
    world.entity_mut(body.entity).insert((removals, ToolIntake(intake), ToolReach(list)));
    if crumb > 0.0 && world.get::<Islands>(body.entity).is_none() {
        let (points, cells) = (body.placed.mesh.points.len(), &body.placed.mesh.cells);
        let (at_start, there) = (cells.pieces(points, |_| true), vec![true; cells.len()]);
        world.entity_mut(body.entity).insert(Islands { points, at_start, there, all: Vec::new() });
    }
}

/// Islands of so many mean elements and more are no crumbs, where the scene does not say.
const CRUMB: f64 = 4.0;

/// Mean volume of a body's elements at rest (m³).
fn mean_volume(body: &BodyParts, world: &World) -> f64 {
    let sum: f64 = body.element_rows.iter().map(|&at| volume(body, at, world)).sum();
    sum / body.element_rows.len().max(1) as f64
}

/// Volume at rest of the element of a block's place and a row (m³).
pub(super) fn volume(body: &BodyParts, (block, row): (u32, u32), world: &World) -> f64 {
    let block = body.blocks[block as usize];
    let parts = world.get::<Block>(block).zip(world.get::<RestShape>(block));
    parts.map_or(0.0, |(block, shape)| rest_volume(block, row as usize, shape))
}

/// Where a tool takes elements. A mesh has no mouth of its own; validation has asked for one.
fn mouth(tool: &Tool, bore: Option<f64>) -> Option<Mouth> {
    match (bore, &tool.shape) {
        (Some(radius), _) => Some(Mouth::Disc(radius)),
        (None, Some(Shape::Tube { inner, .. })) => Some(Mouth::Disc(*inner)),
        (None, Some(shape)) => Solid::new(shape.clone(), tool.rounding).ok().map(Mouth::Tool),
        (None, None) => None,
    }
}
