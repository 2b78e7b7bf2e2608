//! Shapes as SVG.

use super::labels::Area;
use std::fmt::Write;

/// A drawing that grows.
pub struct Svg {
    text: String,
}

const FONTS: &str = "Ubuntu, 'Segoe UI', 'Helvetica Neue', Arial, sans-serif";

impl Svg {
    /// An empty white page of a width and height (pixels).
    pub fn new((width, height): (f64, f64)) -> Self {
        let mut page = Self::clear((width, height));
        let _ = writeln!(page.text, "<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>");
        page
    }

    /// An empty page that can be seen through.
    pub fn clear((width, height): (f64, f64)) -> Self {
        let mut text = String::new();
        let _ = writeln!(
            text,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"{FONTS}\">"
        );
        Self { text }
    }

    /// The whole file.
    pub fn finish(mut self) -> String {
        self.text += "</svg>\n";
        self.text
    }

    /// A straight line; `dashes` as SVG has them, empty for none.
    pub fn line(&mut self, a: (f64, f64), b: (f64, f64), colour: &str, width: f64, dashes: &str) {
        let (ax, ay, bx, by) = (a.0, a.1, b.0, b.1);
        let dashes = if dashes.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{dashes}\"") };
        let _ = writeln!(
            self.text,
            "<line x1=\"{ax:.1}\" y1=\"{ay:.1}\" x2=\"{bx:.1}\" y2=\"{by:.1}\" stroke=\"{colour}\" \
             stroke-width=\"{width}\"{dashes}/>"
        );
    }

    /// Lines through points.
    pub fn path(&mut self, points: &[(f64, f64)], colour: &str, width: f64, opacity: f64) {
        if points.len() < 2 {
            return;
        }
        let points: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(
            self.text,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-opacity=\"{opacity}\" \
             stroke-linejoin=\"round\"/>",
            points.join(" ")
        );
    }

    /// A filled rectangle.
    pub fn area(&mut self, [left, top, right, bottom]: Area, colour: &str) {
        let (width, height) = (right - left, bottom - top);
        let _ = writeln!(
            self.text,
            "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{colour}\"/>"
        );
    }

    /// The outline of a rectangle.
    pub fn frame(&mut self, [left, top, right, bottom]: Area, colour: &str) {
        let (width, height) = (right - left, bottom - top);
        let _ = writeln!(
            self.text,
            "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill=\"none\" stroke=\"{colour}\"/>"
        );
    }

    /// A disc, or a hollow one.
    pub fn circle(&mut self, (x, y): (f64, f64), radius: f64, colour: &str, filled: bool) {
        let fill = if filled { colour } else { "#ffffff" };
        let _ = writeln!(
            self.text,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"1.6\"/>"
        );
    }

    /// A ring with nothing in it.
    pub fn ring(&mut self, (x, y): (f64, f64), radius: f64, colour: &str) {
        let _ = writeln!(
            self.text,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\"/>"
        );
    }

    /// A square on its corner, or a hollow one.
    pub fn diamond(&mut self, (x, y): (f64, f64), reach: f64, colour: &str, filled: bool) {
        let fill = if filled { colour } else { "#ffffff" };
        let (left, right, top, bottom) = (x - reach, x + reach, y - reach, y + reach);
        let _ = writeln!(
            self.text,
            "<path d=\"M{x:.1} {top:.1}L{right:.1} {y:.1}L{x:.1} {bottom:.1}L{left:.1} {y:.1}Z\" fill=\"{fill}\" \
             stroke=\"{colour}\" stroke-width=\"1.4\"/>"
        );
    }

    /// A line of text; `anchor` is `start`, `middle` or `end`.
    pub fn text(&mut self, (x, y): (f64, f64), text: &str, size: f64, colour: &str, anchor: &str) {
        let text = escaped(text);
        let _ = writeln!(
            self.text,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" fill=\"{colour}\" text-anchor=\"{anchor}\">{text}</text>"
        );
    }

    /// A line of strong letters: light ones would be lost on a picture.
    pub fn strong(&mut self, (x, y): (f64, f64), text: &str, size: f64, colour: &str, anchor: &str) {
        let (text, stroke) = (escaped(text), 0.035 * size);
        let _ = writeln!(
            self.text,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size:.1}\" fill=\"{colour}\" stroke=\"{colour}\" \
             stroke-width=\"{stroke:.2}\" text-anchor=\"{anchor}\">{text}</text>"
        );
    }

    /// A filled outline through points, nearly clear or not.
    pub fn band(&mut self, points: &[(f64, f64)], colour: &str, opacity: f64) {
        if points.len() < 3 {
            return;
        }
        let points: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        let points = points.join(" ");
        let _ = writeln!(self.text, "<polygon points=\"{points}\" fill=\"{colour}\" fill-opacity=\"{opacity}\"/>");
    }

    /// A line of text with a white edge, so that it can be read on lines.
    pub fn label(&mut self, (x, y): (f64, f64), text: &str, size: f64, colour: &str) {
        let text = escaped(text);
        let _ = writeln!(
            self.text,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" fill=\"{colour}\" stroke=\"#ffffff\" stroke-width=\"3\" \
             stroke-linejoin=\"round\" paint-order=\"stroke\">{text}</text>"
        );
    }

    /// A line of text from bottom to top, about its middle.
    pub fn turned(&mut self, (x, y): (f64, f64), text: &str, size: f64, colour: &str) {
        let text = escaped(text);
        let _ = writeln!(
            self.text,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" fill=\"{colour}\" text-anchor=\"middle\" \
             transform=\"rotate(-90 {x:.1} {y:.1})\">{text}</text>"
        );
    }
}

/// Text as XML takes it, which knows no control characters.
fn escaped(text: &str) -> String {
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
