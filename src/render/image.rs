//! A picture as pixels.

use glam::Vec2;

/// An opaque picture, row by row from the top, sRGB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Pixels a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green, blue.
    pub pixels: Vec<[u8; 3]>,
}

impl Image {
    /// A picture of one colour.
    pub fn new(width: usize, height: usize, colour: [u8; 3]) -> Image {
        Image { width, height, pixels: vec![colour; width * height] }
    }

    /// The colour of a pixel inside the picture.
    pub fn at(&self, x: usize, y: usize) -> [u8; 3] {
        self.pixels[y * self.width + x]
    }

    /// Sets a pixel; outside of the picture nothing happens.
    pub fn set(&mut self, x: i32, y: i32, colour: [u8; 3]) {
        if let Some(pixel) = self.pixel(x, y) {
            *pixel = colour;
        }
    }

    /// Draws a straight line with round ends and soft borders, from centre to centre (pixels).
    pub fn stroke(&mut self, a: Vec2, b: Vec2, width: f32, colour: [u8; 3]) {
        let reach = Vec2::splat(width + 1.0);
        let (low, high) = ((a.min(b) - reach).as_ivec2(), (a.max(b) + reach).as_ivec2());
        for y in low.y..=high.y {
            for x in low.x..=high.x {
                let point = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let along = ((point - a).dot(b - a) / (b - a).length_squared().max(1e-6)).clamp(0.0, 1.0);
                let cover = (width / 2.0 + 0.5 - point.distance(a.lerp(b, along))).clamp(0.0, 1.0);
                if let Some(pixel) = self.pixel(x, y) {
                    for (old, new) in pixel.iter_mut().zip(colour) {
                        *old = (f32::from(*old) + (f32::from(new) - f32::from(*old)) * cover).round() as u8;
                    }
                }
            }
        }
    }

    fn pixel(&mut self, x: i32, y: i32) -> Option<&mut [u8; 3]> {
        let inside = (0..self.width as i32).contains(&x) && (0..self.height as i32).contains(&y);
        if inside { self.pixels.get_mut(y as usize * self.width + x as usize) } else { None }
    }
}
