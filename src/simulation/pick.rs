//! Picking: where a ray meets a body's surface, as it is now.

use super::Simulation;
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::Error;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;

/// Barycentric coordinates may be so far below 0: a ray through an edge must not slip between its two triangles.
const ROUNDING: f64 = 1e-9;

/// Where a ray meets a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Pick {
    /// The body's name.
    pub body: String,
    /// The author's number of the element behind the face.
    pub element: u64,
    /// The face's corners, as places in the author's order, counter-clockwise seen from outside; a triangle repeats its
    /// last one.
    pub face: [u32; 4],
    /// The triangle of it that the ray meets: three of its nodes.
    pub nodes: [u32; 3],
    /// Barycentric coordinates of the point in that triangle: the weights of its nodes, which sum up to 1.
    pub weights: [f64; 3],
    /// The point (m).
    pub point: DVec3,
    /// The triangle's outward normal, of length 1.
    pub normal: DVec3,
    /// From the ray's origin (m).
    pub distance: f64,
}

impl Pick {
    /// How far along a ray, of a direction of length 1, a triangle is met (m), from either side, and the weights of its
    /// corners there.
    pub fn meet(origin: DVec3, along: DVec3, [a, b, c]: [DVec3; 3]) -> Option<(f64, [f64; 3])> {
        let (ab, ac) = (b - a, c - a);
        let p = along.cross(ac);
        // six times the volume that the ray spans with both edges: 0 where it runs beside the triangle
        let volume = ab.dot(p);
        let from = origin - a;
        let q = from.cross(ab);
        let (v, w) = (from.dot(p) / volume, along.dot(q) / volume);
        let weights = [1.0 - v - w, v, w];
        let distance = ac.dot(q) / volume;
        // what is no number is not met
        let met = weights.iter().all(|weight| *weight >= -ROUNDING) && distance >= 0.0 && distance.is_finite();
        met.then_some((distance, weights))
    }
}

/// A triangle of a surface.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    nodes: [u32; 3],
    /// Place of the face among those of the surface.
    face: u32,
}

/// A body's surface, and how many of its elements were left then.
pub(super) struct Surface {
    left: Option<u64>,
    faces: Vec<crate::mesh::SurfaceFace>,
    triangles: Vec<Triangle>,
}

impl Simulation {
    /// Where a ray first meets the surface of a body, at the present displacements: from outside or from within. A
    /// quadrilateral face is two triangles; faces that removed elements lay bare count. All faces are tried, some
    /// nanoseconds each; displacements are brought from a GPU where it has newer ones.
    ///
    /// `direction` need not have length 1.
    ///
    /// # Errors
    /// A ray that has no direction, or is no number; what the GPU says.
    pub fn pick(&mut self, origin: DVec3, direction: DVec3) -> Result<Option<Pick>, Error> {
        let along = direction.try_normalize().filter(|along| along.is_finite() && origin.is_finite());
        let Some(along) = along else {
            return Err(Error::Options(format!("a ray from {origin} along {direction} leads nowhere")));
        };
        self.settle()?;
        bring_to_host(&mut self.world, |_, name| [Displacement::NAME, Alive::NAME].contains(&name))?;
        let mut bodies: Vec<(Label, Entity)> = self
            .world
            .query_filtered::<(&Label, Entity), With<Authoring>>()
            .iter(&self.world)
            .map(|(label, body)| (label.clone(), body))
            .collect();
        bodies.sort();
        let mut nearest: Option<Pick> = None;
        for (Label(name), body) in bodies {
            let within = nearest.as_ref().map_or(f64::INFINITY, |pick| pick.distance);
            if let Some(pick) = self.pick_of(&name, body, (origin, along), within) {
                nearest = Some(pick);
            }
        }
        Ok(nearest)
    }

    /// The same for one body, where that is nearer than `within` (m).
    fn pick_of(&mut self, name: &str, body: Entity, (origin, along): (DVec3, DVec3), within: f64) -> Option<Pick> {
        self.update_surface(body);
        let (world, surface) = (&self.world, self.surfaces.get(&body)?);
        let authoring = world.get::<Authoring>(body)?;
        let (rest, u) = (world.get::<RestPosition>(body)?, world.get::<Displacement>(body)?);
        let place = |node: u32| {
            let row = authoring.node_rows[node as usize] as usize;
            rest.0[row] + u.vector(row)
        };
        let mut nearest: Option<(f64, [f64; 3], Triangle)> = None;
        for &triangle in &surface.triangles {
            let most = nearest.as_ref().map_or(within, |found| found.0);
            if let Some((distance, weights)) = Pick::meet(origin, along, triangle.nodes.map(place))
                && distance < most
            {
                nearest = Some((distance, weights, triangle));
            }
        }
        let (distance, weights, Triangle { nodes, face }) = nearest?;
        let corners = nodes.map(place);
        let face = surface.faces[face as usize];
        Some(Pick {
            body: name.to_string(),
            element: authoring.element_ids.of(face.element as usize),
            face: face.nodes,
            nodes,
            weights,
            point: (0..3).map(|i| corners[i] * weights[i]).sum(),
            normal: (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero(),
            distance,
        })
    }

    /// Finds a body's surface anew where elements have gone.
    fn update_surface(&mut self, body: Entity) {
        let Some(authoring) = self.world.get::<Authoring>(body) else { return };
        let alive = authoring.blocks.iter().filter_map(|&block| self.world.get::<Alive>(block));
        let left = alive.map(|alive| alive.iter().map(|&alive| u64::from(alive)).sum::<u64>()).reduce(|a, b| a + b);
        if self.surfaces.get(&body).is_some_and(|surface| surface.left == left) {
            return;
        }
        let faces = self.surface_faces(body);
        let triangles = faces
            .iter()
            .zip(0..)
            .flat_map(|(face, number)| face.triangles().map(move |nodes| Triangle { nodes, face: number }));
        let triangles = triangles.collect();
        self.surfaces.insert(body, Surface { left, faces, triangles });
    }
}

/// Surfaces by body, as they were when somebody picked.
pub(super) type Surfaces = BTreeMap<Entity, Surface>;

#[cfg(test)]
mod tests;
