//! Light on the surface.

use super::colour;
use glam::{Vec2, Vec3};

/// A key light from the upper left, a weaker one from the right, some light from everywhere and a small gloss.
/// Directions as the eye sees them: to the right, up, towards the eye.
pub struct Light {
    key: Vec3,
    fill: Vec3,
    gloss: Vec3,
    bared: Vec3,
    ghost: Vec3,
    steel: Vec3,
    table: Vec3,
}

/// The tint of surfaces that were bared (sRGB), and its share.
const BARED: (Vec3, f32) = (Vec3::new(0.86, 0.62, 0.58), 0.72);
/// The colour of the shape at rest (sRGB).
const GHOST: Vec3 = Vec3::new(0.50, 0.56, 0.64);

/// To the right and towards the eye: normals of steel in which the lamps are seen.
const LAMPS: [Vec2; 2] = [Vec2::new(-0.52, 0.854), Vec2::new(0.88, 0.475)];
/// The colour of tools (sRGB), and of those that are planes.
const STEEL: Vec3 = Vec3::new(0.73, 0.755, 0.785);
const TABLE: Vec3 = Vec3::new(0.925, 0.932, 0.94);

impl Light {
    /// The light of all pictures.
    pub fn new() -> Light {
        let key = Vec3::new(-0.45, 0.62, 0.75).normalize();
        Light {
            key,
            fill: Vec3::new(0.85, 0.05, 0.45).normalize(),
            gloss: (key + Vec3::Z).normalize(),
            bared: colour::linear(BARED.0),
            ghost: colour::linear(GHOST),
            steel: colour::linear(STEEL),
            table: colour::linear(TABLE),
        }
    }

    /// The light that a surface of the given colour (linear) and normal (of length 1) sends to the eye.
    pub fn on(&self, normal: Vec3, colour: Vec3) -> Vec3 {
        let around = 0.44 + 0.08 * normal.y;
        let diffuse = around + 0.52 * normal.dot(self.key).max(0.0) + 0.18 * normal.dot(self.fill).max(0.0);
        colour * diffuse + Vec3::splat(0.05 * normal.dot(self.gloss).max(0.0).powi(60))
    }

    /// The light that brushed steel of a normal (of length 1) sends to the eye: a studio mirrored in it, brighter above
    /// than below, with lamps as high as the room at the left and at the right.
    pub fn steel(&self, normal: Vec3) -> Vec3 {
        let mirrored = 2.0 * normal.z * normal - Vec3::Z;
        let above = 1.0 / (1.0 + (-4.0 * mirrored.y).exp());
        let level = Vec2::new(normal.x, normal.z);
        let lamp = |towards: Vec2, sharp: i32| level.dot(towards).max(0.0).powi(sharp);
        let studio = 0.42 + 0.36 * above + 0.95 * lamp(LAMPS[0], 22) + 0.50 * lamp(LAMPS[1], 26);
        let dull = 0.42 + 0.52 * normal.dot(self.key).max(0.0) + 0.15 * normal.dot(self.fill).max(0.0);
        let gloss = mirrored.dot(self.key).max(0.0).powi(80);
        self.steel * (0.55 * studio + 0.45 * dull) + Vec3::splat(0.2 * gloss)
    }

    /// The colour of planes (linear).
    pub fn table(&self) -> Vec3 {
        self.table
    }

    /// The key light's direction.
    pub fn key(&self) -> Vec3 {
        self.key
    }

    /// The colour of a bared surface on which a value has this one (linear).
    pub fn bared(&self, colour: Vec3) -> Vec3 {
        colour.lerp(self.bared, BARED.1)
    }

    /// The colour of the shape at rest (linear).
    pub fn ghost(&self) -> Vec3 {
        self.ghost
    }
}

/// The light behind everything at a height of the picture, 0 at the top and 1 at the bottom.
pub fn background(height: f32) -> Vec3 {
    let (top, bottom) = (Vec3::new(0.995, 0.996, 0.998), Vec3::new(0.925, 0.935, 0.945));
    colour::linear(top.lerp(bottom, height))
}
