//! Letters in a picture.

use super::image::Image;
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Point, Size};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle, iso_8859_1};
use embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use embedded_graphics::text::{Alignment, Baseline, Text, TextStyleBuilder};
use std::convert::Infallible;

/// A size of letters that suits a picture.
#[derive(Clone, Copy)]
pub struct Letters {
    font: &'static MonoFont<'static>,
    /// Pixels of the picture along the side of a pixel of the font.
    zoom: i32,
}

/// Which point of a text its place means.
#[derive(Clone, Copy)]
#[allow(missing_docs)]
pub enum Anchor {
    Middle,
    Right,
}

impl Letters {
    /// Letters for a picture of that width and height (pixels).
    pub fn new((width, height): (usize, usize)) -> Letters {
        let height = height.min(width * 3 / 4);
        let font = match height {
            0..300 => &iso_8859_1::FONT_6X10,
            300..500 => &iso_8859_1::FONT_8X13,
            _ => &iso_8859_1::FONT_10X20,
        };
        Letters { font, zoom: ((height as i32 + 360) / 900).max(1) }
    }

    /// Width of a letter (pixels).
    pub fn width(&self) -> i32 {
        self.font.character_size.width as i32 * self.zoom
    }

    /// Height of a line (pixels).
    pub fn height(&self) -> i32 {
        self.font.character_size.height as i32 * self.zoom
    }

    /// Writes a line whose top is at `y`.
    pub fn write(&self, image: &mut Image, text: &str, (x, y): (i32, i32), anchor: Anchor, colour: [u8; 3]) {
        let alignment = match anchor {
            Anchor::Middle => Alignment::Center,
            Anchor::Right => Alignment::Right,
        };
        let place = TextStyleBuilder::new().baseline(Baseline::Top).alignment(alignment).build();
        let style = MonoTextStyle::new(self.font, Rgb888::new(colour[0], colour[1], colour[2]));
        let mut page = Page { image, zoom: self.zoom, x, y };
        let Ok(_) =
            embedded_graphics::Drawable::draw(&Text::with_text_style(text, Point::zero(), style, place), &mut page);
    }
}

/// The picture with the origin at the text's place and, when zoomed, larger pixels.
struct Page<'a> {
    image: &'a mut Image,
    zoom: i32,
    x: i32,
    y: i32,
}

impl OriginDimensions for Page<'_> {
    fn size(&self) -> Size {
        Size::new(self.image.width as u32, self.image.height as u32)
    }
}

impl DrawTarget for Page<'_> {
    type Color = Rgb888;
    type Error = Infallible;
    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(Point { x, y }, colour) in pixels {
            for part in 0..self.zoom * self.zoom {
                let (dx, dy) = (part % self.zoom, part / self.zoom);
                let colour = [colour.r(), colour.g(), colour.b()];
                self.image.set(self.x + x * self.zoom + dx, self.y + y * self.zoom + dy, colour);
            }
        }
        Ok(())
    }
}
