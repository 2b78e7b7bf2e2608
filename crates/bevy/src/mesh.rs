//! Bodies as meshes: their surface, or the skin that they carry, moved along.

use crate::simulation::*;
use bevy_asset::{Assets, RenderAssetUsages};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_mesh::{Indices, Mesh, Mesh3d, PrimitiveTopology, VertexAttributeValues};
use bevy_time::{Fixed, Time};
use sinew::glam::DVec3;
use sinew::{Error, Simulation};

/// Where points are.
#[derive(Clone, Default, PartialEq)]
struct Places {
    /// (m)
    at: Vec<Vec3>,
    /// Outward normals of a skin, of length 1: where texture coordinates differ at a place it has several points, with
    /// one normal. Nothing of nodes.
    normals: Vec<Vec3>,
}

/// What is drawn of a body in the last two ticks: its skin if it has one, else its surface.
#[derive(Component)]
pub(crate) struct BodyShape {
    /// Whether it is its skin.
    of_skin: bool,
    /// Where its points were: nodes in the author's order, or points of its skin.
    before: Places,
    /// Where they are.
    now: Places,
    /// Texture coordinates of points, from the top left corner of the picture; nothing where there are none.
    texture: Vec<[f32; 2]>,
    /// The point of each vertex.
    nodes: Vec<u32>,
    /// Triangles of vertices.
    triangles: Vec<u32>,
    /// Elements that are left.
    pub left: usize,
    /// Whether triangles are others than those of the mesh.
    new_triangles: bool,
    /// Whether the mesh is where the nodes are, and these stand still.
    at_rest: bool,
}

impl BodyShape {
    /// That of a body as it is.
    pub fn of(simulation: &mut Simulation, body: &str) -> Result<Self, Error> {
        let of_skin = simulation.scene().bodies.get(body).is_some_and(|body| body.skin.is_some());
        let left = simulation.elements_left(body)?;
        let Points { places, triangles, texture } = Points::of(simulation, body, of_skin, true)?;
        let mut shape = Self {
            of_skin,
            before: places.clone(),
            now: places,
            texture,
            nodes: Vec::new(),
            triangles: Vec::new(),
            left,
            new_triangles: false,
            at_rest: false,
        };
        shape.take_triangles(&triangles);
        Ok(shape)
    }

    /// Vertices are points of triangles, each once.
    fn take_triangles(&mut self, triangles: &[[u32; 3]]) {
        let mut vertices = vec![u32::MAX; self.now.at.len()];
        self.nodes.clear();
        self.triangles.clear();
        for &node in triangles.as_flattened() {
            let vertex = &mut vertices[node as usize];
            if *vertex == u32::MAX {
                *vertex = self.nodes.len() as u32;
                self.nodes.push(node);
            }
            self.triangles.push(*vertex);
        }
    }

    /// Goes on to the body as it is now; whether elements have gone or come back. `anew`: no steps have led there. Then
    /// it was nowhere else before, and others may be left that are as many.
    pub fn update(&mut self, simulation: &mut Simulation, body: &str, anew: bool) -> Result<bool, Error> {
        let left = simulation.elements_left(body)?;
        let others = left != self.left;
        let Points { places, triangles, .. } = Points::of(simulation, body, self.of_skin, others || anew)?;
        self.before = if anew { places.clone() } else { std::mem::take(&mut self.now) };
        self.now = places;
        if others || anew {
            self.left = left;
            self.take_triangles(&triangles);
            self.new_triangles = true;
        }
        self.at_rest = false;
        Ok(others)
    }

    /// Stays where it is.
    pub fn stand_still(&mut self) {
        if self.before != self.now {
            self.before.clone_from(&self.now);
            self.at_rest = false;
        }
    }

    /// Vertices at a share of the way between the last two ticks.
    fn vertices(&self, share: f32) -> impl Iterator<Item = [f32; 3]> {
        let (before, now) = (&self.before.at, &self.now.at);
        self.nodes.iter().map(move |&node| before[node as usize].lerp(now[node as usize], share).to_array())
    }

    /// Gives a mesh whose vertices are there its normals: those of the skin, between the last two ticks, too.
    fn set_normals(&self, mesh: &mut Mesh, share: f32) {
        let (before, now) = (&self.before.normals, &self.now.normals);
        let known = !now.is_empty() && before.len() == now.len();
        if !known {
            // by area: Bevy's smooth normals, by angle, are 0 where edges are shorter than some 2 cm; a mesh that has
            // gone to the device for good has none to make
            let _ = mesh.try_compute_area_weighted_normals();
            return;
        }
        let between = |&node: &u32| {
            let (before, now) = (before[node as usize], now[node as usize]);
            before.lerp(now, share).normalize_or(now).to_array()
        };
        let normals: Vec<[f32; 3]> = self.nodes.iter().map(between).collect();
        let _ = mesh.try_insert_attribute(Mesh::ATTRIBUTE_NORMAL, normals);
    }

    /// The mesh at a share of the way between the last two ticks.
    pub fn mesh(&self, share: f32) -> Mesh {
        let positions: Vec<[f32; 3]> = self.vertices(share).collect();
        let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
            .with_inserted_indices(Indices::U32(self.triangles.clone()));
        self.set_normals(&mut mesh, share);
        let texture: Vec<[f32; 2]> = self.nodes.iter().filter_map(|&n| self.texture.get(n as usize).copied()).collect();
        if !self.texture.is_empty() && texture.len() == self.nodes.len() {
            mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, texture);
        }
        mesh
    }

    /// Moves the vertices of a mesh, in place where they are as many.
    fn write(&mut self, mesh: &mut Mesh, share: f32) {
        match mesh.try_attribute_mut(Mesh::ATTRIBUTE_POSITION) {
            Ok(VertexAttributeValues::Float32x3(places)) if !self.new_triangles && places.len() == self.nodes.len() => {
                places.iter_mut().zip(self.vertices(share)).for_each(|(place, vertex)| *place = vertex);
                self.set_normals(mesh, share);
            }
            _ => {
                *mesh = self.mesh(share);
                self.new_triangles = false;
            }
        }
        self.at_rest = self.before == self.now;
    }
}

/// What is drawn of a body as it is now.
struct Points {
    places: Places,
    /// By points; nothing where nobody asks for them.
    triangles: Vec<[u32; 3]>,
    texture: Vec<[f32; 2]>,
}

impl Points {
    /// Of its skin, or of its nodes in the author's order.
    fn of(simulation: &mut Simulation, body: &str, of_skin: bool, triangles: bool) -> Result<Self, Error> {
        let single = |vectors: Vec<DVec3>| vectors.into_iter().map(|vector| vector.as_vec3()).collect();
        if of_skin {
            let skin = simulation.skin(body)?;
            // v goes upwards in meshes of files, and downwards in Bevy
            let texture = skin.texture.into_iter().map(|[u, v]| [u, 1.0 - v]).collect();
            let places = Places { at: single(skin.points), normals: single(skin.normals) };
            return Ok(Self { places, triangles: skin.triangles, texture });
        }
        let triangles = if triangles { simulation.surface_triangles(body)? } else { Vec::new() };
        let places = Places { at: single(simulation.positions(body)?), normals: Vec::new() };
        Ok(Self { places, triangles, texture: Vec::new() })
    }
}

/// Writes meshes for this frame: between the last two ticks, as far as the frame is between them.
pub(crate) fn write_meshes(
    time: Res<Time<Fixed>>,
    mut bodies: Query<(&mut BodyShape, &Mesh3d), With<SoftBody>>,
    mut meshes: ResMut<Assets<Mesh>>,
) {
    let share = time.overstep_fraction().clamp(0.0, 1.0);
    for (mut shape, handle) in bodies.iter_mut().filter(|(shape, _)| !shape.at_rest) {
        let Some(mut mesh) = meshes.get_mut(&handle.0) else { continue };
        shape.write(&mut mesh, share);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::SceneText;
    use sinew::{BackendChoice, Options};

    /// A cube that falls, and loses elements at 0.05 s.
    const CUBE: &str = r#"(
        duration: 1,
        bodies: {"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Hex8), material: "gel")},
        materials: {"gel": (density: 1000, neo_hookean: Young(young: 20000, poisson: 0.4))},
        loads: [Gravity(acceleration: (0, 0, -9.81))],
        removal: [(on: Sphere(center: (0.1, 0.1, 0.1), radius: 0.09), when: At(0.05))],
    )"#;

    #[test]
    fn a_mesh_that_loses_triangles_or_is_made_anew_is_between_two_ticks_like_others() {
        let scene = SceneText::new("cube", CUBE).read(&[]).unwrap();
        let options = Options { backend: BackendChoice::Cpu, threads: 1, grabs: true, ..Options::default() };
        let mut simulation = Simulation::new(&scene, &options).unwrap();
        let mut shape = BodyShape::of(&mut simulation, "cube").unwrap();
        let mut mesh = shape.mesh(1.0);
        let at = |mesh: &Mesh| match mesh.attribute(Mesh::ATTRIBUTE_POSITION) {
            Some(VertexAttributeValues::Float32x3(places)) => places.clone(),
            _ => Vec::new(),
        };
        simulation.advance_to(0.04).unwrap();
        assert!(!shape.update(&mut simulation, "cube", false).unwrap());
        simulation.advance_to(0.06).unwrap();
        assert!(shape.update(&mut simulation, "cube", false).unwrap(), "elements have gone");
        shape.write(&mut mesh, 0.25);
        assert_eq!(at(&mesh), shape.vertices(0.25).collect::<Vec<_>>());
        assert!(at(&mesh) != shape.vertices(1.0).collect::<Vec<_>>());
        // without steps between there is nothing on the way, and triangles are asked for again
        simulation.reset().unwrap();
        assert!(shape.update(&mut simulation, "cube", true).unwrap(), "they have come back");
        assert!(!shape.update(&mut simulation, "cube", true).unwrap() && shape.new_triangles);
        assert!(shape.before == shape.now);
    }
}
