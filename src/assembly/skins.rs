//! Skins of bodies: files of triangles, placed as the meshes that carry them.

use super::{Assembly, PlacedMesh};
use crate::components::AlsoWritten;
use crate::mesh::Mesh;
use crate::mesh::Triangles;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Body, SkinFile};
use crate::skins::Skin;
use bevy_ecs::prelude::*;

/// Gives a body its skin, where the scene has one for it.
pub(super) fn insert(
    assembly: &Assembly<'_>,
    name: &str,
    placed: &PlacedMesh,
    body: Entity,
    world: &mut World,
    diagnostics: &mut Diagnostics,
) {
    let described = &assembly.scene.scene.bodies[name];
    let Some(file) = &described.skin else { return };
    match surface(assembly, described, file) {
        Ok(surface) => {
            let mesh = Mesh { points: placed.points().to_vec(), cells: placed.mesh.cells.clone(), ..Mesh::default() };
            let mut body = world.entity_mut(body);
            body.insert(Skin::new(mesh, surface));
            file.also.map(AlsoWritten).into_iter().for_each(|also| _ = body.insert(also));
        }
        Err(message) => {
            diagnostics.error_at(format!("bodies.\"{name}\".skin.file").as_str(), message);
        }
    }
}

/// The surface where the body's mesh is (m).
fn surface(assembly: &Assembly<'_>, body: &Body, skin: &SkinFile) -> Result<Triangles, String> {
    let bytes = assembly.scene.bytes(&skin.file, u64::MAX).map_err(|error| format!("{}: {error}", skin.file))?;
    let beside = |name: &str| assembly.scene.bytes_beside(&skin.file, name);
    let mut surface = Triangles::from_bytes_beside(&skin.file, &bytes, &beside).map_err(|error| error.to_string())?;
    let points = std::mem::take(&mut surface.points);
    let mut placed = Mesh { points, ..Mesh::default() };
    placed.points.iter_mut().for_each(|point| *point *= skin.scale);
    placed.place(body.scale, body.rotate, body.translate).map_err(|error| error.to_string())?;
    surface.points = placed.points;
    surface.check_numbers().map_err(|error| format!("{}: {error}", skin.file))?;
    Ok(surface)
}
