//! Tools that take elements: names become mouths, selections the author's places.

use super::contacts::{motion, reference};
use super::{Assembly, BodyParts};
use crate::components::*;
use crate::scene::schema::{Tool, When};
use crate::tools::{Shape, Solid};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Adds a tool that takes marked elements of a body.
pub(super) fn add(assembly: &Assembly<'_>, body: &BodyParts, marks: &[bool], when: &When, world: &mut World) {
    let When::InTool { tool: name, reach, rate, bore, burst, curve } = when else { return };
    let Some(tool) = assembly.scene.scene.tools.get(name) else { return };
    let Some(mouth) = mouth(tool, *bore) else { return };
    let mut removals = world
        .get::<ToolRemovals>(body.entity)
        .cloned()
        .unwrap_or_else(|| ToolRemovals { all: Vec::new(), reference: reference(&body.placed.mesh.points) });
    let mut signals = world.resource_mut::<Signals>();
    let pose = signals.add(Signal::Pose { motion: motion(tool), reference: removals.reference });
    let rate = signals.add(Signal::Load { curve: curve.clone(), amplitude: DVec3::X * *rate });
    let rows = |&block: &Entity| world.get::<Block>(block).map_or(0, |block| block.count);
    let mut numbers: Vec<Vec<u32>> = body.blocks.iter().map(|block| vec![u32::MAX; rows(block)]).collect();
    for (number, (&(block, row), &marked)) in (0..).zip(body.element_rows.iter().zip(marks)) {
        if marked {
            numbers[block as usize][row as usize] = number;
        }
    }
    removals.all.push(ToolRemoval { tool: name.clone(), mouth, reach: *reach, pose, rate, burst: *burst, numbers });
    let intake = Reals::zeros(assembly.precision, INTAKE_NUMBERS * removals.all.len());
    let list = vec![0; removals.words(body.element_rows.len())];
    world.entity_mut(body.entity).insert((removals, ToolIntake(intake), ToolReach(list)));
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
