//! What is tied where meshes have the bodies, and how far their rest shapes have it apart.

use super::{Assembly, BodyParts, edge};
use crate::components::*;
use crate::scene::diagnostic::Diagnostics;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;

/// Tells of what rest shapes have apart by more than an edge of a face: the first step on the way to rest would draw it
/// together. Rest shapes that are found with the ties keep together what these hold, since sums of places that fulfil
/// them do.
pub(super) fn check(assembly: &Assembly<'_>, glue: &Glue, world: &World, diagnostics: &mut Diagnostics) {
    let bodies: Vec<&BodyParts> = assembly.bodies.values().collect();
    let mut farthest: BTreeMap<usize, (f64, [usize; 2])> = BTreeMap::new();
    for tie in &glue.ties {
        if !tie.bodies.iter().any(|&body| bodies[body].placed.is_shown_elsewhere()) {
            continue;
        }
        let [of, onto] = tie.bodies.map(|body| world.get::<RestPosition>(glue.bodies[body]));
        let (Some(of), Some(onto)) = (of, onto) else { continue };
        let apart = place(of, tie.nodes.iter().copied()).distance(place(onto, tie.bearers())) - tie.gap.length();
        let found = farthest.entry(tie.number).or_insert((0.0, tie.bodies));
        found.0 = found.0.max(apart);
    }
    for (number, (apart, tied)) in farthest {
        let [of, onto] = tied.map(|body| edge(bodies[body]));
        let most = of.max(onto);
        if apart > most {
            let message = format!("rest shapes have what is to be tied {apart:.3e} m apart");
            diagnostics.error_at(format!("attachments[{number}]").as_str(), message).note(format!(
                "up to an edge of a face, {most:.3e} m, it is drawn together; `sinew unload` of the scene with it \
                 finds rest shapes that keep it together"
            ));
        }
    }
}

/// Where a sum of nodes is at rest (m).
fn place(rest: &RestPosition, nodes: impl Iterator<Item = (u32, f64)>) -> DVec3 {
    nodes.map(|(row, weight)| rest.0[row as usize] * weight).sum()
}
