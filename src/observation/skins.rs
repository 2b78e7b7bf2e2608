//! Skins of bodies as they are now.

use super::frame::bodies;
use crate::backend::cpu::Cpu;
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::Error;
use crate::mesh::Cells;
use crate::mesh::topology::MOST_NODES;
use crate::output::{Array, Frame, Series, SurfaceFrame, Values, write_surface};
use crate::skins::{Carrier, Skin, normals};
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::path::Path;

/// A skin at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkinState {
    /// Where its points are before anything moves (m).
    pub rest: Vec<DVec3>,
    /// Where they are (m).
    pub points: Vec<DVec3>,
    /// Outward normals there, of length 1; zero at points of no triangle.
    pub normals: Vec<DVec3>,
    /// Texture coordinates (u, v) there, v upwards; nothing of skins without. Where they differ at a place of the
    /// surface it has several points, with one normal.
    pub texture: Vec<[f32; 2]>,
    /// The triangles that are left, by rows of `points`, the right-hand normal outwards.
    pub triangles: Vec<[u32; 3]>,
    /// The author's number of the element that carries each point; -1 where none is left.
    pub elements: Vec<i64>,
    /// The weights of that element's nodes at each point, 1 together, as far as it has some.
    pub weights: Vec<[f32; MOST_NODES]>,
}

/// The skin of a body; nothing where it has none.
///
/// # Errors
/// What the GPU says.
pub fn skin_of(world: &mut World, body: Entity) -> Result<Option<SkinState>, Error> {
    if world.get::<Skin>(body).is_none() {
        return Ok(None);
    }
    bring_to_host(world, |entity, name| (entity == body && name == Displacement::NAME) || name == Alive::NAME)?;
    let (Some(authoring), Some(rest), Some(moved)) =
        (world.get::<Authoring>(body), world.get::<RestPosition>(body), world.get::<Displacement>(body))
    else {
        return Ok(None);
    };
    let row = |row: &u32| *row as usize;
    let rest: Vec<DVec3> = authoring.node_rows.iter().map(row).map(|row| rest.0[row]).collect();
    let nodes: Vec<DVec3> =
        authoring.node_rows.iter().map(row).zip(&rest).map(|(row, rest)| *rest + moved.vector(row)).collect();
    let lives: Vec<Option<&Alive>> = authoring.blocks.iter().map(|&block| world.get::<Alive>(block)).collect();
    let alive = |(block, row): &(u32, u32)| lives[*block as usize].is_none_or(|alive| alive[*row as usize] != 0);
    let alive: Vec<bool> = authoring.element_rows.iter().map(alive).collect();
    let ids = authoring.element_ids.clone();
    let Some(mut skin) = world.get_mut::<Skin>(body) else { return Ok(None) };
    skin.update_alive(alive);
    let (rest, places) = (skin.places(&rest), skin.places(&nodes));
    let (triangles, pictured): (Vec<_>, Vec<_>) = skin.triangles().into_iter().unzip();
    let normals = normals(&places, &triangles);
    let carriers = skin.embedding().carriers();
    let element = |carrier: &Carrier| ids.of(carrier.element) as i64;
    let weights = |carrier: &Carrier| carrier.weights.map(|weight| weight as f32);
    let rows = || skin.pictured().points.iter().map(|&point| point as usize);
    Ok(Some(SkinState {
        normals: rows().map(|row| normals[row]).collect(),
        elements: rows().map(|row| carriers[row].as_ref().map_or(-1, element)).collect(),
        weights: rows().map(|row| carriers[row].as_ref().map_or([0.0; MOST_NODES], weights)).collect(),
        rest: rows().map(|row| rest[row]).collect(),
        points: rows().map(|row| places[row]).collect(),
        texture: skin.pictured().texture.clone(),
        triangles: pictured,
    }))
}

/// Bodies with a skin and their names, in the order of these.
pub fn with_skins(world: &World) -> Vec<(Entity, String)> {
    let named = world.iter_entities().filter(|entity| entity.contains::<Skin>());
    let mut all: Vec<_> = named.filter_map(|e| Some((e.id(), e.get::<Label>()?.0.clone()))).collect();
    all.sort_by(|a, b| a.1.cmp(&b.1));
    all
}

/// Writes the skins of all bodies that have one, as they are now, into a folder, each as a series of its own: what
/// pictures show of them beside fields.
///
/// # Errors
/// What the GPU says; files that cannot be written.
pub fn write_skins(world: &mut World, folder: &Path) -> Result<(), Error> {
    for (number, (body, _)) in with_skins(world).into_iter().enumerate() {
        // what a body is called need not be the name of a file
        let mut series = Series::named(folder, &format!("skin_{number}"))?;
        write(world, body, &mut series)?;
    }
    Ok(())
}

/// Writes a body's skin as the next frame of its series, and in the other format that the scene asks for.
///
/// # Errors
/// What the GPU says; files that cannot be written.
pub fn write(world: &mut World, body: Entity, series: &mut Series) -> Result<(), Error> {
    let Some(skin) = skin_of(world, body)? else { return Ok(()) };
    let single = |vectors: &mut dyn Iterator<Item = DVec3>| -> Vec<f32> {
        vectors.flat_map(|vector| vector.as_vec3().to_array()).collect()
    };
    let displacement = single(&mut skin.points.iter().zip(&skin.rest).map(|(now, rest)| *now - *rest));
    let normal = single(&mut skin.normals.iter().copied());
    let number = bodies(world).iter().position(|other| *other == body).unwrap_or(0);
    let bodies = vec![number as u32; skin.rest.len()];
    let cells = Cells::triangles(&skin.triangles);
    let mut point_arrays = vec![
        Array { name: "displacement", components: 3, values: Values::F32(&displacement) },
        Array { name: "normal", components: 3, values: Values::F32(&normal) },
        Array { name: "body", components: 1, values: Values::U32(&bodies) },
        Array { name: "element", components: 1, values: Values::I64(&skin.elements) },
        Array { name: "weights", components: MOST_NODES, values: Values::F32(skin.weights.as_flattened()) },
    ];
    if !skin.texture.is_empty() {
        point_arrays.push(Array { name: "texture", components: 2, values: Values::F32(skin.texture.as_flattened()) });
    }
    let time = world.resource::<Clock>().time();
    let frame = Frame { time, points: &skin.rest, cells: &cells, point_arrays, cell_arrays: Vec::new() };
    let path = world.resource::<Cpu>().confine(|| series.write(&frame))?;
    if let Some(&AlsoWritten(format)) = world.get::<AlsoWritten>(body) {
        let SkinState { points, normals, texture, triangles, .. } = &skin;
        let surface = SurfaceFrame { time, points, normals, texture, triangles };
        write_surface(&path.with_extension(format.ending()), format, &surface)?;
    }
    Ok(())
}
