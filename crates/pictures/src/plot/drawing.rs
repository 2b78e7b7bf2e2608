//! Drawings of lines and letters: shapes on a page, from which both SVG and pixels are made.

use super::labels::Area;

/// A drawing that grows.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// Width and height (pixels).
    pub(crate) size: (f64, f64),
    /// What is on it, what is seen last on top.
    pub(crate) shapes: Vec<Shape>,
}

/// What is drawn. Colours are `#rrggbb`, widths in pixels.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// A straight line; lengths of dashes and gaps, none for a whole line.
    Line { from: (f64, f64), to: (f64, f64), colour: String, width: f64, dashes: Vec<f32> },
    /// Lines through points; how much of them is seen, 1 for all.
    Polyline { points: Vec<(f64, f64)>, colour: String, width: f64, opacity: f64 },
    /// A filled rectangle.
    Rectangle { area: Area, colour: String },
    /// The outline of a rectangle, a pixel wide.
    Frame { area: Area, colour: String },
    /// A circle with an outline; filled or not.
    Circle { centre: (f64, f64), radius: f64, colour: String, fill: Option<String> },
    /// A square on its corner, filled, with an outline.
    Diamond { centre: (f64, f64), reach: f64, colour: String, fill: String },
    /// A filled outline through points; how much of it is seen.
    Polygon { points: Vec<(f64, f64)>, colour: String, opacity: f64 },
    /// A line of text.
    Text(Text),
}

/// A line of text.
#[derive(Clone, Debug)]
pub(crate) struct Text {
    /// Its base line at its [anchor](Self::anchor).
    pub at: (f64, f64),
    /// What it says.
    pub text: String,
    /// Height of letters (pixels).
    pub size: f64,
    /// Of letters.
    pub colour: String,
    /// Which part of it stands at its place.
    pub anchor: Anchor,
    /// What goes round the letters.
    pub edge: Edge,
    /// Whether it goes from bottom to top.
    pub turned: bool,
}

/// Which part of a text stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Its beginning.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// What goes round letters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Edge {
    /// Nothing.
    None,
    /// A line of their own colour, so wide.
    Same(f64),
    /// A white line below them, so wide.
    White(f64),
}

const WHITE: &str = "#ffffff";

impl Drawing {
    /// An empty white page of a width and height (pixels).
    pub fn new(size: (f64, f64)) -> Self {
        let mut page = Self::clear(size);
        page.area([0.0, 0.0, size.0, size.1], WHITE);
        page
    }

    /// An empty page that can be seen through.
    pub fn clear(size: (f64, f64)) -> Self {
        Self { size, shapes: Vec::new() }
    }

    /// A straight line; lengths of dashes and gaps, none for a whole line.
    pub fn line(&mut self, from: (f64, f64), to: (f64, f64), colour: &str, width: f64, dashes: &[f32]) {
        self.shapes.push(Shape::Line { from, to, colour: colour.into(), width, dashes: dashes.to_vec() });
    }

    /// Lines through points.
    pub fn path(&mut self, points: &[(f64, f64)], colour: &str, width: f64, opacity: f64) {
        if points.len() > 1 {
            self.shapes.push(Shape::Polyline { points: points.to_vec(), colour: colour.into(), width, opacity });
        }
    }

    /// A filled rectangle.
    pub fn area(&mut self, area: Area, colour: &str) {
        self.shapes.push(Shape::Rectangle { area, colour: colour.into() });
    }

    /// The outline of a rectangle.
    pub fn frame(&mut self, area: Area, colour: &str) {
        self.shapes.push(Shape::Frame { area, colour: colour.into() });
    }

    /// A disc, or a hollow one.
    pub fn circle(&mut self, centre: (f64, f64), radius: f64, colour: &str, filled: bool) {
        let fill = Some(if filled { colour } else { WHITE }.to_owned());
        self.shapes.push(Shape::Circle { centre, radius, colour: colour.into(), fill });
    }

    /// A ring with nothing in it.
    pub fn ring(&mut self, centre: (f64, f64), radius: f64, colour: &str) {
        self.shapes.push(Shape::Circle { centre, radius, colour: colour.into(), fill: None });
    }

    /// A square on its corner, or a hollow one.
    pub fn diamond(&mut self, centre: (f64, f64), reach: f64, colour: &str, filled: bool) {
        let fill = if filled { colour } else { WHITE }.to_owned();
        self.shapes.push(Shape::Diamond { centre, reach, colour: colour.into(), fill });
    }

    /// A filled outline through points, nearly clear or not.
    pub fn band(&mut self, points: &[(f64, f64)], colour: &str, opacity: f64) {
        if points.len() > 2 {
            self.shapes.push(Shape::Polygon { points: points.to_vec(), colour: colour.into(), opacity });
        }
    }

    /// A line of text.
    pub fn text(&mut self, at: (f64, f64), text: &str, size: f64, colour: &str, anchor: Anchor) {
        self.write(at, text, size, colour, anchor, Edge::None);
    }

    /// A line of strong letters: light ones would be lost on a picture.
    pub fn strong(&mut self, at: (f64, f64), text: &str, size: f64, colour: &str, anchor: Anchor) {
        self.write(at, text, size, colour, anchor, Edge::Same(0.035 * size));
    }

    /// A line of text with a white edge, so that it can be read on lines.
    pub fn label(&mut self, at: (f64, f64), text: &str, size: f64, colour: &str) {
        self.write(at, text, size, colour, Anchor::Start, Edge::White(3.0));
    }

    /// A line of text from bottom to top, about its middle.
    pub fn turned(&mut self, at: (f64, f64), text: &str, size: f64, colour: &str) {
        let (text, colour, anchor) = (text.to_owned(), colour.to_owned(), Anchor::Middle);
        self.shapes.push(Shape::Text(Text { at, text, size, colour, anchor, edge: Edge::None, turned: true }));
    }

    fn write(&mut self, at: (f64, f64), text: &str, size: f64, colour: &str, anchor: Anchor, edge: Edge) {
        let (text, colour) = (text.to_owned(), colour.to_owned());
        self.shapes.push(Shape::Text(Text { at, text, size, colour, anchor, edge, turned: false }));
    }
}
