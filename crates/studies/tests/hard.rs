//! The hard cases in their everyday size: every one passes, or fails honestly where it says why.
//! In full, with a table: `cargo run --release -- hard --full`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::backend::gpu::gpu_or_reason;
use sinew::mesh::ElementKind;
use sinew_studies::hard::{CASES, Case, CaseConfiguration, run};

/// Whether a configuration has its turn on this machine. A GPU in software takes a hundred times as long: there a case
/// is run with two kinds of elements, plain ones and those with a mean pressure by turns. Contact is the same kernels
/// whatever it moves: its cases are run with one kind, each kind with a quarter of them. What is slow there has no
/// row: what slides and meets elsewhere does so by the same kernels. `sinew hard` leaves nothing out.
fn has_turn(case: &Case, configuration: &CaseConfiguration, software: bool) -> bool {
    let number: usize = case.id[1..].parse().expect("a case has a number");
    if case.slow.implicit && configuration.implicit && configuration.elements != ElementKind::Hex8 {
        return false;
    }
    let kinds = if number < 36 { 2 } else { 1 };
    let rows: Vec<_> = CaseConfiguration::all(true).into_iter().filter(|c| c.is_gpu() && case.has_row(c)).collect();
    let turns = rows.len().div_ceil(kinds).max(1);
    let is_it = |(place, row): (usize, &CaseConfiguration)| {
        place % turns == number % turns && row.elements == configuration.elements
    };
    !(software && configuration.is_gpu()) || !case.slow.software && rows.iter().enumerate().any(is_it)
}

fn check(id: &str) {
    let case = CASES.iter().find(|case| case.id == id).unwrap_or_else(|| panic!("there is no case {id}"));
    let mut wrong = Vec::new();
    let gpu = gpu_or_reason();
    let software = gpu.as_ref().is_some_and(|gpu| gpu.report().software);
    let all = CaseConfiguration::all(gpu.is_some());
    for configuration in all.iter().filter(|c| case.has_row(c) && has_turn(case, c, software)) {
        let row = run(case, configuration, false);
        let figure = row.tightest().map(|gate| format!("{}: {:.3e}, {}", gate.what, gate.figure, gate.allowed));
        println!(
            "{id} {} {}: {} in {:.2} s, {figure:?} {:?}",
            row.elements, row.machine, row.verdict, row.seconds, row.message
        );
        if row.verdict != row.expected {
            let gates = row.gates.iter().filter(|gate| !gate.passed);
            let gates: Vec<String> = gates.map(|g| format!("{}: {:.4e} ({})", g.what, g.figure, g.allowed)).collect();
            wrong.push(format!("{} on {}: {}, {gates:?} {:?}", row.elements, row.machine, row.verdict, row.message));
        }
    }
    assert!(wrong.is_empty(), "{id}, {}:\n{}", case.title, wrong.join("\n"));
}

macro_rules! cases {
    (everyday: $($short:ident)*; long: $($long:ident)*;) => {
        $(#[test] fn $short() { check(stringify!($short)); })*
        $(#[test] #[ignore = "long"] fn $long() { check(stringify!($long)); })*
        #[test]
        fn all_cases_are_here() {
            let mut here = [$(stringify!($short),)* $(stringify!($long)),*];
            here.sort_unstable();
            assert_eq!(CASES.iter().map(|case| case.id).collect::<Vec<_>>(), here);
        }
    };
}
cases!(
    everyday: h04 h15 h16 h27 h28 h34;
    long: h01 h02 h03 h05 h06 h07 h08 h09 h10 h11 h12 h13 h14 h17 h18 h19 h20 h21 h22 h23 h24 h25 h26 h29 h30 h31 h32 h33 h35
        h36 h37 h38 h39 h40 h41 h42 h43 h44 h45 h46 h47 h48 h49 h50 h51 h52 h54 h55 h56 h57 h58 h59 h61 h62 h63 h64 h68 h69 h70;
);
