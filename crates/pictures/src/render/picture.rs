//! One picture from one state.

use super::RenderError;
use super::camera::Camera;
use super::colour::{self, Scale};
use super::image::Image;
use super::legend::{self, Key};
use super::light::{self, Light};
use super::occlusion::{Caster, Ground, Sky};
use super::plane::Plane;
use super::raster::{Finish, Shading, Strip};
use super::triangles::{self, FINE, thickness};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// What a picture shows.
pub struct Picture<'a> {
    /// The surfaces in it.
    pub layers: Vec<Layer<'a>>,
    /// Which value has which colour.
    pub scale: Scale,
    /// The least and the largest value that are seen in the series: the legend marks where they lie beyond the scale.
    pub seen: (f32, f32),
    /// What is coloured: "von Mises stress".
    pub quantity: &'a str,
    /// Its SI unit, "Pa"; empty for a plain number. The legend chooses a prefix.
    pub unit: &'a str,
    /// A line in the corner, the time for instance.
    pub caption: &'a str,
    /// What the legend explains beside colours.
    pub keys: &'a [Key],
    /// Takes away what lies beyond it.
    pub plane: Option<Plane>,
    /// Soft shadows: the direction that is up, of length 1, and where the ground is along it (m).
    pub ground: Option<(Vec3, f32)>,
    /// Whether surfaces end above the legend.
    pub panel: bool,
}

/// Surfaces of one kind.
#[derive(Clone, Copy)]
pub struct Layer<'a> {
    /// Positions (m); those that no face names are ignored.
    pub vertices: &'a [Vec3],
    /// Faces, counter-clockwise seen from outside: rows of `vertices`; a triangle repeats its last point.
    pub faces: &'a [[u32; 4]],
    /// What gives the colour.
    pub values: Colouring<'a>,
    /// What they are made of.
    pub finish: Finish,
    /// Which sides of faces are drawn as lines.
    pub lines: Lines<'a>,
    /// Normals of the vertices, of length 1, where these are known; else what the faces around them say.
    pub normals: &'a [Vec3],
    /// The normal of all of them, where that is known.
    pub flat: Option<Vec3>,
    /// Whether the picture's plane cuts them.
    pub cut: bool,
}

/// Values that give the colour.
#[derive(Clone, Copy)]
pub enum Colouring<'a> {
    /// One a vertex, changing linearly between them.
    Vertices(&'a [f32]),
    /// One a face.
    Faces(&'a [f32]),
    /// One a corner of each face.
    Corners(&'a [[f32; 4]]),
    /// None.
    Nothing,
}

/// Which sides of faces are drawn as lines.
#[derive(Clone, Copy)]
pub enum Lines<'a> {
    /// None.
    None,
    /// All: the elements' edges.
    All,
    /// Of each face those with a bit: bit 0 the side from its first corner to its second, and so on.
    Sides(&'a [u8]),
}

/// Pixel rows that are drawn at a time by one core, and fewer where much is known of each sample.
const ROWS: [usize; 2] = [24, 8];
/// The share of light that is left where no sky is seen, of surfaces and of the ground.
const DARKEST: [f32; 2] = [0.42, 0.5];

/// Draws a picture of the given width and height (pixels).
///
/// # Errors
/// That the legend cannot be drawn.
pub fn paint(picture: &Picture<'_>, camera: &Camera, (width, height): (usize, usize)) -> Result<Image, RenderError> {
    let triangles = triangles::of(picture, camera, height);
    let ramp = picture.scale.ramp();
    let lights = Light::new();
    let shading = Shading { ramp: &ramp, light: &lights, edge: 0.35 * FINE as f32 * thickness(height) };
    let shade = Shade::new(picture, camera, &lights);
    let sheets = triangles.iter().any(|triangle| triangle.finish.is_clear());
    let rows = ROWS[usize::from(sheets)];
    let end = if picture.panel { legend::top((width, height)) } else { height };
    // forty samples deep within two: no surface that we see well is that steep
    let step = 1.0 + 40.0 / (camera.focal() * FINE as f32);
    let mut image = Image::new(width, height, [255; 3]);
    image.pixels.par_chunks_mut(width * rows).enumerate().for_each(|(number, pixels)| {
        // one pixel row more on either side, for the outline
        let top = number * rows * FINE;
        let margin = FINE.min(top);
        let mut strip = Strip::new(width * FINE, top - margin, (rows + 2) * FINE, sheets);
        if number * rows < end {
            triangles.iter().for_each(|triangle| strip.draw(triangle, &shading));
        }
        for (row, pixels) in pixels.chunks_mut(width).enumerate() {
            let line = number * rows + row;
            if line >= end {
                pixels.fill(legend::PANEL);
                continue;
            }
            let behind = light::background(line as f32 / height as f32);
            for (column, pixel) in pixels.iter_mut().enumerate() {
                let place = Vec2::new(column as f32 + 0.5, line as f32 + 0.5);
                *pixel = colour::bytes(mean(&strip, (column, row * FINE + margin), place, behind, step, &shade));
            }
        }
    });
    legend::draw(&mut image, picture, camera)?;
    Ok(image)
}

/// Soft shadows of a picture, if it has any.
struct Shade<'a> {
    camera: &'a Camera,
    sky: Option<(Sky, Ground)>,
    /// Planes on which bodies may stand: their normals, of length 1, where they are along these (m), and their shadows.
    tables: Vec<(Vec3, f32, Ground)>,
}

impl Shade<'_> {
    fn new<'a>(picture: &Picture<'_>, camera: &'a Camera, light: &Light) -> Shade<'a> {
        let sky = picture.ground.and_then(|ground| {
            let casters: Vec<Caster> = triangles::casters(picture);
            let sky = Sky::new(&casters, ground.0, camera.turn_back(light.key()))?;
            let below = sky.ground(ground);
            Some((sky, below))
        });
        let planes = picture.layers.iter().filter(|layer| layer.finish == Finish::Table);
        let planes = planes.filter_map(|layer| Some((layer.flat?, layer.flat?.dot(*layer.vertices.first()?))));
        let shadow = |(normal, at)| sky.as_ref().map(|(sky, _)| (normal, at, sky.ground((normal, at))));
        let tables = planes.filter_map(shadow).collect();
        Shade { camera, sky, tables }
    }

    /// The share of light on the ground at a pixel.
    fn on_ground(&self, pixel: Vec2) -> f32 {
        let seen = self.sky.as_ref().map_or(1.0, |(_, ground)| ground.seen(self.camera.eye(), self.camera.ray(pixel)));
        DARKEST[1] + (1.0 - DARKEST[1]) * seen
    }

    /// The share of light on a surface at a pixel, of known nearness (1/m) and normal as the eye sees it.
    fn on_surface(&self, pixel: Vec2, nearness: f32, normal: Vec3) -> f32 {
        let Some((sky, _)) = &self.sky else { return 1.0 };
        let ray = self.camera.ray(pixel);
        let (point, normal) = (self.camera.eye() + ray / nearness, self.camera.turn_back(normal));
        let near = 1e-3 / nearness;
        let lies_in =
            |(of, at, _): &&(Vec3, f32, Ground)| normal.dot(*of) > 0.999 && (point.dot(*of) - at).abs() < near;
        match self.tables.iter().find(lies_in) {
            Some((_, _, table)) => DARKEST[1] + (1.0 - DARKEST[1]) * table.seen(self.camera.eye(), ray),
            None => DARKEST[0] + (1.0 - DARKEST[0]) * sky.seen(point, normal),
        }
    }
}

/// The samples of a pixel, the middle one first.
const MIDDLE_FIRST: [(usize, usize); FINE * FINE] =
    [(1, 1), (1, 0), (0, 1), (2, 1), (1, 2), (0, 0), (2, 0), (0, 2), (2, 2)];

/// The mean of a pixel's samples; samples at the rim of what is in front are darker and make its outline.
fn mean(strip: &Strip, (column, row): (usize, usize), pixel: Vec2, behind: Vec3, step: f32, shade: &Shade<'_>) -> Vec3 {
    let sample = |(x, y): (usize, usize)| (row + y) * strip.width + column * FINE + x;
    let solid = MIDDLE_FIRST.map(sample).into_iter().find(|at| strip.nearness[*at] > 0.0);
    // shadows are soft: one sample for the whole pixel will do
    let shadow = solid.map_or(1.0, |at| shade.on_surface(pixel, strip.nearness[at], strip.normal[at]));
    let full = MIDDLE_FIRST.iter().all(|place| strip.nearness[sample(*place)] > 0.0);
    let ground = if full { behind } else { behind * shade.on_ground(pixel) };
    let mut sum = Vec3::ZERO;
    for place in MIDDLE_FIRST {
        let at = sample(place);
        let light = match strip.nearness[at] {
            0.0 => ground,
            _ => {
                let rim = rim(strip, column * FINE + place.0, row + place.1, step);
                strip.light[at] * shadow * if rim { 0.45 } else { 1.0 }
            }
        };
        sum += strip.through_sheets(at, light);
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

/// The part of a picture that the body may fill, the rest is the legend's (left and top, right and bottom, in pixels).
pub fn stage((width, height): (usize, usize)) -> (Vec2, Vec2) {
    let margin = height as f32 * 0.045;
    let bottom = legend::top((width, height)) as f32 - margin * 0.5;
    (Vec2::splat(margin), Vec2::new(width as f32 - margin, bottom))
}
