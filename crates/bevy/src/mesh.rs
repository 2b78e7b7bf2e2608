//! Bodies as meshes: their surface, moved along.

use crate::simulation::*;
use bevy_asset::{Assets, RenderAssetUsages};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_mesh::{Indices, Mesh, Mesh3d, PrimitiveTopology, VertexAttributeValues};
use bevy_time::{Fixed, Time};
use sinew::{Error, Simulation};

/// The surface of a body in the last two ticks.
#[derive(Component)]
pub(crate) struct BodyShape {
    /// Where its nodes were (m), in the author's order.
    before: Vec<Vec3>,
    /// Where they are.
    now: Vec<Vec3>,
    /// The node of each vertex.
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
        let now = positions(simulation, body)?;
        let left = simulation.elements_left(body)?;
        let mut shape = Self {
            before: now.clone(),
            now,
            nodes: Vec::new(),
            triangles: Vec::new(),
            left,
            new_triangles: false,
            at_rest: false,
        };
        shape.take_triangles(&simulation.surface_triangles(body)?);
        Ok(shape)
    }

    /// Vertices are nodes of the surface, each once.
    fn take_triangles(&mut self, triangles: &[[u32; 3]]) {
        let mut vertices = vec![u32::MAX; self.now.len()];
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

    /// Goes on to the body as it is now; whether elements have gone or come back.
    pub fn update(&mut self, simulation: &mut Simulation, body: &str) -> Result<bool, Error> {
        self.before = std::mem::replace(&mut self.now, positions(simulation, body)?);
        let left = simulation.elements_left(body)?;
        let others = left != self.left;
        if others {
            self.left = left;
            self.take_triangles(&simulation.surface_triangles(body)?);
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
        let vertex = move |&node: &u32| self.before[node as usize].lerp(self.now[node as usize], share).to_array();
        self.nodes.iter().map(vertex)
    }

    /// The mesh.
    pub fn mesh(&self) -> Mesh {
        let positions: Vec<[f32; 3]> = self.vertices(1.0).collect();
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
            .with_inserted_indices(Indices::U32(self.triangles.clone()))
            .with_computed_area_weighted_normals()
    }

    /// Moves the vertices of a mesh, in place where they are as many.
    fn write(&mut self, mesh: &mut Mesh, share: f32) {
        match mesh.try_attribute_mut(Mesh::ATTRIBUTE_POSITION) {
            Ok(VertexAttributeValues::Float32x3(places)) if !self.new_triangles && places.len() == self.nodes.len() => {
                places.iter_mut().zip(self.vertices(share)).for_each(|(place, vertex)| *place = vertex);
            }
            _ => {
                *mesh = self.mesh();
                self.new_triangles = false;
            }
        }
        // by area: Bevy's smooth normals, by angle, are 0 where edges are shorter than some 2 cm; a mesh that has gone
        // to the device for good has none to make
        let _ = mesh.try_compute_area_weighted_normals();
        self.at_rest = self.before == self.now;
    }
}

/// Where a body's nodes are (m), in the author's order.
fn positions(simulation: &mut Simulation, body: &str) -> Result<Vec<Vec3>, Error> {
    Ok(simulation.positions(body)?.into_iter().map(|place| place.as_vec3()).collect())
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
