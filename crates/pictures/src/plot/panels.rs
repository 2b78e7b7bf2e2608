//! Small multiples: panels beside each other, each of a few lines over a logarithmic axis, with a band where a line has
//! noise.

use super::axis::Axis;
use super::drawing::{Anchor, Drawing};

/// More lines than these are not told apart.
pub const LINES: usize = 5;
/// Colours that people with every kind of sight can tell apart (M. Okabe, K. Ito 2008).
const COLOURS: [&str; LINES] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56627a"];
const INK: &str = "#2c323a";
/// Panels in a row, and the size of each with its margins (pixels).
const ROW: usize = 3;
const PANEL: (f64, f64) = (400.0, 420.0);
/// Left, top, right and bottom of the axes in a panel, without the lines' names below.
const AXES: [f64; 4] = [70.0, 44.0, 384.0, 290.0];
/// Above the first row.
const HEAD: f64 = 84.0;

/// A point: where it is along x, its value, and from where to where it was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Along x, above 0.
    pub x: f64,
    /// Its value.
    pub y: f64,
    /// The band of noise about it.
    pub band: (f64, f64),
}

/// A line with a name.
pub struct Line {
    /// What it is called.
    pub name: String,
    /// Its points, by x.
    pub points: Vec<Point>,
}

/// Lines that are drawn together.
pub struct Panel {
    /// What they have in common.
    pub title: String,
    /// Panels of one kind have the same axes.
    pub kind: u8,
    /// The lines.
    pub lines: Vec<Line>,
}

/// How values go up a panel.
#[derive(Clone, Copy, PartialEq)]
pub enum Rise {
    /// By factors.
    Logarithmic,
    /// Evenly, with a line at the level at which nothing is gained.
    Even(f64),
}

/// What all panels share.
pub struct Words<'a> {
    /// Above all.
    pub title: &'a str,
    /// Below that.
    pub remark: &'a str,
    /// Along x and y.
    pub axes: [&'a str; 2],
}

/// Panels with at most [`LINES`] lines each: one with more becomes several.
fn split(panels: Vec<Panel>) -> Vec<Panel> {
    let mut few = Vec::new();
    for panel in panels {
        let parts = panel.lines.len().div_ceil(LINES);
        let mut lines = panel.lines.into_iter().peekable();
        let mut part = 1;
        while lines.peek().is_some() {
            let title = if parts > 1 { format!("{} ({part} of {parts})", panel.title) } else { panel.title.clone() };
            few.push(Panel { title, kind: panel.kind, lines: lines.by_ref().take(LINES).collect() });
            part += 1;
        }
    }
    few
}

/// All panels; `None` where there is no point.
pub fn drawing(words: &Words<'_>, panels: Vec<Panel>, rise: Rise) -> Option<Drawing> {
    let panels = split(panels);
    let points = |panel: &Panel| panel.lines.iter().flat_map(|line| line.points.clone()).collect::<Vec<_>>();
    if panels.iter().all(|panel| points(panel).is_empty()) {
        return None;
    }
    let (columns, rows) = (panels.len().min(ROW), panels.len().div_ceil(ROW));
    let size = (f64::max(columns as f64 * PANEL.0, 1.6 * PANEL.0), HEAD + rows as f64 * PANEL.1);
    let mut page = Drawing::new(size);
    page.text((24.0, 36.0), words.title, 21.0, INK, Anchor::Start);
    page.text((24.0, 60.0), words.remark, 13.0, "#59626e", Anchor::Start);
    for (place, panel) in panels.iter().enumerate() {
        let of_kind: Vec<Point> = panels.iter().filter(|p| p.kind == panel.kind).flat_map(points).collect();
        let corner = ((place % ROW) as f64 * PANEL.0, HEAD + (place / ROW) as f64 * PANEL.1);
        let frame = [AXES[0] + corner.0, AXES[1] + corner.1, AXES[2] + corner.0, AXES[3] + corner.1];
        Drawn { page: &mut page, frame, words }.panel(panel, &of_kind, rise);
    }
    Some(page)
}

/// A panel that is being drawn.
struct Drawn<'a> {
    page: &'a mut Drawing,
    frame: [f64; 4],
    words: &'a Words<'a>,
}

impl Drawn<'_> {
    fn panel(&mut self, panel: &Panel, of_kind: &[Point], rise: Rise) {
        let [left, top, right, bottom] = self.frame;
        let x = Axis::new(of_kind.iter().map(|point| point.x), left, right);
        for (value, named) in x.ticks() {
            let at = x.at(value);
            self.page.line((at, top), (at, bottom), if named { "#dfe3e8" } else { "#f1f3f5" }, 1.0, &[]);
            if named {
                self.page.text((at, bottom + 17.0), &count(value), 12.0, INK, Anchor::Middle);
            }
        }
        let bands = || of_kind.iter().flat_map(|point| [point.y, point.band.0, point.band.1]);
        let y: Box<dyn Fn(f64) -> f64> = match rise {
            Rise::Logarithmic => {
                let axis = Axis::new(bands(), bottom, top);
                let named = axis.ticks().into_iter().filter(|tick| tick.1);
                named.for_each(|(value, _)| self.tick(axis.at(value), &value.to_string()));
                Box::new(move |value| axis.at(value))
            }
            Rise::Even(level) => self.even(bands().fold(level, f64::min), bands().fold(level, f64::max), level),
        };
        self.page.frame(self.frame, "#aab2bc");
        for (line, colour) in panel.lines.iter().zip(COLOURS) {
            let at = |value: fn(&Point) -> f64| {
                line.points.iter().map(|point| (x.at(point.x), y(value(point)))).collect::<Vec<_>>()
            };
            let band: Vec<_> = at(|p| p.band.0).into_iter().chain(at(|p| p.band.1).into_iter().rev()).collect();
            self.page.band(&band, colour, 0.2);
            let middle = at(|point| point.y);
            self.page.path(&middle, colour, 1.8, 1.0);
            middle.iter().for_each(|&at| self.page.circle(at, 3.2, colour, true));
        }
        for (row, (line, colour)) in panel.lines.iter().zip(COLOURS).enumerate() {
            let down = bottom + 56.0 + 16.0 * row as f64;
            self.page.line((left, down - 4.0), (left + 22.0, down - 4.0), colour, 3.0, &[]);
            self.page.text((left + 30.0, down), &line.name, 12.0, INK, Anchor::Start);
        }
        self.page.text((left, top - 10.0), &panel.title, 14.0, INK, Anchor::Start);
        self.page.text((0.5 * (left + right), bottom + 36.0), self.words.axes[0], 13.0, INK, Anchor::Middle);
        self.page.turned((left - 52.0, 0.5 * (top + bottom)), self.words.axes[1], 13.0, INK);
    }

    fn tick(&mut self, at: f64, text: &str) {
        self.page.line((self.frame[0], at), (self.frame[2], at), "#dfe3e8", 1.0, &[]);
        self.page.text((self.frame[0] - 8.0, at + 4.0), text, 12.0, INK, Anchor::End);
    }

    /// An even axis from `low` to `high` with a line at `level`.
    fn even(&mut self, low: f64, high: f64, level: f64) -> Box<dyn Fn(f64) -> f64> {
        let step = round_step((high - low).max(1e-3) / 5.0);
        let (first, last) = ((low / step).floor(), (high / step).ceil());
        let [_, top, _, bottom] = self.frame;
        let y = move |value: f64| bottom + (top - bottom) * (value / step - first) / (last - first);
        // no more digits than the step has
        let digits = (-step.log10().floor()).max(0.0) as usize;
        for tick in first as i64..=last as i64 {
            let value = tick as f64 * step;
            self.tick(y(value), &format!("{value:.digits$}"));
        }
        self.page.line((self.frame[0], y(level)), (self.frame[2], y(level)), "#6b7480", 1.5, &[6.0, 4.0]);
        Box::new(y)
    }
}

/// 1, 2 or 5 times a power of ten, at least so large.
fn round_step(least: f64) -> f64 {
    let decade = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0].map(|digit| digit * decade).into_iter().find(|&step| step >= least).unwrap_or(10.0 * decade)
}

fn count(value: f64) -> String {
    match value {
        v if v >= 1e6 => format!("{} M", v * 1e-6),
        v if v >= 1e3 => format!("{} k", v * 1e-3),
        v => v.to_string(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::super::svg;
    use super::*;

    fn panel(lines: usize) -> Panel {
        let point = |x: f64| Point { x, y: x / 2.0, band: (x / 2.0, x) };
        let line = |number: usize| Line { name: format!("line {number}"), points: vec![point(10.0), point(1000.0)] };
        Panel { title: "title".into(), kind: 0, lines: (0..lines).map(line).collect() }
    }

    #[test]
    fn no_panel_has_more_than_five_lines_and_each_line_its_band() {
        let words = Words { title: "all", remark: "", axes: ["x", "y"] };
        for rise in [Rise::Logarithmic, Rise::Even(0.0)] {
            let drawing = svg(&drawing(&words, vec![panel(12), panel(2)], rise).unwrap());
            let document = roxmltree::Document::parse(&drawing).unwrap();
            let count = |tag: &str| document.descendants().filter(|node| node.has_tag_name(tag)).count();
            assert_eq!((count("polyline"), count("polygon")), (14, 14));
            for part in ["title (1 of 3)", "title (3 of 3)", "line 11"] {
                assert!(drawing.contains(part), "{part}");
            }
            assert!(!drawing.contains("NaN"));
        }
        assert!(split(vec![panel(12)]).iter().all(|panel| panel.lines.len() <= LINES));
        assert!(drawing(&words, vec![], Rise::Logarithmic).is_none());
    }
}
