//! Faces to triangles: those that are drawn, and those that cast shadows.

use super::camera::Camera;
use super::clip::{Extent, kept};
use super::normals;
use super::occlusion::Caster;
use super::picture::{Colouring, Layer, Lines, Picture};
use super::plane::Plane;
use super::raster::{Finish, Triangle};
use glam::Vec3;
use rayon::prelude::*;

/// Samples along each side of a pixel.
pub const FINE: usize = 3;
/// How dark lines are: between elements, in a section, of the shape at rest.
const INK: [f32; 3] = [0.62, 0.4, 0.75];

/// How much wider lines are than in a small picture.
pub fn thickness(height: usize) -> f32 {
    (height as f32 / 720.0).max(1.0)
}

/// All faces in triangles, in samples.
pub fn of(picture: &Picture<'_>, camera: &Camera, height: usize) -> Vec<Triangle> {
    let count = picture.layers.iter().map(|layer| layer.faces.len()).sum::<usize>();
    let mut triangles = Vec::with_capacity(4 * count);
    for layer in &picture.layers {
        let plane = picture.plane.as_ref().filter(|_| layer.cut);
        Maker { layer, plane, camera, height }.all(&mut triangles);
    }
    triangles
}

/// Makes the triangles of a layer.
struct Maker<'a> {
    layer: &'a Layer<'a>,
    plane: Option<&'a Plane>,
    camera: &'a Camera,
    height: usize,
}

impl Maker<'_> {
    /// A quadrilateral is four triangles about its middle, so that none of its diagonals is favoured.
    fn all(&self, triangles: &mut Vec<Triangle>) {
        let layer = self.layer;
        let project = |point: &Vec3| sampled(self.camera.project(*point));
        let places: Vec<Vec3> = layer.vertices.par_iter().map(project).collect();
        let beyond: Vec<f32> = layer.vertices.par_iter().map(|point| self.beyond(*point)).collect();
        let normals = normals::of_layer(layer);
        let even = self.even_ink(&places);
        for (row, face) in layer.faces.iter().enumerate() {
            let corners = face.map(|point| places[point as usize]);
            let sides = face.map(|point| beyond[point as usize]);
            let hidden = sides.iter().all(|beyond| *beyond > 0.0);
            if hidden || !corners.iter().all(|corner| corner.is_finite() && corner.z > 0.0) {
                if layer.finish.is_tool() {
                    self.before_the_eye(face, &normals[row], triangles);
                }
                continue;
            }
            let values = match layer.values {
                Colouring::Vertices(values) => face.map(|point| values[point as usize]),
                Colouring::Faces(values) => [values[row]; 4],
                Colouring::Corners(values) => values[row],
                Colouring::Nothing => [0.0; 4],
            };
            let normals = normals[row].map(|normal| self.turned(normal, &corners, layer.vertices[face[0] as usize]));
            let (ink, bits) = match layer.lines {
                Lines::None => (0.0, 0),
                Lines::All => (INK[0] * self.fade(longest(&corners)), 0b1111),
                Lines::Sides(sides) => (even, sides[row]),
            };
            let line = |side: usize| ink > 0.0 && bits >> side & 1 == 1;
            let (values, beyond) = (&values, &sides);
            let triangle = |of: [usize; 3], edges: [bool; 3]| Triangle {
                places: of.map(|corner| corners[corner]),
                normals: of.map(|corner| normals[corner]),
                values: of.map(|corner| values[corner]),
                beyond: of.map(|corner| beyond[corner]),
                edges,
                ink,
                finish: layer.finish,
            };
            if face[2] == face[3] {
                triangles.push(triangle([0, 1, 2], [line(1), line(2), line(0)]));
                continue;
            }
            let middle = face.map(|point| layer.vertices[point as usize]).iter().sum::<Vec3>() / 4.0;
            let normal = normals.iter().sum::<Vec3>().normalize_or(Vec3::Z);
            let value = values.iter().sum::<f32>() / 4.0;
            for side in 0..4 {
                let mut one = triangle([0, side, (side + 1) % 4], [line(side), false, false]);
                one.places[0] = project(&middle);
                (one.normals[0], one.values[0], one.beyond[0]) = (normal, value, self.beyond(middle));
                triangles.push(one);
            }
        }
    }

    /// The part before the eye of a triangle that reaches behind it: instruments may be long.
    fn before_the_eye(&self, face: &[u32; 4], normals: &[Vec3; 4], triangles: &mut Vec<Triangle>) {
        let corner = |row: usize| (self.layer.vertices[face[row] as usize], normals[row]);
        let mix = |from: &(Vec3, Vec3), to: &(Vec3, Vec3), share: f32| {
            (from.0.lerp(to.0, share), from.1.lerp(to.1, share).normalize_or(from.1))
        };
        let left = kept(&[0, 1, 2].map(corner), |(point, _)| self.camera.ahead(*point), mix);
        for pair in left.windows(2).skip(1) {
            let of = [left[0], pair[0], pair[1]];
            let places = of.map(|(point, _)| sampled(self.camera.project(point)));
            if !places.iter().all(|place| place.is_finite()) {
                continue;
            }
            let corners = [places[0], places[1], places[2], places[2]];
            triangles.push(Triangle {
                places,
                normals: of.map(|(point, normal)| self.turned(normal, &corners, point)),
                values: [0.0; 3],
                beyond: [-1.0; 3],
                edges: [false; 3],
                ink: 0.0,
                finish: self.layer.finish,
            });
        }
    }

    fn beyond(&self, point: Vec3) -> f32 {
        self.plane.map_or(-1.0, |plane| plane.beyond(point))
    }

    /// A normal as the eye sees it, turned towards it; `point` is one of the face.
    fn turned(&self, normal: Vec3, corners: &[Vec3; 4], point: Vec3) -> Vec3 {
        let away = match self.layer.flat {
            None => area(corners) > 0.0,
            // slivers have no area to go by
            Some(normal) => normal.dot(self.camera.eye() - point) < 0.0,
        };
        self.camera.turn(if away { -normal } else { normal })
    }

    /// How dark lines of given sides are: the same all over.
    fn even_ink(&self, places: &[Vec3]) -> f32 {
        if self.layer.finish == Finish::Ghost {
            return INK[2];
        }
        let of = |face: &[u32; 4]| longest(&face.map(|point| places[point as usize]));
        let known: Vec<f32> = self.layer.faces.iter().map(of).filter(|length| length.is_finite()).collect();
        INK[1] * self.fade(1.5 * known.iter().sum::<f32>() / known.len().max(1) as f32)
    }

    /// Lines fade when elements become so small (samples) that lines would cover them.
    fn fade(&self, length: f32) -> f32 {
        let pixels = length / FINE as f32 / thickness(self.height);
        ((pixels - 2.5) / 9.0).clamp(0.0, 1.0)
    }
}

/// The longest side of a face in the picture.
fn longest(corners: &[Vec3; 4]) -> f32 {
    let [a, b, c, d] = corners.map(Vec3::truncate);
    [a.distance(b), b.distance(c), c.distance(d), d.distance(a)].into_iter().fold(0.0, f32::max)
}

fn sampled(place: Vec3) -> Vec3 {
    (place.truncate() * FINE as f32).extend(place.z)
}

/// Twice the signed area of a face in the picture; positive when it turns its back (rows count downwards).
fn area(corners: &[Vec3; 4]) -> f32 {
    let [a, b, c, d] = corners.map(Vec3::truncate);
    let triangle = (b - a).perp_dot(c - a);
    triangle + (c - a).perp_dot(d - a)
}

/// How far from the bodies tools cast shadows, in diagonals of what these fill.
const NEAR_BODIES: f32 = 0.5;

/// What casts shadows: all that is solid, but of tools only what is near the bodies, and no planes.
pub fn casters(picture: &Picture<'_>) -> Vec<Caster> {
    let mut casters = Vec::new();
    for layer in picture.layers.iter().filter(|layer| matches!(layer.finish, Finish::Plain | Finish::Bared)) {
        let plane = picture.plane.as_ref().filter(|_| layer.cut);
        let beyond = |point: Vec3| plane.map_or(-1.0, |plane| plane.beyond(point));
        for face in layer.faces {
            let [a, b, c, d] = face.map(|point| layer.vertices[point as usize]);
            casters.push(([a, b, c], [a, b, c].map(beyond)));
            if face[2] != face[3] {
                casters.push(([a, c, d], [a, c, d].map(beyond)));
            }
        }
    }
    casters.retain(|(_, beyond)| beyond.iter().any(|beyond| *beyond <= 0.0));
    let steel = || picture.layers.iter().filter(|layer| layer.finish == Finish::Steel);
    if steel().next().is_none() {
        return casters;
    }
    let mut bodies = Extent::NOTHING;
    for layer in picture.layers.iter().filter(|layer| !layer.finish.is_tool()) {
        layer.faces.iter().flatten().for_each(|point| bodies.add(layer.vertices[*point as usize]));
    }
    let near = bodies.grown(NEAR_BODIES);
    for layer in steel() {
        for face in layer.faces {
            let left = near.part_of([face[0], face[1], face[2]].map(|point| layer.vertices[point as usize]));
            casters.extend(left.windows(2).skip(1).map(|pair| ([left[0], pair[0], pair[1]], [-1.0; 3])));
        }
    }
    casters
}
