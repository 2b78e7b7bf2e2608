//! A benchmark as tables.

use super::{Record, Row};

/// One row a case.
pub fn csv(record: &Record) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // memory takes everything
    let _ = writer.write_record([
        "element",
        "effects",
        "backend",
        "precision",
        "threads",
        "scheme",
        "cells",
        "elements",
        "nodes",
        "ns_per_element_step",
        "median_ns",
        "updates_per_s",
        "two_pass_ratio",
        "flops",
        "bytes",
        "bandwidth_share",
        "peak_share",
        "setup_s",
        "memory_peak",
        "fuse",
        "gpu_ns",
        "adapter",
        "instructions",
        "load",
        "gravity_ratio",
    ]);
    let optional = |number: Option<f64>| number.map(|number| number.to_string()).unwrap_or_default();
    for row in &record.rows {
        let case = &row.case;
        let _ = writer.write_record([
            format!("{:?}", case.element),
            case.effects.name().into(),
            case.backend.clone(),
            case.precision.clone(),
            case.threads.to_string(),
            case.scheme.clone(),
            case.cells.to_string(),
            row.elements.to_string(),
            row.nodes.to_string(),
            row.ns_per_element_step.to_string(),
            row.median_ns.to_string(),
            row.updates_per_s.to_string(),
            optional(row.two_pass_ratio),
            row.flops.to_string(),
            row.bytes.to_string(),
            optional(row.bandwidth_share),
            optional(row.peak_share),
            row.setup_s.to_string(),
            row.memory_peak.map(|bytes| bytes.to_string()).unwrap_or_default(),
            if case.fuse { "on" } else { "off" }.into(),
            optional(row.gpu_ns),
            row.adapter.clone().unwrap_or_default(),
            if case.is_gpu() { String::new() } else { case.instructions.clone() },
            case.load.name().into(),
            optional(row.gravity_ratio),
        ]);
    }
    writer.into_inner().map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).unwrap_or_default()
}

/// The machine, and a table.
pub fn markdown(record: &Record) -> String {
    let mut text = String::new();
    for machine in &record.machine {
        text += &format!(
            "{} thread{}, {}: copies {:.1} GB/s, multiplies and adds {:.0} GFLOP/s\n",
            machine.threads,
            if machine.threads == 1 { "" } else { "s" },
            machine.instructions,
            machine.bytes_per_s * 1e-9,
            machine.flops_per_s * 1e-9
        );
    }
    let mut adapters: Vec<&String> = record.rows.iter().filter_map(|row| row.adapter.as_ref()).collect();
    adapters.dedup();
    adapters.iter().for_each(|adapter| text += &format!("GPU: {adapter}\n"));
    text += "\n| element | effects | load | on | scheme | cells | ns an element and step | median | M elements/s | against two passes | against gravity | bytes | of bandwidth | flop | of peak |\n\
             |---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for row in &record.rows {
        text += &line(row);
    }
    text
}

/// A row of the table.
pub fn line(row: &Row) -> String {
    let case = &row.case;
    let on = case.on();
    let scheme = if case.fuse { case.scheme.clone() } else { format!("{}, split", case.scheme) };
    let ratio = |ratio: Option<f64>| ratio.map_or("".into(), |ratio| format!("{ratio:.2}"));
    let percent = |share: Option<f64>| share.map_or("".into(), |share| format!("{:.0} %", 100.0 * share));
    format!(
        "| {:?} | {} | {} | {on} | {scheme} | {} | {:.2} | {:.2} | {:.1} | {} | {} | {:.0} | {} | {:.0} | {} |\n",
        case.element,
        case.effects.name(),
        case.load.name(),
        case.cells,
        row.ns_per_element_step,
        row.median_ns,
        row.updates_per_s * 1e-6,
        ratio(row.two_pass_ratio),
        ratio(row.gravity_ratio),
        row.bytes,
        percent(row.bandwidth_share),
        row.flops,
        percent(row.peak_share)
    )
}
