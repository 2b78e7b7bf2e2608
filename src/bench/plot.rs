//! ns an element and step against the number of elements, as SVG.

use super::{Case, Record};
use crate::plot::axis::Axis;
use crate::plot::svg::Svg;

const FRAME: [f64; 4] = [84.0, 64.0, 800.0, 560.0];
pub(super) const COLOURS: [&str; 8] =
    ["#2f6db5", "#c2553d", "#3f8f5b", "#8a63a8", "#c78a1f", "#4a9aa8", "#8a5a44", "#6b7480"];

/// Lines of the same configuration over sizes.
pub fn svg(record: &Record) -> String {
    let mut names: Vec<String> = Vec::new();
    for row in &record.rows {
        let name = name(&row.case);
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let mut svg = Svg::new((1180.0, 640.0));
    let x = Axis::new(record.rows.iter().map(|row| row.elements as f64), FRAME[0], FRAME[2]);
    let y = Axis::new(record.rows.iter().map(|row| row.ns_per_element_step), FRAME[3], FRAME[1]);
    for (value, named) in x.ticks() {
        let at = x.at(value);
        svg.line((at, FRAME[1]), (at, FRAME[3]), if named { "#dfe3e8" } else { "#f1f3f5" }, 1.0, "");
        if named {
            svg.text((at, FRAME[3] + 21.0), &count(value), 13.0, "#2c323a", "middle");
        }
    }
    for (value, named) in y.ticks() {
        let at = y.at(value);
        svg.line((FRAME[0], at), (FRAME[2], at), if named { "#dfe3e8" } else { "#f1f3f5" }, 1.0, "");
        if named {
            svg.text((FRAME[0] - 9.0, at + 4.5), &value.to_string(), 13.0, "#2c323a", "end");
        }
    }
    svg.frame(FRAME, "#aab2bc");
    for (place, wanted) in names.iter().enumerate() {
        let colour = COLOURS[place % COLOURS.len()];
        let of: Vec<(f64, f64)> = record
            .rows
            .iter()
            .filter(|row| name(&row.case) == *wanted)
            .map(|row| (x.at(row.elements as f64), y.at(row.ns_per_element_step)))
            .collect();
        svg.path(&of, colour, 2.0, 1.0);
        let filled = place < COLOURS.len();
        of.iter().for_each(|&at| svg.circle(at, 4.5, colour, filled));
        let down = FRAME[1] + 10.0 + 20.0 * place as f64;
        svg.line((FRAME[2] + 16.0, down), (FRAME[2] + 40.0, down), colour, 3.0, "");
        svg.circle((FRAME[2] + 28.0, down), 4.5, colour, filled);
        svg.text((FRAME[2] + 46.0, down + 4.5), wanted, 13.0, "#2c323a", "start");
    }
    svg.text((0.5 * (FRAME[0] + FRAME[2]), FRAME[3] + 46.0), "elements", 15.0, "#2c323a", "middle");
    svg.turned((28.0, 0.5 * (FRAME[1] + FRAME[3])), "ns an element and step", 15.0, "#2c323a");
    svg.text((FRAME[0], 36.0), "What a step costs", 21.0, "#2c323a", "start");
    svg.finish()
}

fn name(case: &Case) -> String {
    let on = case.on();
    let split = if case.fuse { "" } else { ", split" };
    format!("{:?}, {}, {on}, {}{split}", case.element, case.effects.name(), case.scheme)
}

pub(super) fn count(value: f64) -> String {
    match value {
        v if v >= 1e6 => format!("{} M", v * 1e-6),
        v if v >= 1e3 => format!("{} k", v * 1e-3),
        v => v.to_string(),
    }
}
