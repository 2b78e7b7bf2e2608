//! Materials whose parameters are others than those that their blocks were made with.

use super::material;
use crate::backend::cpu::{BlockLaw, LawCopies, PerCopyLaw};
use crate::components::*;
use crate::elements::with_element_of;
use crate::elements::{Element, MOST_NODES};
use crate::materials::{Elastic, ElasticLaw, Fibres};
use crate::math::lane_place;
use crate::scene::schema::Scene;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::sync::Arc;

/// Gives all blocks the laws that their materials have in a scene, in place of those that they have had since it was
/// made: `made` is that scene. The host's columns must be up to date. Blocks that have other laws now, with the law
/// before.
pub fn renew_materials(made: &Scene, now: &Scene, world: &mut World) -> Vec<(Entity, BlockLaw<f64>)> {
    let materials: Vec<(Entity, String)> = world
        .query_filtered::<(Entity, &Label), With<Density>>()
        .iter(world)
        .map(|(entity, label)| (entity, label.0.clone()))
        .collect();
    for (entity, name) in materials {
        if let (Some(made), Some(now)) = (made.materials.get(&name), now.materials.get(&name)) {
            material::renew(&mut world.entity_mut(entity), made, now);
        }
    }
    // bounds at rest are of the materials before
    world.remove_resource::<super::SquaresAtRest>();
    let mut blocks: Vec<Entity> = world.query_filtered::<Entity, With<Block>>().iter(world).collect();
    blocks.sort();
    blocks.iter().for_each(|&entity| renew_copies(entity, (made, now), world));
    blocks.into_iter().filter_map(|entity| Some((entity, renew_block(entity, made, world)?))).collect()
}

/// Takes the parameters that each copy has now, where they differ.
fn renew_copies(entity: Entity, (made, now): (&Scene, &Scene), world: &mut World) {
    let (Some(block), Some(PerCopyLaw(before))) = (world.get::<Block>(entity), world.get(entity)) else { return };
    if let Some(ElasticLaw::CorotationalFrame(law)) = ElasticLaw::of(world.entity(block.material)) {
        let copies = super::frames::with_moduli(before, &law);
        world.entity_mut(entity).insert(PerCopyLaw(Arc::new(copies)));
        return;
    }
    let (Some(body), Some(material)) = (world.get::<Label>(block.body), world.get::<Label>(block.material)) else {
        return;
    };
    let of_copies = material::OfCopies::of(made, now, &body.0, &material.0);
    let Some(of_copy) = of_copies.and_then(|of_copies| of_copies.laws()) else { return };
    let copies = LawCopies::new(of_copy, Arc::clone(&before.copies));
    world.entity_mut(entity).insert(PerCopyLaw(Arc::new(copies)));
}

/// The law before, where it is another now.
fn renew_block(entity: Entity, made: &Scene, world: &mut World) -> Option<BlockLaw<f64>> {
    let (block, before) = (world.get::<Block>(entity)?.clone(), world.get::<BlockLaw<f64>>(entity)?.clone());
    let mut law = before.clone();
    law.elastic = ElasticLaw::of(world.entity(block.material))?;
    if let (Some((fibres, _)), Some(now)) = (&mut law.fibres, world.get::<Fibres<f64>>(block.material)) {
        *fibres = *now;
    }
    let families = world.get::<ExponentialFibres>(block.material);
    for ((family, _), now) in law.exponential.iter_mut().zip(families.iter().flat_map(|families| &families.0)) {
        *family = *now;
    }
    law.copies = super::body_columns::law_copies(world, entity, world.resource::<Clock>());
    if law == before {
        return None;
    }
    let moduli = |law: &BlockLaw<f64>, row: usize| law.elastic_of(row).small_strain_moduli();
    if (0..block.count).any(|row| moduli(&law, row) != moduli(&before, row)) {
        let body = world.get::<Label>(block.body).map(|label| label.0.clone()).unwrap_or_default();
        let hourglass = made.bodies.get(&body).map_or(0.0, |body| body.hourglass);
        scale_hourglass(entity, &block, |row| hourglass * super::body::young(moduli(&law, row)), world);
    }
    let mut entity = world.entity_mut(entity);
    if entity.contains::<BlockLaw<f32>>() {
        entity.insert(law.rounded::<f32>());
    }
    entity.insert(law);
    Some(before)
}

/// Hourglass control is as stiff as the material: its rows of rest shapes, as they were made at first.
fn scale_hourglass(entity: Entity, block: &Block, young: impl Fn(usize) -> f64, world: &mut World) {
    let (Some(rest), Some(connectivity)) = (world.get::<RestPosition>(block.body), world.get::<Connectivity>(entity))
    else {
        return;
    };
    let rows: Vec<(usize, f64)> = with_element_of!(block, E => rows_of::<E>(block, rest, connectivity, young));
    let Some(mut shape) = world.get_mut::<RestShape>(entity) else { return };
    for (place, number) in rows {
        // what has been removed exerts nothing
        if shape.get(place) != 0.0 {
            shape.set(place, number);
        }
    }
}

/// Places in the column of rest shapes and numbers there.
fn rows_of<E: Element>(
    block: &Block,
    rest: &RestPosition,
    connectivity: &Connectivity,
    young: impl Fn(usize) -> f64,
) -> Vec<(usize, f64)> {
    let of_row = |row: usize| {
        let mut points = [DVec3::ZERO; MOST_NODES];
        for (corner, point) in points[..E::NODES].iter_mut().enumerate() {
            *point = rest.0[connectivity[lane_place(row, E::NODES, corner)] as usize];
        }
        let [shape, twice] = [young(row), 2.0 * young(row)].map(|young| E::rest_shape(&points[..E::NODES], young));
        let stiff = (0..E::ROWS).filter(move |&k| shape[k] != twice[k]);
        stiff.map(move |k| (lane_place(row, E::ROWS, k), shape[k]))
    };
    (0..block.count).flat_map(of_row).collect()
}
