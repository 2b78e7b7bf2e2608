//! What all triangles share: where eye and lights are, how it looks.

use super::Scene;
use glam::{Mat4, Vec2, Vec3, Vec4};
use sinew_pictures::render::{Camera, Scale};

/// How a scene looks.
#[derive(Clone, Debug)]
pub struct Look {
    /// How wet tissue and fields shine, 0 to 1.
    pub wet: f32,
    /// How dark shadows are, 0 to 1.
    pub shadows: f32,
    /// Whether the ground is seen where shadows fall on it.
    pub ground: bool,
    /// A dark background.
    pub dark: bool,
    /// Pixels a point on the screen: how wide lines are.
    pub scale: f32,
    /// Kinds of tissue, by the numbers that surfaces give.
    pub tissues: Vec<Tissue>,
}

/// How tissue looks that no value colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tissue {
    /// Its colour (sRGB, 0 to 1).
    pub colour: [f32; 3],
    /// How mottled it is, 0 to 1.
    pub mottled: f32,
    /// How far light of each colour is scattered beyond the edge of its shadow.
    pub scatter: [f32; 3],
    /// How uneven its film is.
    pub uneven: f32,
}

impl Tissue {
    /// Of an organ that the name of a body or material speaks of; reddish flesh where it speaks of none.
    pub fn of_name(name: &str) -> Self {
        let name = name.to_lowercase();
        let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
        let (colour, mottled, scatter, uneven) = match () {
            () if has(&["liver", "spleen", "kidney", "lobe"]) => ([0.47, 0.17, 0.13], 0.85, [0.42, 0.12, 0.08], 1.0),
            () if has(&["lens", "cornea", "eye", "vitreous"]) => ([0.86, 0.83, 0.72], 0.12, [0.5, 0.45, 0.35], 0.15),
            () if has(&["brain", "cortex"]) => ([0.80, 0.64, 0.59], 0.6, [0.5, 0.25, 0.2], 1.0),
            () if has(&["fat", "breast", "skin", "pad"]) => ([0.87, 0.70, 0.54], 0.5, [0.5, 0.3, 0.18], 0.8),
            () if has(&["vessel", "artery", "vein", "heart"]) => ([0.60, 0.14, 0.14], 0.6, [0.45, 0.1, 0.1], 0.8),
            () if has(&["bone", "cartilage", "tendon"]) => ([0.88, 0.85, 0.77], 0.3, [0.25, 0.2, 0.15], 0.4),
            () => ([0.74, 0.36, 0.31], 0.7, [0.48, 0.17, 0.12], 0.9),
        };
        Self { colour, mottled, scatter, uneven }
    }
}

/// How many tissues there can be: the number of one has 8 bits.
const TISSUES: usize = 256;

/// The numbers of all tissues; where none is given, of flesh.
pub fn tissues(tissues: &[Tissue]) -> Vec<f32> {
    let one = |tissue: &Tissue| {
        let [r, g, b] = tissue.colour.map(linear);
        let [x, y, z] = tissue.scatter;
        [r, g, b, tissue.mottled, x, y, z, tissue.uneven]
    };
    let flesh = Tissue::of_name("");
    (0..TISSUES).flat_map(|number| one(tissues.get(number).unwrap_or(&flesh))).collect()
}

/// The colours of a scale in even steps (sRGB, bytes).
pub fn ramp(scale: &Scale) -> Vec<[u8; 4]> {
    let (low, high) = scale.range;
    let colour = |step: u32| {
        let [r, g, b] = (scale.srgb(low + (high - low) * step as f32 / 1023.0) * 255.0 + 0.5).to_array();
        [r as u8, g as u8, b as u8, 255]
    };
    (0..1024).map(colour).collect()
}

/// The numbers of `View` in `scene.wgsl`; `is_encoded`: whether the shader encodes light as screens take it.
pub fn of(scene: &Scene<'_>, camera: &Camera, size: Vec2, is_encoded: bool) -> Vec<f32> {
    let Scene { look, bodies, .. } = scene;
    let diagonal = bodies.diagonal().max(f32::MIN_POSITIVE);
    let middle = if bodies.is_nothing() { Vec3::ZERO } else { bodies.middle() };
    let key = camera.turn_back(Vec3::new(-0.45, 0.62, 0.75).normalize());
    let flag = |is: bool| f32::from(u8::from(is));
    let mut numbers = Vec::with_capacity(92);
    for matrix in [
        camera.clip_from_world(size),
        clip_of_light(key, middle, diagonal),
        clip_of_light(scene.ground.0, middle, diagonal),
    ] {
        numbers.extend(matrix.to_cols_array());
    }
    let (low, high) = scene.scale.range;
    let plane = scene.plane.map_or(Vec4::ZERO, |plane| plane.normal.extend(-plane.beyond(Vec3::ZERO)));
    let background = match look.dark {
        false => [Vec3::new(0.995, 0.996, 0.998), Vec3::new(0.925, 0.935, 0.945)],
        true => [Vec3::new(0.155, 0.170, 0.195), Vec3::new(0.070, 0.078, 0.092)],
    };
    let background = background.map(|colour| Vec3::from_array(colour.to_array().map(linear)).extend(1.0));
    let vectors = [
        camera.turn_back(Vec3::X).extend(0.0),
        camera.turn_back(Vec3::Y).extend(0.0),
        camera.turn_back(Vec3::Z).extend(0.0),
        camera.eye().extend(0.0),
        plane,
        scene.ground.0.extend(scene.ground.1),
        middle.extend(diagonal),
        Vec4::new(low, 1.0 / (high - low), flag(is_encoded), look.wet),
        Vec4::new(look.shadows, 0.5 * look.scale, flag(look.ground), flag(!look.dark)),
        background[0],
        background[1],
    ];
    numbers.extend(vectors.iter().flat_map(|vector| vector.to_array()));
    numbers
}

/// How a light far away in a direction sees what is around bodies: all of it between -1 and 1, the nearest at depth 0.
fn clip_of_light(towards: Vec3, middle: Vec3, diagonal: f32) -> Mat4 {
    let back = towards.normalize_or(Vec3::Z);
    let right = back.any_orthonormal_vector();
    let up = back.cross(right);
    let reach = 0.75 * diagonal;
    let row = |axis: Vec3, shift: f32, factor: f32| {
        let axis = axis * factor / reach;
        axis.extend(shift - axis.dot(middle))
    };
    let rows = [row(right, 0.0, 1.0), row(up, 0.0, 1.0), row(back, 0.5, -0.5)];
    Mat4::from_cols(rows[0], rows[1], rows[2], Vec4::W).transpose()
}

/// Light from a colour as screens take it.
fn linear(srgb: f32) -> f32 {
    if srgb <= 0.04045 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) }
}
