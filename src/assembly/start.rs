//! Where nodes are at the start.

use super::Assembly;
use crate::backend::cpu::BlockLaw;
use crate::components::*;
use crate::evaluation::ElementState;
use crate::materials::J_FLOOR;
use crate::math::noise;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Inversion, Start, laws_that_recover};
use bevy_ecs::prelude::*;
use glam::{DMat3, DVec3};

/// Elements that a complaint names.
const NAMED: usize = 10;

/// Moves the nodes of bodies with a `start` of their own, and looks whether their elements bear it. A static analysis
/// starts at rest.
pub(super) fn deform(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    if assembly.scene.scene.is_static() {
        return;
    }
    for (name, parts) in &assembly.bodies {
        let Some(start) = assembly.scene.scene.bodies[name].start else { continue };
        let mut query = world.query::<(&RestPosition, &ConstrainedAxes, &mut Displacement)>();
        let Ok((rest, axes, mut u)) = query.get_mut(world, parts.entity) else { continue };
        for (node, &row) in parts.node_rows.iter().enumerate() {
            let row = row as usize;
            let free = DVec3::from_array([0, 1, 2].map(|axis| f64::from(1 - (axes[row] >> axis & 1))));
            u.set_vector(row, free * displacement(&start, node as u64, rest.0[row]));
        }
        complain(name, parts.entity, world, diagnostics);
    }
}

/// Where a node of the author's goes (m), from its number and place at rest.
fn displacement(start: &Start, node: u64, rest: DVec3) -> DVec3 {
    match *start {
        Start::Affine { gradient: [x, y, z], center } => DMat3::from_cols(x, y, z).transpose() * (rest - center),
        Start::Scrambled { amplitude, seed } => {
            let number = |axis: u64| 2.0 * noise(seed.wrapping_mul(0x9e37).wrapping_add(3 * node + axis)) - 1.0;
            amplitude * DVec3::new(number(0), number(1), number(2))
        }
    }
}

/// Elements that start flat or inside out are an error where they stop the run, and worth a warning where they are
/// removed.
fn complain(name: &str, body: Entity, world: &World, diagnostics: &mut Diagnostics) {
    let (Some(authoring), Some(u)) = (world.get::<Authoring>(body), world.get::<Displacement>(body)) else { return };
    for (place, &block) in authoring.blocks.iter().enumerate() {
        let policy = world.get::<OnInversion>(block).map_or(Inversion::Stop, |policy| policy.0);
        let (Some(data), Some(law)) = (world.get::<Block>(block), world.get::<BlockLaw<f64>>(block)) else { continue };
        let (Some(nodes), Some(shape)) = (world.get::<Connectivity>(block), world.get::<RestShape>(block)) else {
            continue;
        };
        if policy == Inversion::Recover {
            continue;
        }
        let mut found: Vec<(u64, f64)> = Vec::new();
        for row in 0..data.count {
            let state = ElementState::of(data, row, nodes, shape, u, law.elastic_of(row));
            let least = state.points().iter().map(|p| p.kinematics.true_j).fold(f64::INFINITY, f64::min);
            if least < J_FLOOR || !least.is_finite() {
                found.push((authoring.element_id(place, row), least));
            }
        }
        if found.is_empty() {
            continue;
        }
        found.sort_by_key(|&(element, _)| element);
        let each: Vec<String> = found.iter().take(NAMED).map(|(element, j)| format!("{element} (J {j:.2})")).collect();
        let more = match found.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let elements = if found.len() == 1 { "element starts" } else { "elements start" };
        let message = format!("{} {elements} flat or inside out: {}{more}", found.len(), each.join(", "));
        let path = format!("bodies.\"{name}\".start");
        match policy {
            Inversion::Remove => diagnostics.warn_at(path.as_str(), message).note("they are removed in the first step"),
            _ => diagnostics.error_at(path.as_str(), message).note(format!(
                "start from less, or choose a material that recovers: {}",
                laws_that_recover().join(", ")
            )),
        };
    }
}
