//! Light on the surface.

use super::colour;
use glam::Vec3;

/// A key light from the upper left, a weaker one from the right, some light from everywhere and a small gloss.
/// Directions as the eye sees them: to the right, up, towards the eye.
pub struct Light {
    key: Vec3,
    fill: Vec3,
    gloss: Vec3,
    bared: Vec3,
    ghost: Vec3,
}

/// The tint of surfaces that were bared (sRGB), and its share.
const BARED: (Vec3, f32) = (Vec3::new(0.86, 0.62, 0.58), 0.72);
/// The colour of the shape at rest (sRGB).
const GHOST: Vec3 = Vec3::new(0.50, 0.56, 0.64);

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
        }
    }

    /// The light that a surface of the given colour (linear) and normal (of length 1) sends to the eye.
    pub fn on(&self, normal: Vec3, colour: Vec3) -> Vec3 {
        let around = 0.44 + 0.08 * normal.y;
        let diffuse = around + 0.52 * normal.dot(self.key).max(0.0) + 0.18 * normal.dot(self.fill).max(0.0);
        colour * diffuse + Vec3::splat(0.05 * normal.dot(self.gloss).max(0.0).powi(60))
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
