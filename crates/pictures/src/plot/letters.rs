//! Letters as outlines, of fonts that sinew brings along, so that they look the same everywhere.

use std::sync::LazyLock;
use tiny_skia::PathBuilder;
use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// The fonts: a letter that the first has not is of the second.
static FACES: LazyLock<Vec<Face<'static>>> = LazyLock::new(|| {
    let fonts = [epaint_default_fonts::UBUNTU_LIGHT, epaint_default_fonts::HACK_REGULAR];
    fonts.into_iter().filter_map(|font| Face::parse(font, 0).ok()).collect()
});

/// A letter: its font and number there. Letters that no font has are the first's box.
fn glyph(letter: char) -> Option<(&'static Face<'static>, GlyphId)> {
    let faces: &'static [Face<'static>] = &FACES;
    let known = faces.iter().find_map(|face| Some((face, face.glyph_index(letter)?)));
    known.or_else(|| faces.first().map(|face| (face, GlyphId(0))))
}

/// Pixels a unit of a font.
fn scale(face: &Face<'_>, size: f32) -> f32 {
    size / f32::from(face.units_per_em())
}

/// Width of a line of text (pixels), of letters so high (pixels).
pub fn width(text: &str, size: f32) -> f32 {
    let advance = |(face, glyph): (&Face<'_>, GlyphId)| {
        scale(face, size) * f32::from(face.glyph_hor_advance(glyph).unwrap_or_default())
    };
    text.chars().filter_map(glyph).map(advance).sum()
}

/// The outlines of a line of text whose base line begins at a place (pixels, y down).
pub fn outlines(text: &str, size: f32, at: (f32, f32)) -> Option<tiny_skia::Path> {
    let mut pen = Pen { path: PathBuilder::new(), at, scale: 1.0 };
    for (face, glyph) in text.chars().filter_map(glyph) {
        pen.scale = scale(face, size);
        // spaces have none
        let _ = face.outline_glyph(glyph, &mut pen);
        pen.at.0 += pen.scale * f32::from(face.glyph_hor_advance(glyph).unwrap_or_default());
    }
    pen.path.finish()
}

/// Draws outlines of fonts, whose y goes up.
struct Pen {
    path: PathBuilder,
    at: (f32, f32),
    scale: f32,
}

impl Pen {
    fn place(&self, x: f32, y: f32) -> (f32, f32) {
        (self.at.0 + self.scale * x, self.at.1 - self.scale * y)
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.place(x1, y1), self.place(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.place(x1, y1), self.place(x2, y2), self.place(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}
