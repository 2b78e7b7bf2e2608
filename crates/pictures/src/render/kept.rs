//! What an output folder keeps of the files that pictures need: those of the scene may have changed when the run is
//! drawn, or be elsewhere.

use glam::DVec3;
use sinew::SceneFile;
use sinew::mesh::Triangles;
use sinew::output::{Folder, OutputError, SurfaceFrame, replace, write_surface};
use sinew::scene::schema::SkinFormat;
use std::io::Write;

/// The name of the file with the triangles of a tool, in the lengths of the scene's file.
pub(super) fn tool_file(name: &str) -> String {
    format!("tool_{name}.ply")
}

/// The name of the file with the picture on the skin of a body.
pub fn image_file(body: &str) -> String {
    format!("skin_{body}.png")
}

/// Keeps the triangles of all tools and the pictures on skins in the output folder of a run. What cannot be read, or
/// has a name that no file can have, is left out: it is drawn from the scene's own file, where that is found.
///
/// # Errors
/// What the system says.
pub fn keep(scene: &SceneFile, folder: &mut Folder) -> Result<(), OutputError> {
    for (name, tool) in &scene.scene.tools {
        let Some(mesh) = &tool.mesh else { continue };
        let Ok(Triangles { points, triangles, .. }) = scene.surface(&mesh.path) else { continue };
        let Ok(path) = folder.claim(&tool_file(name)) else { continue };
        // a row each; nobody reads normals of tools
        let normals = vec![DVec3::ZERO; points.len()];
        let (points, normals, triangles) = (&*points, &*normals, &*triangles);
        let surface = SurfaceFrame { time: 0.0, points, normals, texture: &[], triangles };
        write_surface(&path, SkinFormat::Ply, &surface)?;
    }
    for (name, body) in &scene.scene.bodies {
        let Some(image) = body.skin.as_ref().and_then(|skin| skin.image.as_ref()) else { continue };
        let Ok(bytes) = scene.bytes(image, u64::MAX) else { continue };
        let Ok(path) = folder.claim(&image_file(name)) else { continue };
        replace(&path, |file| file.write_all(&bytes).map_err(OutputError::system("write", &path)))?;
    }
    Ok(())
}
