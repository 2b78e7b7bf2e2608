//! `sinew bench`, and the figures drawn from what it measured. Times are not asserted: machines are busy.

use crate::sinew::Workspace;
use sinew::mesh::ElementKind;
use sinew_pictures::plot::svg;
use sinew_studies::bench::{Case, Effects, Load, Record, Row, cpu_to_gpu, drawing, split_to_fused};

#[test]
fn a_benchmark_leaves_a_row_a_case_with_the_columns_that_are_told() {
    let place = Workspace::new();
    let asked = ["bench", "--cells", "3", "--elements", "tet4,hex8", "--effects", "none", "--seconds", "0.01"];
    place.done(&[&asked[..], &["--threads", "1", "--schemes", "patches", "--out", "out/bench"]].concat());
    let table = place.read("out/bench/bench.csv");
    let mut lines = table.lines();
    let columns: Vec<&str> = lines.next().unwrap().split(',').collect();
    let told = include_str!("../../../../docs/command_line.md").split("## sinew bench").nth(1).unwrap();
    for column in &columns {
        assert!(told.contains(column), "docs/command_line.md does not tell of the column {column}");
    }
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let cell = |row: usize, name: &str| rows[row][columns.iter().position(|column| *column == name).unwrap()];
    assert_eq!(rows.len(), 2);
    assert_eq!((cell(0, "element"), cell(0, "elements"), cell(0, "cells")), ("Tet4", "162", "3"));
    assert_eq!((cell(1, "element"), cell(1, "elements"), cell(1, "fuse")), ("Hex8", "27", "on"));
    for name in ["ns_per_element_step", "median_ns", "updates_per_s", "setup_s", "bytes", "flops"] {
        assert!(cell(0, name).parse::<f64>().unwrap() > 0.0, "{name}");
    }
    // nothing to set against each other
    assert!(place.path("out/bench/bench.png").exists() && !place.path("out/bench/cpu_to_gpu.svg").exists());
}

#[test]
fn records_of_before_there_was_a_choice_can_be_compared_with() {
    let place = Workspace::new();
    let asked = ["bench", "--cells", "2", "--elements", "tet4", "--effects", "none", "--seconds", "0.01"];
    let asked = [&asked[..], &["--threads", "1", "--schemes", "patches"]].concat();
    place.done(&[&asked[..], &["--out", "out/bench"]].concat());
    let record = place.read("out/bench/bench.json");
    let of_today = |line: &str| line.contains("\"fuse\"") || line.contains("\"instructions\": \"widest\"");
    let old: String = record.lines().filter(|line| !of_today(line)).map(|line| format!("{line}\n")).collect();
    assert_ne!(record, old);
    std::fs::write(place.path("old.json"), old).unwrap();
    // slower or not: the case is found again
    let said = place.sinew(&[&asked[..], &["--compare", "old.json"]].concat());
    assert!(said.said.contains("times as long: Tet4, none, gravity, 1 × f32, patches, 2 cells"), "{}", said.said);
}

fn row(backend: &str, cells: u32, fuse: bool, ns: f64, gpu_ns: Option<f64>, adapter: Option<&str>) -> Row {
    let case = Case {
        element: ElementKind::Hex8,
        effects: Effects::FibresViscosity,
        backend: backend.into(),
        precision: "f32".into(),
        threads: 1,
        instructions: "widest".into(),
        scheme: "two-pass".into(),
        cells,
        fuse,
        load: Load::Gravity,
    };
    Row {
        case,
        elements: u64::from(cells).pow(3),
        nodes: u64::from(cells + 1).pow(3),
        ns_per_element_step: ns,
        median_ns: 1.1 * ns,
        third_quartile_ns: Some(1.2 * ns),
        updates_per_s: 1e9 / ns,
        two_pass_ratio: None,
        gravity_ratio: None,
        flops: 1.0,
        bytes: 1.0,
        bandwidth_share: None,
        peak_share: None,
        setup_s: 1.0,
        memory_peak: None,
        adapter: adapter.map(str::to_string),
        gpu_ns,
    }
}

#[test]
fn a_software_gpu_is_drawn_apart_from_all_else_and_compared_with_nothing() {
    let (software, card) = (Some("llvmpipe (software, Vulkan, Mesa)"), Some("Some card (discrete, Vulkan, driver)"));
    let rows = |adapter| {
        let rows = |n| [row("cpu", n, true, 40.0, None, None), row("gpu", n, true, 80.0, Some(70.0), adapter)];
        Record { machine: Vec::new(), rows: [10, 20].into_iter().flat_map(rows).collect() }
    };
    let mut record = rows(software);
    assert!(cpu_to_gpu(&record).is_none(), "a program on the CPU is no GPU");
    let figure = svg(&cpu_to_gpu(&rows(card)).unwrap());
    assert!(figure.contains("Some card") && figure.contains("1 × f32, two-pass"), "{figure}");
    assert!(split_to_fused(&record).is_none(), "nothing was kept apart");

    // the card joins the CPU's panel, the program has one of its own
    record.rows.push(row("gpu", 10, true, 9.0, None, card));
    let figure = svg(&drawing(&record).unwrap());
    let (own, apart) = ("Hex8, fibres-viscosity<", "Hex8, fibres-viscosity: a software GPU<");
    assert!(figure.matches(own).count() == 1 && figure.matches(apart).count() == 1, "{figure}");
    assert!(figure.contains("llvmpipe (software, Vulkan, Mesa), a program on the CPU: no measure of GPUs"), "{figure}");
    // what was measured at several sizes has a band from the best to the third quartile
    assert_eq!(figure.matches("<polygon").count(), 2, "{figure}");

    record.rows.push(row("gpu", 10, false, 88.0, Some(73.5), software));
    record.rows.retain(|row| row.case.is_gpu() && row.adapter.as_deref() == software);
    let figure = svg(&split_to_fused(&record).unwrap());
    assert!(figure.contains("GPU, two-pass, whole step") && figure.contains("GPU, two-pass, kernels"), "{figure}");
    assert!(svg(&drawing(&record).unwrap()).contains("two-pass, split"), "both are lines of their own");
}

#[test]
fn no_panel_has_more_than_five_lines() {
    let mut record = Record { machine: Vec::new(), rows: Vec::new() };
    for threads in 1..=12 {
        for cells in [10, 20] {
            let mut row = row("cpu", cells, true, 40.0 / threads as f64, None, None);
            row.case.threads = threads;
            record.rows.push(row);
        }
    }
    let figure = svg(&drawing(&record).unwrap());
    let panels: Vec<&str> = figure.split(" of 3)").collect();
    assert_eq!(panels.len(), 4, "{figure}");
    assert_eq!(figure.matches("<polyline").count(), 12);
}
