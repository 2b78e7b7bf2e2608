//! From the layers of a picture to triangles for a graphics device.

use super::lent::Lent;
use glam::Vec3;
use sinew_pictures::render::{Camera, Colouring, Finish, Image, Layer, Lines, of_layer};
use std::sync::Arc;

/// A corner of a triangle, as `scene.wgsl` takes it.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Corner {
    position: [f32; 3],
    normal: [f32; 3],
    rest: [f32; 3],
    value: f32,
    /// Bits: 0 which corner, 2 edges opposite to corners, 5 ink, 13 finish, 17 tissue, 25 whether the plane cuts it.
    flags: u32,
}

/// A layer, and what a picture does not have of it.
pub struct Surface<'a> {
    /// The layer.
    pub layer: Layer<'a>,
    /// Where its vertices were at rest (m); empty where nothing is drawn there.
    pub rest: &'a [Vec3],
    /// Which kind of tissue it is made of, where no value colours it.
    pub tissue: Option<u8>,
    /// A picture on it, in place of the tissue's own colour; `rest` are then its places there: right and down from its
    /// upper left corner, 1 its whole size, beyond which it is repeated.
    pub picture: Option<&'a Arc<Image>>,
    /// Where its nodes are on the device, if it is drawn from there.
    pub lent: Option<Lent<'a>>,
}

/// Triangles in the order in which they are drawn.
#[derive(Debug, Default)]
pub struct Triangles {
    /// Three a triangle.
    pub corners: Vec<Corner>,
    /// How many corners, from the first on, cast shadows.
    pub casting: usize,
    /// How many corners are solid: those that are seen through come after them.
    pub solid: usize,
    /// Pictures on them, by the numbers that corners have of them.
    pub pictures: Vec<Arc<Image>>,
}

/// How dark lines are: between elements, in a section, of the shape at rest.
const INK: [f32; 3] = [0.62, 0.4, 0.75];

/// The number of a finish in `scene.wgsl`.
fn number(finish: Finish, tissue: bool, pictured: bool) -> u32 {
    match finish {
        Finish::Plain if tissue && pictured => 8,
        Finish::Plain if tissue => 7,
        Finish::Plain => 0,
        Finish::Bared => 1,
        Finish::Sheet(_) => 2,
        Finish::Ghost => 3,
        Finish::Steel => 4,
        Finish::Table => 5,
        Finish::Pane => 6,
    }
}

/// All surfaces in triangles.
pub fn of(surfaces: &[Surface<'_>], camera: &Camera) -> Triangles {
    let mut all = Triangles::default();
    for picture in surfaces.iter().filter_map(|surface| surface.picture) {
        if !all.pictures.iter().any(|known| Arc::ptr_eq(known, picture)) {
            all.pictures.push(picture.clone());
        }
    }
    let numbered = |picture: &Arc<Image>| all.pictures.iter().position(|known| Arc::ptr_eq(known, picture));
    let casts = |finish: Finish| matches!(finish, Finish::Plain | Finish::Bared | Finish::Steel);
    let put = |wanted: &dyn Fn(Finish) -> bool, corners: &mut Vec<Corner>| {
        let some = surfaces.iter().filter(|surface| surface.lent.is_none() && wanted(surface.layer.finish));
        some.for_each(|surface| add(surface, surface.picture.and_then(numbered), camera, corners));
        corners.len()
    };
    all.casting = put(&casts, &mut all.corners);
    all.solid = put(&|finish| !casts(finish) && !finish.is_clear(), &mut all.corners);
    put(&Finish::is_clear, &mut all.corners);
    all
}

/// The corners of a surface at rest, and of each its face and which of its points it is; 4: the middle.
pub fn kept(surface: &Surface<'_>, camera: &Camera) -> (Vec<Corner>, Vec<[u32; 2]>) {
    let (mut corners, mut sources) = (Vec::new(), Vec::new());
    let at_rest =
        surface.rest.len() == surface.layer.vertices.len() && surface.rest.iter().all(|place| place.is_finite());
    if !at_rest {
        return (corners, sources);
    }
    let layer = Layer { vertices: surface.rest, ..surface.layer };
    add(&Surface { layer, lent: None, ..*surface }, None, camera, &mut corners);
    for (number, face) in (0..).zip(surface.layer.faces) {
        match face[2] == face[3] {
            true => sources.extend([0, 1, 2].map(|point| [number, point])),
            false => sources.extend((0..4).flat_map(|side| [4, side, (side + 1) % 4]).map(|point| [number, point])),
        }
    }
    (corners, sources)
}

/// A quadrilateral is four triangles about its middle, so that none of its diagonals is favoured. `picture`: the number
/// of that which is on it.
fn add(surface: &Surface<'_>, picture: Option<usize>, camera: &Camera, corners: &mut Vec<Corner>) {
    let layer = &surface.layer;
    let normals = of_layer(layer);
    let common = number(layer.finish, surface.tissue.is_some(), picture.is_some()) << 13
        | u32::from(surface.tissue.unwrap_or(0)) << 17
        | u32::from(layer.cut) << 25;
    for (row, face) in layer.faces.iter().enumerate() {
        let places = face.map(|point| layer.vertices[point as usize]);
        if !places.iter().all(|place| place.is_finite()) {
            continue;
        }
        let rest = face.map(|point| {
            let rest = surface.rest.get(point as usize).copied().unwrap_or_default();
            picture.map_or(rest, |number| rest.with_z(number as f32))
        });
        let values = match layer.values {
            Colouring::Vertices(values) => face.map(|point| values[point as usize]),
            Colouring::Faces(values) => [values[row]; 4],
            Colouring::Corners(values) => values[row],
            Colouring::Nothing => [0.0; 4],
        };
        let (ink, bits) = match layer.lines {
            Lines::None => (0.0, 0),
            Lines::All => (INK[0] * fade(&places, camera), 0b1111),
            Lines::Sides(sides) if layer.finish == Finish::Ghost => (INK[2], sides[row]),
            Lines::Sides(sides) => (INK[1] * fade(&places, camera), sides[row]),
        };
        let edge = |side: usize| u32::from(bits >> side & 1);
        let of = |at: usize| (places[at], normals[row][at], rest[at], values[at]);
        let mut put = |mut three: [(Vec3, Vec3, Vec3, f32); 3], mut edges: u32| {
            let turned = (three[1].0 - three[0].0).cross(three[2].0 - three[0].0);
            if layer.flat.is_some_and(|normal| normal.dot(turned) < 0.0) {
                // which way round a section's triangles go is not said
                three.swap(1, 2);
                edges = edges & 1 | (edges & 2) << 1 | (edges & 4) >> 1;
            }
            for (which, (position, normal, rest, value)) in (0..).zip(three) {
                let flags = which | edges << 2 | ((255.0 * ink) as u32) << 5 | common;
                let [position, normal, rest] = [position, normal, rest].map(|vector| vector.to_array());
                corners.push(Corner { position, normal, rest, value, flags });
            }
        };
        if face[2] == face[3] {
            put([of(0), of(1), of(2)], edge(1) | edge(2) << 1 | edge(0) << 2);
            continue;
        }
        let mean = |all: [Vec3; 4]| all.iter().sum::<Vec3>() / 4.0;
        let middle = (mean(places), mean(normals[row]), mean(rest), values.iter().sum::<f32>() / 4.0);
        for side in 0..4 {
            put([middle, of(side), of((side + 1) % 4)], edge(side));
        }
    }
}

/// Lines fade when elements become so small that lines would cover them.
fn fade(places: &[Vec3; 4], camera: &Camera) -> f32 {
    let [a, b, c, d] = *places;
    let longest = [a.distance(b), b.distance(c), c.distance(d), d.distance(a)].into_iter().fold(0.0, f32::max);
    let pixels = longest * camera.focal() / camera.eye().distance(a).max(f32::MIN_POSITIVE);
    ((pixels - 2.5) / 9.0).clamp(0.0, 1.0)
}
