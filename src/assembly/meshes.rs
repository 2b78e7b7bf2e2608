//! Meshes of a scene's bodies: made or read, placed, and checked.

use crate::mesh::{Mesh, MeshError, SurfaceFace, generators};
use crate::scene::SceneFile;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Body, MeshSource, Select};
use glam::DVec3;
use std::borrow::Cow;
use std::sync::OnceLock;

/// A mesh where the author wants it, with its surface when somebody asks for it.
pub struct PlacedMesh {
    /// The mesh at rest, in the author's numbering.
    pub mesh: Mesh,
    /// Where its points are in the shape in which selections are made, where that is another one.
    shown: Option<Vec<DVec3>>,
    surface: OnceLock<Vec<SurfaceFace>>,
}

impl PlacedMesh {
    /// The faces that belong to one element only, outward normals by the right hand.
    pub fn surface(&self) -> &[SurfaceFace] {
        self.surface.get_or_init(|| self.mesh.surface())
    }

    /// Where points are (m) in the shape in which selections are made: that of the scene's mesh.
    pub fn points(&self) -> &[DVec3] {
        self.shown.as_ref().unwrap_or(&self.mesh.points)
    }

    /// Whether selections are made in another shape than that at rest.
    pub(super) fn is_shown_elsewhere(&self) -> bool {
        self.shown.is_some()
    }

    /// Points and elements in the shape in which selections are made; of the whole mesh where that is the one at rest.
    pub(super) fn as_shown(&self) -> Cow<'_, Mesh> {
        match &self.shown {
            None => Cow::Borrowed(&self.mesh),
            Some(points) => {
                Cow::Owned(Mesh { points: points.clone(), cells: self.mesh.cells.clone(), ..Mesh::default() })
            }
        }
    }

    /// The lowest and the largest coordinates there (m).
    pub fn extent(&self) -> (DVec3, DVec3) {
        crate::mesh::extent(self.points().iter().copied())
    }

    /// Length of the bounding box's diagonal (m).
    pub fn size(&self) -> f64 {
        let (low, high) = self.extent();
        (high - low).length()
    }
}

/// Makes or reads the mesh of a body of `scene`, with all its copies, and places it.
///
/// # Errors
/// What is wrong with the file or the parameters; more elements than the scene is allowed.
pub fn mesh_of(body: &Body, scene: &SceneFile) -> Result<Mesh, MeshError> {
    let mut mesh = one_copy_of(body, scene)?;
    mesh.repeat(body.copies, body.apart);
    Ok(mesh)
}

/// The same without copies.
fn one_copy_of(body: &Body, scene: &SceneFile) -> Result<Mesh, MeshError> {
    let mut mesh = match &body.mesh {
        MeshSource::File { path, flip_inverted, .. } => mesh_file(scene, path, *flip_inverted)?,
        MeshSource::Box { size, cells, elements } => generators::box_mesh(*size, *cells, *elements)?,
        MeshSource::Cylinder { radius, height, across, along, elements } => {
            generators::cylinder_mesh(*radius, *height, *across, *along, *elements)?
        }
        MeshSource::Ellipsoid { radii, across, elements } => generators::ellipsoid_mesh(*radii, *across, *elements)?,
        MeshSource::Hexahedron { corners, cells, elements } => {
            generators::hexahedron_mesh(*corners, *cells, *elements)?
        }
        MeshSource::Tube { inner, outer, height, angle, cells, elements } => {
            generators::tube_mesh(*inner, *outer, *height, *angle, *cells, *elements)?
        }
        MeshSource::Lens { diameter, thickness, across, through, elements } => {
            generators::lens_mesh(*diameter, *thickness, *across, *through, *elements)?
        }
    };
    let cells = 8_u64.saturating_pow(body.refine).saturating_mul(body.copies.into());
    let elements = (mesh.element_count() as u64).saturating_mul(cells);
    // points without elements are copied too
    let points = (mesh.points.len() as u64).saturating_mul(body.copies.into()) / 8;
    if elements.max(points) > scene.allowed.elements {
        return Err(too_many(elements.max(points), scene));
    }
    if body.refine > 0 {
        let rows = mesh.point_rows();
        let lists = scene.scene.selections().flat_map(Select::lists_of_nodes);
        lists.for_each(|numbers| mesh.keep_list(numbers, &rows));
    }
    mesh.refine(body.refine)?;
    mesh.place(body.scale, body.rotate, body.translate)?;
    Ok(mesh)
}

/// The mesh of a name: a program's, or what a file holds, if the scene may read it.
fn mesh_file(scene: &SceneFile, name: &str, flip_inverted: bool) -> Result<Mesh, MeshError> {
    if let Some(mesh) = scene.meshes.get(name) {
        mesh.require_sound(name)?;
        return Ok(Mesh::clone(mesh));
    }
    let path = scene.file(name).unwrap_or_else(|_| name.into());
    match scene.bytes(name, u64::MAX) {
        Ok(bytes) => Mesh::from_bytes(path, &bytes, flip_inverted),
        Err(source) => Err(MeshError::Unreadable { file: path, source }),
    }
}

fn too_many(elements: u64, scene: &SceneFile) -> MeshError {
    let allowed = format!("at most {} are allowed in all bodies together", scene.allowed.elements);
    MeshError::Parameter { name: "the mesh", parameter: "number of elements", value: elements.to_string(), allowed }
}

/// Where the points of a body's mesh are at rest (m), if that is not where the mesh has them.
fn rest_points(name: &str, body: &Body, scene: &SceneFile, mesh: &Mesh) -> Result<Option<Vec<DVec3>>, String> {
    let (points, of) = match (scene.rest_shapes.get(name), &body.rest_shape) {
        (Some(points), _) => (points.clone(), "given"),
        (None, None) => return Ok(None),
        (None, Some(file)) => {
            let rest = mesh_file(scene, file, false).map_err(|error| error.to_string())?;
            if rest.cells != mesh.cells {
                return Err(format!(
                    "the elements of {file} are not those of the mesh: a rest shape has the same points and elements in the \
                     same order, after `refine` and `copies`"
                ));
            }
            (rest.points, file.as_str())
        }
    };
    let (found, wanted) = (points.len(), mesh.points.len());
    match found == wanted {
        true => Ok(Some(points)),
        false => Err(format!("the rest shape ({of}) has {found} points, the mesh has {wanted}")),
    }
}

/// The meshes of all bodies; complaints of all of them.
pub(super) fn meshes(scene: &SceneFile, diagnostics: &mut Diagnostics) -> Vec<(String, PlacedMesh)> {
    let mut all = 0;
    let mut meshes = Vec::new();
    for (name, body) in &scene.scene.bodies {
        let path = format!("bodies.\"{name}\".mesh");
        if diagnostics.has_error_in(path.as_str()) {
            continue;
        }
        match one_copy_of(body, scene) {
            Err(error) => {
                diagnostics.error_at(path.as_str(), error.to_string());
            }
            Ok(mut mesh) => {
                all += (mesh.element_count() as u64).saturating_mul(body.copies.into());
                if all > scene.allowed.elements {
                    diagnostics.error_at(path.as_str(), too_many(all, scene).to_string());
                    break;
                }
                let soundness = mesh.soundness();
                for finding in &soundness.errors {
                    diagnostics.error_at(path.as_str(), format!("the mesh of {name}: {}", finding));
                }
                for finding in &soundness.warnings {
                    diagnostics.warn_at(path.as_str(), format!("the mesh of {name}: {}", finding));
                }
                for note in &mesh.notes {
                    diagnostics.warn_at(path.as_str(), format!("the mesh of {name}: {note}"));
                }
                mesh.repeat(body.copies, body.apart);
                let shown = match rest_points(name, body, scene, &mesh) {
                    Ok(rest) => rest.map(|rest| std::mem::replace(&mut mesh.points, rest)),
                    Err(message) => {
                        diagnostics.error_at(format!("bodies.\"{name}\".rest_shape").as_str(), message);
                        continue;
                    }
                };
                if shown.is_some() {
                    for finding in &mesh.soundness().errors {
                        let message = format!("the rest shape of {name}: {finding}");
                        diagnostics.error_at(format!("bodies.\"{name}\"").as_str(), message);
                    }
                }
                meshes.push((name.clone(), PlacedMesh { mesh, shown, surface: OnceLock::new() }));
            }
        }
    }
    meshes
}
