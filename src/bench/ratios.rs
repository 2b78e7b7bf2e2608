//! Figures 3 and 4 of Comas et al. 2008 with our figures, as SVG: CPU against GPU, and systems kept apart against fused ones.

use super::plot::{COLOURS, count};
use super::{Case, Record, Row};
use crate::plot::axis::Axis;
use crate::plot::svg::Svg;

const FRAME: [f64; 4] = [84.0, 84.0, 800.0, 560.0];
const INK: &str = "#2c323a";

/// A named line of (degrees of freedom or nodes, value).
type Line = (String, Vec<(f64, f64)>);

/// How many times as long a step takes on the CPU as on the GPU, over degrees of freedom; `None` where one of them was not
/// measured.
pub fn cpu_to_gpu(record: &Record) -> Option<String> {
    let mut lines = Vec::new();
    for gpu in record.rows.iter().filter(|row| row.case.is_gpu()) {
        let same = |case: &Case| {
            let of = &gpu.case;
            (case.element, case.effects, case.cells) == (of.element, of.effects, of.cells)
                && (case.fuse, &case.scheme) == (of.fuse, &of.scheme)
        };
        for cpu in record.rows.iter().filter(|row| !row.case.is_gpu() && same(&row.case)) {
            let split = if gpu.case.fuse { "" } else { ", split" };
            let name = format!(
                "{:?}, {}{split}: {} {} / GPU {}",
                gpu.case.element,
                gpu.case.effects.name(),
                cpu.case.on(),
                cpu.case.scheme,
                gpu.case.scheme
            );
            let point = (3.0 * gpu.nodes as f64, cpu.ns_per_element_step / gpu.ns_per_element_step);
            add(&mut lines, name, point);
        }
    }
    let title = "CPU to GPU: how many times as long a step takes";
    drawing(title, &devices(record), "degrees of freedom", "time on the CPU over time on the GPU", 1.0, &lines)
}

/// What keeping systems apart costs (%), over nodes; `None` where not both were measured.
pub fn split_to_fused(record: &Record) -> Option<String> {
    let mut lines = Vec::new();
    for fused in record.rows.iter().filter(|row| row.case.fuse) {
        let wanted = fused.case.split();
        let Some(split) = record.rows.iter().find(|row| row.case == wanted) else { continue };
        let case = &fused.case;
        let on = case.on();
        let name = format!("{:?}, {}, {on}, {}", case.element, case.effects.name(), case.scheme);
        let more = |of: fn(&Row) -> Option<f64>| Some(100.0 * (of(split)? / of(fused)? - 1.0));
        let at = fused.nodes as f64;
        if let Some(more) = more(|row| Some(row.ns_per_element_step)) {
            add(&mut lines, format!("{name}, whole step"), (at, more));
        }
        if let Some(more) = more(|row| row.gpu_ns) {
            add(&mut lines, format!("{name}, kernels"), (at, more));
        }
    }
    let title = "What keeping systems apart costs (Comas et al.: 8.4 %)";
    drawing(title, &devices(record), "nodes", "split takes longer than fused (%)", 0.0, &lines)
}

/// What was measured on; nobody is to take a program for a device.
fn devices(record: &Record) -> String {
    let mut names: Vec<String> =
        record.machine.first().map(|m| format!("CPU: {}", m.instructions)).into_iter().collect();
    for adapter in record.rows.iter().filter_map(|row| row.adapter.as_ref()) {
        let software = if adapter.contains("software") { ": A PROGRAM ON THE CPU, no measure of GPUs" } else { "" };
        let name = format!("GPU: {adapter}{software}");
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names.join("; ")
}

fn add(lines: &mut Vec<Line>, name: String, point: (f64, f64)) {
    match lines.iter_mut().find(|line| line.0 == name) {
        Some(line) => line.1.push(point),
        None => lines.push((name, vec![point])),
    }
}

/// Lines over a logarithmic x and a linear y, with a line at `level`, where nothing is gained.
fn drawing(title: &str, devices: &str, x_name: &str, y_name: &str, level: f64, lines: &[Line]) -> Option<String> {
    let points = || lines.iter().flat_map(|line| line.1.iter().copied());
    points().next()?;
    let mut svg = Svg::new((1320.0, 640.0));
    let x = Axis::new(points().map(|point| point.0), FRAME[0], FRAME[2]);
    for (value, named) in x.ticks() {
        let at = x.at(value);
        svg.line((at, FRAME[1]), (at, FRAME[3]), if named { "#dfe3e8" } else { "#f1f3f5" }, 1.0, "");
        if named {
            svg.text((at, FRAME[3] + 21.0), &count(value), 13.0, INK, "middle");
        }
    }
    let low = points().map(|point| point.1).fold(level.min(0.0), f64::min);
    let high = points().map(|point| point.1).fold(level, f64::max);
    let step = round_step((high - low).max(1e-3) / 6.0);
    let (first, last) = ((low / step).floor() as i32, (high / step).ceil() as i32);
    let y = |value: f64| {
        let share = (value / step - f64::from(first)) / f64::from(last - first);
        FRAME[3] + (FRAME[1] - FRAME[3]) * share
    };
    for tick in first..=last {
        let value = f64::from(tick) * step;
        svg.line((FRAME[0], y(value)), (FRAME[2], y(value)), "#dfe3e8", 1.0, "");
        // no more digits than the step has
        let digits = (-step.log10().floor()).max(0.0) as usize;
        svg.text((FRAME[0] - 9.0, y(value) + 4.5), &format!("{value:.digits$}"), 13.0, INK, "end");
    }
    svg.line((FRAME[0], y(level)), (FRAME[2], y(level)), "#6b7480", 1.5, "6 4");
    svg.frame(FRAME, "#aab2bc");
    for (place, (name, points)) in lines.iter().enumerate() {
        let colour = COLOURS[place % COLOURS.len()];
        let filled = place < COLOURS.len();
        let of: Vec<(f64, f64)> = points.iter().map(|&(a, b)| (x.at(a), y(b))).collect();
        svg.path(&of, colour, 2.0, 1.0);
        of.iter().for_each(|&at| svg.circle(at, 4.5, colour, filled));
        let down = FRAME[1] + 10.0 + 20.0 * place as f64;
        svg.line((FRAME[2] + 16.0, down), (FRAME[2] + 40.0, down), colour, 3.0, "");
        svg.circle((FRAME[2] + 28.0, down), 4.5, colour, filled);
        svg.text((FRAME[2] + 46.0, down + 4.5), name, 13.0, INK, "start");
    }
    svg.text((0.5 * (FRAME[0] + FRAME[2]), FRAME[3] + 46.0), x_name, 15.0, INK, "middle");
    svg.turned((28.0, 0.5 * (FRAME[1] + FRAME[3])), y_name, 15.0, INK);
    svg.text((FRAME[0], 36.0), title, 21.0, INK, "start");
    svg.text((FRAME[0], 62.0), devices, 13.0, INK, "start");
    Some(svg.finish())
}

/// 1, 2 or 5 times a power of ten, at least so large.
fn round_step(least: f64) -> f64 {
    let decade = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0].map(|digit| digit * decade).into_iter().find(|&step| step >= least).unwrap_or(10.0 * decade)
}
