//! Removal: what goes by time gets its step, what goes by criterion its limit.

use super::{Assembly, BodyParts, select, tool_removal};
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
                let ranks = ranks_from_center(body, &marks);
                let last = ranks.iter().max().copied().unwrap_or(0).max(1) as f64;
                by_time(body, &marks, time_step, world, |element| {
                    start + (end - start) * f64::from(ranks[element]) / last
                });
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

/// For each marked element, how many lie nearer to the marked ones' centroid.
fn ranks_from_center(body: &BodyParts, marks: &[bool]) -> Vec<u32> {
    let marked: Vec<usize> = (0..marks.len()).filter(|&element| marks[element]).collect();
    let centroid = |&element: &usize| select::centroid(&body.placed, element);
    let center = marked.iter().map(centroid).sum::<DVec3>() / marked.len() as f64;
    let mut sorted: Vec<(f64, usize)> =
        marked.iter().map(|element| (centroid(element).distance_squared(center), *element)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut ranks = vec![0; marks.len()];
    for (rank, (_, element)) in sorted.into_iter().enumerate() {
        ranks[element] = rank as u32;
    }
    ranks
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
