//! Constraints: selections become rows and bits.

use super::Assembly;
use crate::components::*;
use crate::math::radians;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Axis, Constraint, Curve, InitialState};
use bevy_ecs::prelude::*;
use glam::{DMat3, DVec3};
use std::collections::HashMap;

/// Spawns all constraints and marks the axes they take.
pub(super) fn spawn(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    // of each body the axes along which `Prescribed` moves its nodes
    let mut moved: HashMap<Entity, Vec<u32>> = HashMap::new();
    for (number, constraint) in assembly.scene.scene.constraints.iter().enumerate() {
        let (Constraint::Fixed { body, on, axes } | Constraint::Prescribed { body, on, axes, .. }) = constraint;
        let Some(body) = assembly.body(body) else { continue };
        let path = format!("constraints[{number}].on");
        let Some(picked) = assembly.pick(body, on, &path, diagnostics) else { continue };
        let marks = match picked.nodes(&body.placed) {
            Ok(marks) => marks,
            Err(problem) => {
                diagnostics.error_at(path.as_str(), problem.message).notes(problem.notes);
                continue;
            }
        };
        let rows = body.rows_of(&marks);
        let axes = axes.iter().fold(0, |bits, &axis| bits | bit(axis));
        let taken = world.get_mut::<ConstrainedAxes>(body.entity).map_or(0, |mut all| {
            let taken = rows.iter().filter(|&&row| all[row as usize] & axes != 0).count();
            rows.iter().for_each(|&row| all[row as usize] |= axes);
            taken
        });
        match constraint {
            Constraint::Fixed { .. } => {
                let moved = moved.get(&body.entity);
                let taken = |row: &&u32| moved.is_some_and(|moved| moved[**row as usize] & axes != 0);
                let taken = rows.iter().filter(taken).count();
                if taken > 0 {
                    diagnostics.warn_at(
                        format!("constraints[{number}]").as_str(),
                        format!("{taken} of its nodes are moved along the same axes by an earlier one: this one does not hold them"),
                    );
                }
                world.spawn((Fixed { rows, axes }, OfBody(body.entity)));
            }
            Constraint::Prescribed { displacement, gradient, rotation, center, per_copy, curve, .. } => {
                if taken > 0 {
                    diagnostics.warn_at(
                        format!("constraints[{number}]").as_str(),
                        format!("{taken} of its nodes are constrained along the same axes by an earlier one: this one moves them"),
                    );
                }
                let count = world.get::<ConstrainedAxes>(body.entity).map_or(0, |all| all.len());
                let moved = moved.entry(body.entity).or_insert_with(|| vec![0; count]);
                rows.iter().for_each(|&row| moved[row as usize] |= axes);
                let moves = (*displacement, *rotation, *gradient) != (DVec3::ZERO, DVec3::ZERO, [DVec3::ZERO; 3]);
                // a static analysis lets every motion grow smoothly
                let moves = moves && !assembly.scene.scene.is_static();
                if moves && matches!(curve, Curve::Input { rate: None, .. }) {
                    diagnostics
                        .warn_at(
                            format!("constraints[{number}].curve").as_str(),
                            "an input without `rate` moves nodes all at once, in a single step: a shock for the elements beside \
                             them",
                        )
                        .note("bound its change a second: Input(name: ..., rate: ...)");
                }
                // from rest under what acts at t = 0 it is there already
                let from_rest = assembly.scene.scene.start == InitialState::default();
                if moves && from_rest && matches!(curve, Curve::Input { initial, .. } if *initial != 0.0) {
                    diagnostics
                        .warn_at(
                            format!("constraints[{number}].curve").as_str(),
                            "an input that is not 0 at first moves nodes there in the first step, whatever its rate: a shock for \
                             the elements beside them",
                        )
                        .note("let it be 0 at first, or begin at rest there: start: Equilibrium()");
                }
                if moves && matches!(curve, Curve::Step { .. }) {
                    diagnostics
                        .warn_at(
                            format!("constraints[{number}]").as_str(),
                            "the prescribed motion happens all at once, in a single step: a shock for the elements beside it",
                        )
                        .note("let it take time: curve: Smooth(end: ...), Ramp(end: ...) or Table([...])");
                }
                let slopes = DMat3::from_cols(gradient[0], gradient[1], gradient[2]).transpose();
                let mut arms: Vec<DVec3> = world
                    .get::<RestPosition>(body.entity)
                    .map_or(Vec::new(), |rest| rows.iter().map(|&row| rest.0[row as usize] - *center).collect());
                let (mut displacement, mut gradient) = (*displacement, slopes);
                if let Some(per_copy) = per_copy {
                    // each node's own motion is its arm, of which the curve takes a part
                    let factors = per_copy.vectors(&format!("constraints[{number}]"), body.copies);
                    for (arm, factor) in arms.iter_mut().zip(body.of_rows(&rows, &factors)) {
                        *arm = factor * (slopes * *arm + displacement);
                    }
                    (displacement, gradient) = (DVec3::ZERO, DMat3::IDENTITY);
                }
                let rotation = radians(*rotation);
                let curve = curve.clone();
                let signal =
                    world.resource_mut::<Signals>().add(Signal::Motion { curve, displacement, gradient, rotation });
                world.spawn((Prescribed { rows, axes, arms, signal }, OfBody(body.entity)));
            }
        }
    }
}

fn bit(axis: Axis) -> u32 {
    match axis {
        Axis::X => 1,
        Axis::Y => 2,
        Axis::Z => 4,
    }
}
