//! Drawings as pixels.

use super::drawing::{Anchor, Drawing, Edge, Shape, Text};
use super::letters;
use tiny_skia::{Color, FillRule, LineJoin, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, StrokeDash, Transform};

/// Why a drawing could not be turned into pixels.
#[derive(Debug, thiserror::Error)]
#[error("the plot cannot be drawn: {0}")]
pub struct PlotError(String);

/// A PNG file of a drawing, `zoom` pixels a unit.
///
/// # Errors
/// That it is too large for memory.
pub fn png(drawing: &Drawing, zoom: f32) -> Result<Vec<u8>, PlotError> {
    page(drawing, zoom)?.encode_png().map_err(|error| PlotError(error.to_string()))
}

/// A drawing as red, green, blue and how much is covered, one pixel a unit, row by row; colours are those of the
/// covered part times its share.
///
/// # Errors
/// That it is too large for memory.
pub fn overlay(drawing: &Drawing) -> Result<Vec<[u8; 4]>, PlotError> {
    Ok(page(drawing, 1.0)?.data().as_chunks::<4>().0.to_vec())
}

fn page(drawing: &Drawing, zoom: f32) -> Result<Pixmap, PlotError> {
    let pixels = |length: f64| (length as f32 * zoom) as u32;
    let page = Pixmap::new(pixels(drawing.size.0), pixels(drawing.size.1));
    let page = page.ok_or_else(|| PlotError("it is empty or too large".into()))?;
    let mut canvas = Canvas { page, zoom: Transform::from_scale(zoom, zoom) };
    drawing.shapes.iter().for_each(|shape| canvas.draw(shape));
    Ok(canvas.page)
}

/// Pixels that are drawn on.
struct Canvas {
    page: Pixmap,
    zoom: Transform,
}

impl Canvas {
    fn draw(&mut self, shape: &Shape) {
        match shape {
            Shape::Line { from, to, colour, width, dashes } => {
                let dash = StrokeDash::new(dashes.clone(), 0.0);
                let stroke = Stroke { width: *width as f32, dash, ..Stroke::default() };
                self.stroke(lines(&[*from, *to], false), &paint(colour, 1.0), &stroke, self.zoom);
            }
            Shape::Polyline { points, colour, width, opacity } => {
                let stroke = Stroke { width: *width as f32, line_join: LineJoin::Round, ..Stroke::default() };
                self.stroke(lines(points, false), &paint(colour, *opacity), &stroke, self.zoom);
            }
            Shape::Rectangle { area, colour } => self.fill(rectangle(area), &paint(colour, 1.0), self.zoom),
            Shape::Frame { area, colour } => self.outline(rectangle(area), colour, 1.0),
            Shape::Circle { centre, radius, colour, fill } => {
                let circle = PathBuilder::from_circle(centre.0 as f32, centre.1 as f32, *radius as f32);
                if let Some(fill) = fill {
                    self.fill(circle.clone(), &paint(fill, 1.0), self.zoom);
                }
                self.outline(circle, colour, 1.6);
            }
            Shape::Diamond { centre: (x, y), reach, colour, fill } => {
                let corners = [(*x, y - reach), (x + reach, *y), (*x, y + reach), (x - reach, *y)];
                self.fill(lines(&corners, true), &paint(fill, 1.0), self.zoom);
                self.outline(lines(&corners, true), colour, 1.4);
            }
            Shape::Polygon { points, colour, opacity } => {
                self.fill(lines(points, true), &paint(colour, *opacity), self.zoom);
            }
            Shape::Text(text) => self.write(text),
        }
    }

    fn write(&mut self, text: &Text) {
        let (size, (x, y)) = (text.size as f32, (text.at.0 as f32, text.at.1 as f32));
        let share = match text.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5,
            Anchor::End => 1.0,
        };
        let start = x - share * letters::width(&text.text, size);
        let outlines = || letters::outlines(&text.text, size, (start, y));
        let turn = if text.turned { Transform::from_rotate_at(-90.0, x, y) } else { Transform::identity() };
        let (ink, place) = (paint(&text.colour, 1.0), self.zoom.pre_concat(turn));
        let stroke = |width: f64| Stroke { width: width as f32, line_join: LineJoin::Round, ..Stroke::default() };
        if let Edge::White(width) = text.edge {
            self.stroke(outlines(), &paint("#ffffff", 1.0), &stroke(width), place);
        }
        self.fill(outlines(), &ink, place);
        if let Edge::Same(width) = text.edge {
            self.stroke(outlines(), &ink, &stroke(width), place);
        }
    }

    fn outline(&mut self, path: Option<Path>, colour: &str, width: f32) {
        self.stroke(path, &paint(colour, 1.0), &Stroke { width, ..Stroke::default() }, self.zoom);
    }

    /// What has no extent has no path, and is not seen.
    fn stroke(&mut self, path: Option<Path>, paint: &Paint<'_>, stroke: &Stroke, place: Transform) {
        if let Some(path) = path {
            self.page.stroke_path(&path, paint, stroke, place, None);
        }
    }

    fn fill(&mut self, path: Option<Path>, paint: &Paint<'_>, place: Transform) {
        if let Some(path) = path {
            self.page.fill_path(&path, paint, FillRule::Winding, place, None);
        }
    }
}

fn lines(points: &[(f64, f64)], closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (place, &(x, y)) in points.iter().enumerate() {
        match place {
            0 => path.move_to(x as f32, y as f32),
            _ => path.line_to(x as f32, y as f32),
        }
    }
    if closed {
        path.close();
    }
    path.finish()
}

fn rectangle(area: &[f64; 4]) -> Option<Path> {
    let [left, top, right, bottom] = area.map(|number| number as f32);
    Rect::from_ltrb(left, top, right, bottom).map(PathBuilder::from_rect)
}

/// A colour `#rrggbb` of which so much is seen; black for what is none.
fn paint(colour: &str, opacity: f64) -> Paint<'static> {
    let digits = colour.strip_prefix('#').and_then(|digits| u32::from_str_radix(digits, 16).ok());
    debug_assert!(digits.is_some(), "no colour: {colour}");
    let [_, red, green, blue] = digits.unwrap_or_default().to_be_bytes();
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(Color::from_rgba8(red, green, blue, (255.0 * opacity).round() as u8));
    paint
}
