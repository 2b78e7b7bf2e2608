//! Skins of bodies: files of triangles, placed as the meshes that carry them.

use super::contacts::bounds;
use super::{Assembly, PlacedMesh};
use crate::components::AlsoWritten;
use crate::mesh::Mesh;
use crate::mesh::Triangles;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Body, SkinFile};
use crate::skins::Skin;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Of what a body measures across the least that its skin may without being warned of.
const SMALLEST: f64 = 0.01;

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
        Ok(mut surface) => {
            if turn_outwards(&mut surface) {
                diagnostics
                    .warn_at(
                        format!("bodies.\"{name}\".skin.file").as_str(),
                        format!("{}: the surface was inside out, and was turned round", file.file),
                    )
                    .note("let corners of triangles go round against the clock as seen from outside");
            }
            fits(name, (&surface.points, placed.points()), diagnostics);
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

/// Turns a closed surface round that is inside out, so that normals go outwards; whether it was. Of an open one nobody
/// knows.
fn turn_outwards(surface: &mut Triangles) -> bool {
    let turns = surface.volume() < 0.0 && surface.edges().is_ok();
    if turns {
        surface.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        surface.texture.iter_mut().for_each(|corners| corners.swap(1, 2));
    }
    turns
}

/// Warns of a skin that cannot be that of its body, as one in millimetres.
fn fits(name: &str, (skin, body): (&[DVec3], &[DVec3]), diagnostics: &mut Diagnostics) {
    let ([low, high], of_skin) = (<[DVec3; 2]>::from(bounds(body)), bounds(skin));
    let (across, own) = (low.distance(high), of_skin.0.distance(of_skin.1));
    let beyond = skin.iter().map(|point| point.distance(point.clamp(low, high))).fold(0.0, f64::max);
    let message = if beyond > across {
        format!("the skin reaches {beyond:.3e} m beyond `{name}`, which measures {across:.3e} m across")
    } else if own < SMALLEST * across {
        format!("the skin measures {own:.3e} m across, and `{name}` {across:.3e} m")
    } else {
        return;
    };
    diagnostics
        .warn_at(format!("bodies.\"{name}\".skin").as_str(), message)
        .note("`scale` of the skin is what its file's numbers are multiplied with: 1e-3 where they are millimetres");
}

/// The surface where the body's mesh is (m).
fn surface(assembly: &Assembly<'_>, body: &Body, skin: &SkinFile) -> Result<Triangles, String> {
    let mut surface = assembly.scene.surface(&skin.file)?;
    let points = std::mem::take(&mut surface.points);
    let mut placed = Mesh { points, ..Mesh::default() };
    placed.points.iter_mut().for_each(|point| *point *= skin.scale);
    placed.place(body.scale, body.rotate, body.translate).map_err(|error| error.to_string())?;
    surface.points = placed.points;
    surface.check_numbers().map_err(|error| format!("{}: {error}", skin.file))?;
    Ok(surface)
}
