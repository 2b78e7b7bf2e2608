//! One picture from one state.

use super::camera::Camera;
use super::colour::{self, Scale};
use super::image::Image;
use super::legend;
use super::light::{self, Light};
use super::normals;
use super::raster::{Look, Strip, Triangle};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// What a picture shows.
pub struct Picture<'a> {
    /// Positions (m); those that no face names are ignored.
    pub vertices: &'a [Vec3],
    /// Faces, counter-clockwise seen from outside: rows of `vertices`; a triangle repeats its last point.
    pub faces: &'a [[u32; 4]],
    /// What gives the colour.
    pub values: Colouring<'a>,
    /// Which value has which colour.
    pub scale: Scale,
    /// What is coloured: "von Mises stress".
    pub quantity: &'a str,
    /// Its SI unit, "Pa"; empty for a plain number. The legend chooses a prefix.
    pub unit: &'a str,
    /// A line in the corner, the time for instance.
    pub caption: &'a str,
    /// Whether the elements' edges are drawn.
    pub edges: bool,
}

/// Values that give the colour.
#[derive(Clone, Copy)]
pub enum Colouring<'a> {
    /// One a vertex, changing linearly between them.
    Vertices(&'a [f32]),
    /// One a face.
    Faces(&'a [f32]),
}

/// Samples along each side of a pixel.
const FINE: usize = 3;
/// Pixel rows that are drawn at a time, by one core.
const ROWS: usize = 24;

/// Draws a picture of the given width and height (pixels).
pub fn paint(picture: &Picture<'_>, camera: &Camera, (width, height): (usize, usize)) -> Image {
    let triangles = triangles(picture, camera, height);
    let ramp = picture.scale.ramp();
    let lights = Light::new();
    let look = Look { ramp: &ramp, light: &lights, edge: 0.35 * FINE as f32 * thickness(height) };
    // forty samples deep within two: no surface that we see well is that steep
    let step = 1.0 + 40.0 / (camera.focal() * FINE as f32);
    let mut image = Image::new(width, height, [255; 3]);
    image.pixels.par_chunks_mut(width * ROWS).enumerate().for_each(|(number, pixels)| {
        // one pixel row more on either side, for the outline
        let top = number * ROWS * FINE;
        let margin = FINE.min(top);
        let mut strip = Strip::new(width * FINE, top - margin, (ROWS + 2) * FINE);
        triangles.iter().for_each(|triangle| strip.draw(triangle, &look));
        for (row, pixels) in pixels.chunks_mut(width).enumerate() {
            let behind = light::background((number * ROWS + row) as f32 / height as f32);
            for (column, pixel) in pixels.iter_mut().enumerate() {
                *pixel = colour::bytes(mean(&strip, column * FINE, row * FINE + margin, behind, step));
            }
        }
    });
    legend::draw(&mut image, picture, camera);
    image
}

/// How much wider lines and letters are than in a small picture.
fn thickness(height: usize) -> f32 {
    (height as f32 / 720.0).max(1.0)
}

/// The mean of a pixel's samples; samples at the rim of what is in front are darker and make its outline.
fn mean(strip: &Strip, column: usize, row: usize, behind: Vec3, step: f32) -> Vec3 {
    let mut sum = Vec3::ZERO;
    for y in row..row + FINE {
        for x in column..column + FINE {
            let at = y * strip.width + x;
            sum += match strip.nearness[at] {
                0.0 => behind,
                _ => strip.light[at] * if rim(strip, x, y, step) { 0.45 } else { 1.0 },
            };
        }
    }
    sum / (FINE * FINE) as f32
}

/// Whether two samples away there is nothing, or something farther by the factor `step`.
fn rim(strip: &Strip, x: usize, y: usize, step: f32) -> bool {
    let own = strip.nearness[y * strip.width + x];
    let beyond = |x: usize, y: usize| strip.nearness.get(y * strip.width + x).is_some_and(|other| own > other * step);
    let (right, left) = (x + 2 < strip.width && beyond(x + 2, y), x >= 2 && beyond(x - 2, y));
    right || left || beyond(x, y + 2) || (y >= 2 && beyond(x, y - 2))
}

/// All faces in triangles, in samples. A quadrilateral is four triangles about its middle, so that none of its diagonals is
/// favoured.
fn triangles(picture: &Picture<'_>, camera: &Camera, height: usize) -> Vec<Triangle> {
    let places: Vec<Vec3> = picture.vertices.par_iter().map(|point| sampled(camera.project(*point))).collect();
    let normals = normals::of_corners(picture.vertices, picture.faces);
    let mut triangles = Vec::with_capacity(picture.faces.len() * 4);
    for (row, face) in picture.faces.iter().enumerate() {
        let corners = face.map(|point| places[point as usize]);
        if !corners.iter().all(|corner| corner.is_finite() && corner.z > 0.0) {
            continue;
        }
        let values = match picture.values {
            Colouring::Vertices(values) => face.map(|point| values[point as usize]),
            Colouring::Faces(values) => [values[row]; 4],
        };
        let away = area(&corners) > 0.0;
        let normals = normals[row].map(|normal| camera.turn(if away { -normal } else { normal }));
        let ink = if picture.edges { ink(&corners, height) } else { 0.0 };
        if face[2] == face[3] {
            triangles.push(Triangle {
                places: [corners[0], corners[1], corners[2]],
                normals: [normals[0], normals[1], normals[2]],
                values: [values[0], values[1], values[2]],
                edges: [ink > 0.0; 3],
                ink,
            });
            continue;
        }
        let points = face.map(|point| picture.vertices[point as usize]);
        let middle = sampled(camera.project(points.iter().sum::<Vec3>() / 4.0));
        let (normal, value) = (normals.iter().sum::<Vec3>(), values.iter().sum::<f32>() / 4.0);
        for side in 0..4 {
            let next = (side + 1) % 4;
            triangles.push(Triangle {
                places: [middle, corners[side], corners[next]],
                normals: [normal.normalize_or(Vec3::Z), normals[side], normals[next]],
                values: [value, values[side], values[next]],
                edges: [ink > 0.0, false, false],
                ink,
            });
        }
    }
    triangles
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

/// How dark the edges of a face are: they fade when elements become so small that lines would cover them.
fn ink(corners: &[Vec3; 4], height: usize) -> f32 {
    let [a, b, c, d] = corners.map(Vec3::truncate);
    let longest = [a.distance(b), b.distance(c), c.distance(d), d.distance(a)].into_iter().fold(0.0, f32::max);
    let pixels = longest / FINE as f32 / thickness(height);
    0.62 * ((pixels - 2.5) / 9.0).clamp(0.0, 1.0)
}

/// The part of a picture that the body may fill, the rest is the legend's (left and top, right and bottom, in pixels).
pub fn stage((width, height): (usize, usize)) -> (Vec2, Vec2) {
    let (margin, below) = (height as f32 * 0.045, legend::height((width, height)));
    (Vec2::splat(margin), Vec2::new(width as f32 - margin, height as f32 - below - margin * 0.5))
}
