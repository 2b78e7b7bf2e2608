//! Removal: what goes by time gets its step, what goes by criterion its limit.

use super::{Assembly, BodyParts, tool_removal};
use crate::components::*;
use crate::math::LANES;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Inversion, Select, When};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Spawns all removals; blocks that may lose elements get the columns for it.
pub(super) fn spawn(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    let time_step = world.resource::<Clock>().time_step;
    for body in assembly.bodies.values() {
        for &block in &body.blocks {
            if world.get::<OnInversion>(block) == Some(&OnInversion(Inversion::Remove)) {
                insert_columns(assembly.precision, block, world);
            }
        }
    }
    for (number, removal) in assembly.scene.scene.removal.iter().enumerate() {
        let Some(body) = assembly.body(&removal.body) else { continue };
        let path = format!("removal[{number}].on");
        let Some(picked) = assembly.pick(body, &removal.on, &path, diagnostics) else { continue };
        let marks = match picked.elements(&body.placed) {
            Ok(marks) => marks,
            Err(problem) => {
                diagnostics.error_at(path.as_str(), problem.message).notes(problem.notes);
                continue;
            }
        };
        body.blocks.iter().for_each(|&block| insert_columns(assembly.precision, block, world));
        match &removal.when {
            &When::At(time) => by_time(body, &marks, time_step, world, |_| time),
            &When::During { start, end } => {
                let times = times_from_center(body, &marks, (start, end));
                by_time(body, &marks, time_step, world, |element| times[element]);
            }
            &When::StretchAbove(limit) => by_criterion(body, &removal.on, &marks, Measure::Stretch, limit, world),
            &When::VolumeRatioAbove(limit) => {
                by_criterion(body, &removal.on, &marks, Measure::VolumeRatio, limit, world);
            }
            &When::VolumeRatioBelow(limit) => {
                by_criterion(body, &removal.on, &marks, Measure::NegativeVolumeRatio, -limit, world);
            }
            &When::EnergyDensityAbove(limit) => {
                by_criterion(body, &removal.on, &marks, Measure::EnergyDensity, limit, world);
            }
            when @ When::InTool { .. } => {
                let path = format!("removal[{number}].when.reach");
                tool_removal::check(assembly, body, (when, &path), world, diagnostics);
                tool_removal::add(assembly, body, &marks, when, world);
            }
        }
    }
}

/// Gives a block what it needs to lose elements.
pub(super) fn insert_columns(precision: Precision, block: Entity, world: &mut World) {
    let count = world.get::<Block>(block).map_or(0, |block| block.count);
    let padded = count.div_ceil(LANES) * LANES;
    let mut entity = world.entity_mut(block);
    if !entity.contains::<Alive>() {
        let alive = (0..padded).map(|row| u32::from(row < count)).collect();
        entity.insert((
            Alive(alive),
            RemovalStep(vec![u32::MAX; padded]),
            RemovedEnergy(Reals::zeros(precision, padded)),
            RemovedWork(Reals::zeros(precision, padded)),
            RemovedMomentum(Reals::zeros(precision, 3 * padded)),
        ));
    }
}

/// Each marked element goes at the first step that is not earlier than its time.
fn by_time(body: &BodyParts, marks: &[bool], time_step: f64, world: &mut World, time: impl Fn(usize) -> f64) {
    for &block in &body.blocks {
        let count = world.get::<RemovalStep>(block).map_or(0, |column| column.len());
        if world.get::<RemovalTime>(block).is_none() {
            world.entity_mut(block).insert(RemovalTime(vec![f64::INFINITY; count]));
        }
    }
    for (element, _) in marks.iter().enumerate().filter(|(_, marked)| **marked) {
        let (block, row) = body.element_rows[element];
        let (block, row, time) = (body.blocks[block as usize], row as usize, time(element));
        if let Some(mut column) = world.get_mut::<RemovalStep>(block) {
            column[row] = step_of(time / time_step, 1).min(column[row]);
        }
        if let Some(mut times) = world.get_mut::<RemovalTime>(block) {
            times.0[row] = time.min(times.0[row]);
        }
    }
}

/// The first whole number of steps that is not below a number of them, and at least `least`.
pub fn step_of(steps: f64, least: u64) -> u32 {
    // a time that is a whole number of steps is met in spite of rounding
    (steps - 1e-6).ceil().clamp(least as f64, f64::from(u32::MAX)) as u32
}

/// When each marked element goes between two times (s): in each of the body's copies those first that are nearest to
/// the centroid of its marked ones.
fn times_from_center(body: &BodyParts, marks: &[bool], (start, end): (f64, f64)) -> Vec<f64> {
    let (points, copies) = (body.placed.points(), body.copies.max(1));
    let nodes = points.len().div_ceil(copies).max(1);
    let mut marked: Vec<Vec<(DVec3, usize)>> = vec![Vec::new(); copies];
    for element in (0..marks.len()).filter(|&element| marks[element]) {
        let corners = body.placed.mesh.element(element);
        let copy = corners[0] as usize / nodes;
        // where the first copy has it: rounding makes no copy go otherwise than another
        let sum: DVec3 = corners.iter().map(|&node| points[node as usize - copy * nodes]).sum();
        marked[copy].push((sum / corners.len() as f64, element));
    }
    let mut times = vec![start; marks.len()];
    for of_copy in marked {
        let center = of_copy.iter().map(|(place, _)| *place).sum::<DVec3>() / of_copy.len() as f64;
        let mut sorted: Vec<(f64, usize)> =
            of_copy.iter().map(|(place, element)| (place.distance_squared(center), *element)).collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let last = sorted.len().saturating_sub(1).max(1) as f64;
        for (rank, (_, element)) in sorted.into_iter().enumerate() {
            times[element] = start + (end - start) * rank as f64 / last;
        }
    }
    times
}

fn by_criterion(body: &BodyParts, on: &Select, marks: &[bool], measure: Measure, limit: f64, world: &mut World) {
    for (place, &block) in body.blocks.iter().enumerate() {
        let members = body.element_rows.iter().zip(marks).filter(|((block, _), _)| *block as usize == place);
        let mut rows: Vec<u32> = members.filter(|(_, marked)| **marked).map(|((_, row), _)| *row).collect();
        if rows.is_empty() {
            continue;
        }
        rows.sort_unstable();
        if *on == Select::All {
            rows.clear();
        }
        world.spawn((RemovalCriterion { block, rows, measure, limit }, OfBody(body.entity)));
    }
}
