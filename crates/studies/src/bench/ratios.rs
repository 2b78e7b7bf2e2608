//! Figures 3 and 4 of Comas et al. 2008 with our figures, as drawings: CPU against GPU, and systems kept apart against
//! fused ones.

use super::plot::{add, band, is_software, remark};
use super::{Case, Record, Row};
use sinew_pictures::plot::Drawing;
use sinew_pictures::plot::panels::{Panel, Point, Rise, Words, drawing};

/// How many times as long a step takes on the CPU as on the GPU, over degrees of freedom; `None` where one of them was
/// not measured. A software GPU does not count: it is a program on the CPU.
pub fn cpu_to_gpu(record: &Record) -> Option<Drawing> {
    let mut panels: Vec<Panel> = Vec::new();
    for gpu in record.rows.iter().filter(|row| row.case.is_gpu() && !is_software(row)) {
        let same = |case: &Case| {
            let of = &gpu.case;
            (case.element, case.effects, case.cells, case.load) == (of.element, of.effects, of.cells, of.load)
                && (case.fuse, &case.scheme) == (of.fuse, &of.scheme)
        };
        for cpu in record.rows.iter().filter(|row| !row.case.is_gpu() && same(&row.case)) {
            let split = if gpu.case.fuse { "" } else { ", split" };
            let name = format!("{}, {}{split}", cpu.case.on(), cpu.case.scheme);
            let (low, high) = (band(cpu), band(gpu));
            let y = cpu.ns_per_element_step / gpu.ns_per_element_step;
            let point = Point { x: 3.0 * gpu.nodes as f64, y, band: (low.0 / high.1, low.1 / high.0) };
            add(&mut panels, gpu, name, point);
        }
    }
    let left_out = if record.rows.iter().any(is_software) { "; the software GPU is left out" } else { "" };
    let words = Words {
        title: "CPU to GPU: how many times as long a step takes",
        remark: &(remark(record) + left_out),
        axes: ["degrees of freedom", "time on the CPU over time on the GPU"],
    };
    drawing(&words, panels, Rise::Even(1.0))
}

/// What keeping systems apart costs (%), over nodes; `None` where not both were measured.
pub fn split_to_fused(record: &Record) -> Option<Drawing> {
    let mut panels: Vec<Panel> = Vec::new();
    for fused in record.rows.iter().filter(|row| row.case.fuse) {
        let wanted = fused.case.split();
        let Some(split) = record.rows.iter().find(|row| row.case == wanted) else { continue };
        let name = format!("{}, {}", fused.case.on(), fused.case.scheme);
        let percent = |more: f64, less: f64| 100.0 * (more / less - 1.0);
        let (apart, together) = (band(split), band(fused));
        let x = fused.nodes as f64;
        let noise = (percent(apart.0, together.1), percent(apart.1, together.0));
        let y = percent(split.ns_per_element_step, fused.ns_per_element_step);
        add(&mut panels, fused, format!("{name}, whole step"), Point { x, y, band: noise });
        let kernels = |row: &Row| row.gpu_ns;
        if let (Some(apart), Some(together)) = (kernels(split), kernels(fused)) {
            // measured once
            let y = percent(apart, together);
            add(&mut panels, fused, format!("{name}, kernels"), Point { x, y, band: (y, y) });
        }
    }
    let words = Words {
        title: "What keeping systems apart costs (Comas et al.: 8.4 %)",
        remark: &remark(record),
        axes: ["nodes", "split takes longer than fused (%)"],
    };
    drawing(&words, panels, Rise::Even(0.0))
}
