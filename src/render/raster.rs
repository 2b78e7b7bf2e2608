//! Triangles to samples: a depth buffer over a strip of the picture.

use super::colour::Ramp;
use super::light::Light;
use glam::{Vec2, Vec3};

/// A triangle in the picture.
pub struct Triangle {
    /// Places (samples) and inverse distances from the eye.
    pub places: [Vec3; 3],
    /// Normals as the eye sees them, turned towards it.
    pub normals: [Vec3; 3],
    /// What is coloured.
    pub values: [f32; 3],
    /// Which sides are element edges: that opposite to the first corner, and so on.
    pub edges: [bool; 3],
    /// How dark its element edges are, 0 to 1.
    pub ink: f32,
}

/// What the triangles of one picture share.
pub struct Look<'a> {
    /// Colours of values.
    pub ramp: &'a Ramp,
    /// The light.
    pub light: &'a Light,
    /// Half the width of element edges (samples).
    pub edge: f32,
}

/// Some rows of samples.
pub struct Strip {
    /// Samples a row.
    pub width: usize,
    /// The first row's number in the whole picture.
    pub top: usize,
    /// Light towards the eye; no meaning where nothing is.
    pub light: Vec<Vec3>,
    /// Inverse distance of what is seen (1/m), 0 where nothing is.
    pub nearness: Vec<f32>,
}

impl Strip {
    /// An empty strip.
    pub fn new(width: usize, top: usize, rows: usize) -> Strip {
        Strip { width, top, light: vec![Vec3::ZERO; width * rows], nearness: vec![0.0; width * rows] }
    }

    /// Draws a triangle as far as it lies in the strip and is nearer than what is there.
    pub fn draw(&mut self, triangle: &Triangle, look: &Look<'_>) {
        let [a, b, c] = triangle.places.map(Vec3::truncate);
        let rows = self.nearness.len() / self.width;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let top = (low.y - 0.5).ceil().max(self.top as f32);
        let bottom = (high.y - 0.5).floor().min((self.top + rows) as f32 - 1.0);
        let doubled = (b - a).perp_dot(c - a);
        // as a negation, so that a triangle of unknown place (NaN) ends here too
        if !(top <= bottom && doubled.abs() > 1e-9 && high.x >= 0.0) {
            return;
        }
        let left = (low.x - 0.5).ceil().max(0.0) as usize;
        let right = (high.x - 0.5).floor().min(self.width as f32 - 1.0);
        if right < left as f32 {
            return;
        }
        let heights = [(b, c), (c, a), (a, b)].map(|(from, to)| doubled.abs() / from.distance(to));
        for row in top as usize..=bottom as usize {
            for column in left..=right as usize {
                let at = Vec2::new(column as f32 + 0.5, row as f32 + 0.5);
                let wb = (at - a).perp_dot(c - a) / doubled;
                let wc = (b - a).perp_dot(at - a) / doubled;
                let share = Vec3::new(1.0 - wb - wc, wb, wc);
                if share.min_element() < 0.0 {
                    continue;
                }
                let place = (row - self.top) * self.width + column;
                let nearness = share.dot(Vec3::from_array(triangle.places.map(|corner| corner.z)));
                if nearness > self.nearness[place] {
                    self.nearness[place] = nearness;
                    self.light[place] = sample(triangle, look, share, nearness, heights);
                }
            }
        }
    }
}

/// The light of one sample; `share` is of the corners in the picture.
fn sample(triangle: &Triangle, look: &Look<'_>, share: Vec3, nearness: f32, heights: [f32; 3]) -> Vec3 {
    let [p, q, r] = triangle.places.map(|corner| corner.z);
    // shares on the surface itself, which perspective changes
    let true_share = share * Vec3::new(p, q, r) / nearness;
    let [l, m, n] = triangle.normals;
    let normal = (l * true_share.x + m * true_share.y + n * true_share.z).normalize_or(Vec3::Z);
    let colour = look.ramp.light(true_share.dot(Vec3::from_array(triangle.values)));
    let mut ink = 0.0f32;
    for corner in 0..3 {
        if triangle.edges[corner] {
            ink = ink.max(look.edge + 0.5 - share[corner] * heights[corner]);
        }
    }
    look.light.on(normal, colour) * (1.0 - ink.clamp(0.0, 1.0) * triangle.ink)
}
