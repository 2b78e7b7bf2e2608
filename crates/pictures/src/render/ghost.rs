//! Surfaces at rest.

use super::RenderError;
use super::frame::{FieldAssociation, FrameFile};
use super::normals::creases;
use super::picture::{Colouring, Layer, Lines};
use super::raster::Finish;
use super::skins::Skins;
use super::surface::Faces;
use glam::Vec3;

/// What is seen of bodies, at rest: their faces, or the skins that they have.
pub struct Ghosts {
    all: Vec<Ghost>,
}

struct Ghost {
    vertices: Vec<Vec3>,
    faces: Vec<[u32; 4]>,
    /// Which of their sides are edges of the shape.
    creases: Vec<u8>,
}

impl Ghost {
    fn new(vertices: Vec<Vec3>, faces: Vec<[u32; 4]>) -> Ghost {
        Ghost { creases: creases(&vertices, &faces), vertices, faces }
    }
}

impl Ghosts {
    /// Of a series that begins with a frame: places of its points (m), and the faces of what the bodies began with.
    pub fn new(first: &FrameFile, points: &[Vec3], began: &Faces, skins: &Skins) -> Result<Ghosts, RenderError> {
        let skins = skins.of_frame(first)?;
        let bodies = first.entry(FieldAssociation::Points, "body").filter(|_| !skins.is_empty());
        let bodies = bodies.map(|entry| first.integers(entry)).transpose()?.unwrap_or_default();
        let of_body = |point: u32| bodies.get(point as usize).map_or(0, |body| *body as u32);
        let mut faces: Vec<[u32; 4]> = began.surface(|_| Some(0), None).iter().map(|face| face.points).collect();
        faces.retain(|face| !skins.iter().any(|skin| skin.body == of_body(face[0])));
        let of_skins = skins.into_iter().map(|skin| Ghost::new(skin.rest, skin.faces));
        Ok(Ghosts { all: std::iter::once(Ghost::new(points.to_vec(), faces)).chain(of_skins).collect() })
    }

    /// A layer of each.
    pub fn layers(&self) -> impl Iterator<Item = Layer<'_>> {
        self.all.iter().map(|ghost| Layer {
            vertices: &ghost.vertices,
            faces: &ghost.faces,
            values: Colouring::Nothing,
            finish: Finish::Ghost,
            lines: Lines::Sides(&ghost.creases),
            normals: &[],
            flat: None,
            cut: true,
        })
    }

    /// The corners of all faces (m).
    pub fn corners(&self) -> impl Iterator<Item = Vec3> {
        self.all.iter().flat_map(|ghost| ghost.faces.iter().flatten().map(|point| ghost.vertices[*point as usize]))
    }
}
