//! ns an element and step against the number of elements, as a drawing.

use super::{Case, Load, Record, Row};
use sinew_pictures::plot::Drawing;
use sinew_pictures::plot::panels::{self, Line, Panel, Point, Rise, Words};

/// Lines of the same configuration over sizes: a panel for each element and its effects.
pub fn drawing(record: &Record) -> Option<Drawing> {
    let mut panels = Vec::new();
    for row in &record.rows {
        let split = if row.case.fuse { "" } else { ", split" };
        let name = format!("{}, {}{split}", row.case.on(), row.case.scheme);
        let point = Point { x: row.elements as f64, y: row.ns_per_element_step, band: band(row) };
        add(&mut panels, row, name, point);
    }
    let remark = remark(record);
    let axes = ["elements", "ns an element and step"];
    panels::drawing(&Words { title: "What a step costs", remark: &remark, axes }, panels, Rise::Logarithmic)
}

/// From the best of all blocks to the third quartile; to the median in records of before.
pub(super) fn band(row: &Row) -> (f64, f64) {
    (row.ns_per_element_step, row.third_quartile_ns.unwrap_or(row.median_ns))
}

/// Whether a row is of a GPU that is a program on the CPU.
pub(super) fn is_software(row: &Row) -> bool {
    row.adapter.as_ref().is_some_and(|adapter| adapter.contains("software"))
}

/// Adds a point to the line of a name, in the panel of a row's element and effects. What ran on a software GPU has
/// panels of its own, with axes of their own: it tells nothing of GPUs, and nothing beside CPUs.
pub(super) fn add(panels: &mut Vec<Panel>, row: &Row, name: String, point: Point) {
    let Case { element, effects, load, .. } = &row.case;
    let software = is_software(row);
    let load = if *load == Load::Gravity { String::new() } else { format!(", load: {}", load.name()) };
    let title = format!("{element:?}, {}{load}{}", effects.name(), if software { ": a software GPU" } else { "" });
    let place = panels.iter().position(|panel| panel.title == title).unwrap_or_else(|| {
        panels.push(Panel { title, kind: software.into(), lines: Vec::new() });
        panels.len() - 1
    });
    let lines = &mut panels[place].lines;
    match lines.iter_mut().find(|line| line.name == name) {
        Some(line) => line.points.push(point),
        None => lines.push(Line { name, points: vec![point] }),
    }
}

/// What was measured on, and what bands are; nobody is to take a program for a device.
pub(super) fn remark(record: &Record) -> String {
    let cpu = record.machine.first().map(|machine| format!("CPU: {}", machine.instructions));
    let mut parts: Vec<String> = cpu.into_iter().collect();
    for row in &record.rows {
        let Some(adapter) = &row.adapter else { continue };
        let software = if is_software(row) { ", a program on the CPU: no measure of GPUs" } else { "" };
        let name = format!("GPU: {adapter}{software}");
        if !parts.contains(&name) {
            parts.push(name);
        }
    }
    parts.push("lines: the best of all blocks; bands: to the third quartile".into());
    parts.join("; ")
}
