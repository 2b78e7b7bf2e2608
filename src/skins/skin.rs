//! A fine surface on a body.

use super::carrier::Carriers;
use super::embedding::Embedding;
use crate::mesh::Mesh;
use crate::mesh::Triangles;
use bevy_ecs::prelude::Component;
use glam::DVec3;
use std::collections::HashMap;
use std::sync::OnceLock;

/// The points of a surface as pictures have them: one for each place and texture coordinates there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pictured {
    /// The row of each in the surface's points.
    pub points: Vec<u32>,
    /// Its texture coordinates (u, v); nothing of surfaces without.
    pub texture: Vec<[f32; 2]>,
    /// Rows of these points, for each triangle.
    triangles: Vec<[u32; 3]>,
}

impl Pictured {
    fn new(surface: &Triangles) -> Self {
        if surface.texture.is_empty() {
            let points = (0..surface.points.len() as u32).collect();
            return Self { points, texture: Vec::new(), triangles: surface.triangles.clone() };
        }
        let mut made = Self::default();
        let mut rows = HashMap::new();
        for (corners, texture) in surface.triangles.iter().zip(&surface.texture) {
            let row = |corner: usize| {
                let (point, at) = (corners[corner], texture[corner]);
                *rows.entry((point, at.map(f32::to_bits))).or_insert_with(|| {
                    made.points.push(point);
                    made.texture.push(at);
                    made.points.len() as u32 - 1
                })
            };
            made.triangles.push([0, 1, 2].map(row));
        }
        made
    }
}

/// A fine surface that the mesh of a body carries.
#[derive(Component, Clone, Debug)]
pub struct Skin {
    /// The mesh in the shape that the surface was made for (m), in the author's numbering.
    mesh: Mesh,
    surface: Triangles,
    /// Where texture coordinates differ at a point there are several points in pictures.
    pictured: Pictured,
    /// With all elements alive.
    whole: Embedding,
    /// The element that carries each triangle's centroid then: found when the first elements have gone.
    under: OnceLock<Vec<Option<usize>>>,
    /// With those that were alive when somebody last looked.
    now: Embedding,
    alive: Vec<bool>,
}

impl Skin {
    /// A surface (m) on a mesh in the same shape.
    pub fn new(mesh: Mesh, surface: Triangles) -> Self {
        let whole = Embedding::new(&mesh, &surface.points, &|_| true);
        let pictured = Pictured::new(&surface);
        let (alive, now) = (vec![true; mesh.element_count()], whole.clone());
        Self { mesh, surface, pictured, whole, under: OnceLock::new(), now, alive }
    }

    /// The surface as it is before anything moves (m).
    pub fn surface(&self) -> &Triangles {
        &self.surface
    }

    /// Takes note of which elements live, by the author's rows: points whose element has gone get the nearest one that
    /// lives, by the shape that the surface was made for. What went before what does not matter.
    #[doc(hidden)]
    pub fn update_alive(&mut self, alive: Vec<bool>) {
        if alive != self.alive {
            let lives = |element: usize| alive.get(element).copied().unwrap_or_default();
            self.now = self.whole.rebound(&self.mesh, &self.surface.points, &lives);
            self.alive = alive;
        }
    }

    /// Its points as pictures have them.
    pub fn pictured(&self) -> &Pictured {
        &self.pictured
    }

    /// The triangles that are left: all but those of which the element has gone that carried the centroid when all
    /// lived. Points on what several elements share are carried by the first of these; centroids seldom lie there. By
    /// rows of the surface's points, and of those that pictures have.
    pub fn triangles(&self) -> Vec<([u32; 3], [u32; 3])> {
        let both = self.surface.triangles.iter().zip(&self.pictured.triangles).map(|(a, b)| (*a, *b));
        if self.alive.iter().all(|&lives| lives) {
            return both.collect();
        }
        let under = self.under.get_or_init(|| self.elements_under());
        let left = |element: Option<usize>| element.and_then(|element| self.alive.get(element)) == Some(&true);
        both.zip(under).filter(|(_, element)| left(**element)).map(|(both, _)| both).collect()
    }

    /// What carries the centroids of the triangles while all elements live: where one carries all corners it does.
    fn elements_under(&self) -> Vec<Option<usize>> {
        let carriers = Carriers::new(&self.mesh, &|_| true);
        let of_point = |point: u32| self.whole.carriers().get(point as usize)?.as_ref().map(|carrier| carrier.element);
        let of_triangle = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(of_point);
            if a.is_some() && a == b && b == c {
                return a;
            }
            let centroid = corners.iter().map(|&point| self.surface.points[point as usize]).sum::<DVec3>() / 3.0;
            carriers.carrier(centroid).map(|carrier| carrier.element)
        };
        self.surface.triangles.iter().map(of_triangle).collect()
    }

    /// What carries the points now.
    pub fn embedding(&self) -> &Embedding {
        &self.now
    }

    /// Where the points are (m) when the nodes are there, in the author's order. Where no element lives any more they
    /// are where all elements had them: with nodes that stay where they were last they do not go anywhere.
    pub fn places(&self, nodes: &[DVec3]) -> Vec<DVec3> {
        let carried = if self.alive.contains(&true) { &self.now } else { &self.whole };
        carried.places(&self.mesh, nodes)
    }

    /// What the points have of a field of the nodes, in the author's order.
    pub fn values(&self, field: impl Fn(usize) -> DVec3) -> Vec<DVec3> {
        self.now.values(&self.mesh, field)
    }
}

/// Normals at points (m), outwards: those of the triangles around them, weighted by area; zero where there are none.
pub fn normals(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; points.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|row| points[row as usize]);
        let twice = (b - a).cross(c - a);
        corners.iter().for_each(|&row| sums[row as usize] += twice);
    }
    sums.into_iter().map(DVec3::normalize_or_zero).collect()
}
