//! Whether a rigid tool is in a body. Contact with tools is of nodes: what of a tool is in a body between them meets
//! none, and must be known.

use super::Tree;
use crate::components::Pose;
use crate::mesh::{Locator, Mesh, OnTriangle};
use crate::tools::Geometry;
use glam::DVec3;

/// A cube about a place in a tool's frame, and half of its edge (m).
#[derive(Clone, Copy)]
struct Cube {
    middle: DVec3,
    half: f64,
}

impl Cube {
    /// How far its corners are from its middle (m).
    fn radius(&self) -> f64 {
        3.0_f64.sqrt() * self.half
    }

    fn eighths(self) -> impl Iterator<Item = Self> {
        let half = 0.5 * self.half;
        let side = move |bit: usize, place: usize| if place >> bit & 1 == 1 { half } else { -half };
        (0..8).map(move |i| Self { middle: self.middle + DVec3::new(side(0, i), side(1, i), side(2, i)), half })
    }
}

/// A place on the surface of a tool that lies in an element of a mesh, farther than `depth` (m) from all of the mesh's
/// surface, and that element. The pose leads from the tool's frame to where the mesh is. `None` of a plane: behind it
/// there are nodes of every body that it cuts.
///
/// Cubes about the tool are cut into eight wherever the tool's surface and the mesh may both be, until they are half as
/// wide as `depth`, and an eighth as wide as the tool: deeper places may be missed by as much.
pub fn immersed(geometry: &Geometry, pose: &Pose, mesh: &Mesh, depth: f64) -> Option<(DVec3, usize)> {
    let (middle, radius) = geometry.bounding_sphere()?;
    let low = mesh.points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = mesh.points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let is_apart = |cube: Cube| {
        let at = pose.place(cube.middle);
        let off = (low - at).max(at - high).max(DVec3::ZERO).length();
        !at.is_finite() || off > cube.radius()
    };
    let whole = Cube { middle, half: radius };
    if depth.is_nan() || depth <= 0.0 || !radius.is_finite() || is_apart(whole) {
        return None;
    }
    let triangles: Vec<[u32; 3]> = mesh.surface().iter().flat_map(|face| face.triangles()).collect();
    let corners = |number: u32| triangles[number as usize].map(|node| mesh.points[node as usize]);
    let tree = Tree::new(0..triangles.len() as u32, corners);
    let is_near = |at: DVec3, reach: f64| {
        let mut near = false;
        tree.near(at, reach, |number| near |= at.distance(OnTriangle::nearest(at, corners(number)).at) <= reach);
        near
    };
    let locator = Locator::new(mesh);
    let finest = (0.5 * depth).min(0.125 * radius);
    let mut cubes = vec![whole];
    while let Some(cube) = cubes.pop() {
        let (distance, out) = geometry.distance(cube.middle);
        let at = pose.place(cube.middle);
        let is_beside = || !is_near(at, cube.radius()) && locator.holds(at).is_none();
        if distance.abs() > cube.radius() || is_apart(cube) || is_beside() {
            continue;
        }
        if cube.half > finest {
            cubes.extend(cube.eighths());
            continue;
        }
        let on_surface = pose.place(cube.middle - distance * out);
        if let Some(element) = locator.holds(on_surface).filter(|_| !is_near(on_surface, depth)) {
            return Some((on_surface, element));
        }
    }
    None
}

#[cfg(test)]
mod tests;
