//! Tables have rows at the times that are asked for, whatever the steps are.
//!
//! A body that flies without a force is where v t says at any time: linear interpolation is exact, and bounds are those
//! of rounding (f32: 2e-7 of a displacement a step, compensated). Under gravity the error is that of a chord, g Δt²/8.

use crate::configurations::{configurations, near};
use std::path::Path;

fn scene(gravity: f64, every: &str) -> String {
    format!(
        r#"(
            duration: 0.02,
            bodies: {{"b": (
                mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1), elements: Hex8), material: "m", velocity: (3, 0, 0),
            )}},
            materials: {{"m": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.4))}},
            loads: [Gravity(acceleration: (0, 0, {gravity}))],
            probes: {{
                "u": (what: Displacement, on: All, every: {every}),
                "v": (what: Velocity, on: All, every: {every}),
            }},
            integration: (step: 0.00037, when_unstable: Watch),
            guards: (off: [Energy]),
            output: (fields_every: 0.02, energies_every: {every}),
        )"#
    )
}

fn table(folder: &Path, name: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(folder.join(name)).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

#[test]
fn rows_lie_between_steps_where_they_are_asked_for() {
    let place = tempfile::tempdir().unwrap();
    for run in configurations() {
        let mut simulation = run.start(&scene(-9.81, "0.003"));
        crate::frames::run_into(&mut simulation, place.path());
        let end = simulation.time();
        let step = simulation.time_step();
        for name in ["probe_u.csv", "probe_v.csv", "energy.csv"] {
            let times: Vec<f64> = table(place.path(), name).iter().map(|row| row[0]).collect();
            assert_eq!(times, [0.0, 0.003, 0.006, 0.009, 0.012, 0.015, 0.018, end], "{}, {name}", run.name);
        }
        for row in table(place.path(), "probe_u.csv") {
            near(&format!("{}, x({})", run.name, row[0]), row[1], 3.0 * row[0], 0.06, run.bound(1e-12, 1e-6));
            let fallen = -0.5 * 9.81 * row[0] * row[0];
            near(
                &format!("{}, z({})", run.name, row[0]),
                row[3],
                fallen,
                9.81 * step * step / 8.0,
                1.01 + run.bound(0.0, 0.1),
            );
        }
        // of the middle of the step before, as everywhere
        for row in &table(place.path(), "probe_v.csv")[1..] {
            near(
                &format!("{}, vz({})", run.name, row[0]),
                row[3],
                -9.81 * (row[0] - step / 2.0),
                0.2,
                run.bound(1e-9, 1e-5),
            );
        }
        // energies are interpolated alike: they balance between steps as they do at their ends
        for row in &table(place.path(), "energy.csv")[1..] {
            let [kinetic, strain, load, internal] = [row[1], row[2], row[5], row[8]];
            near(&format!("{}, work({})", run.name, row[0]), load, kinetic + strain - 4.5, 4.5, run.bound(1e-9, 1e-5));
            near("internal work", internal, strain, 4.5, run.bound(1e-9, 1e-5));
        }
    }
}

#[test]
fn rows_keep_their_times_when_the_step_changes() {
    let place = tempfile::tempdir().unwrap();
    for run in configurations() {
        let mut simulation = run.start(&scene(0.0, "0.001"));
        simulation.write_into(&mut sinew::output::Folder::create(place.path()).unwrap()).unwrap();
        simulation.observe().unwrap();
        // to steps that go beyond a time that lay several of the old ones ahead, and back
        for (time, step) in [(0.0021, 0.0001), (0.0052, 0.00077), (0.009, 0.0021), (0.014, 0.00013)] {
            simulation.advance_to(time).unwrap();
            simulation.set_time_step(step).unwrap();
        }
        simulation.finish().unwrap();
        let rows = table(place.path(), "probe_u.csv");
        let mut next = 0;
        for row in &rows[..rows.len() - 1] {
            near(&format!("{}, x({})", run.name, row[0]), row[1], 3.0 * row[0], 0.06, run.bound(1e-12, 1e-6));
            let number = row[0] / 0.001;
            // steps longer than the interval have a row each
            let whole = (number - number.round()).abs() < 1e-9;
            assert!(whole || row[0] > 0.009 && row[0] < 0.0171, "{}: a row at {}", run.name, row[0]);
            next = next.max(number.round() as usize);
        }
        assert_eq!(next, (simulation.time() / 0.001 - 1e-9).floor() as usize, "{}: {rows:?}", run.name);
    }
}

/// Where something may touch, what contact takes has a column, which names and units know; elsewhere it has none.
#[test]
fn what_contact_takes_is_a_column_where_something_may_touch() {
    let place = tempfile::tempdir().unwrap();
    let wall =
        "tools: {\"wall\": (shape: Box(size: (0.02, 1, 1)), at: (0.111, 0, 0))}, contacts: [Tool(tool: \"wall\")],";
    for run in configurations() {
        for touches in [false, true] {
            let slow = scene(0.0, "0.005").replace("(3, 0, 0)", "(0.3, 0, 0)");
            let text = slow.replacen("loads:", &format!("{} loads:", if touches { wall } else { "" }), 1);
            let mut simulation = run.start(&text);
            crate::frames::run_into(&mut simulation, place.path());
            let summary = simulation.summary("done").unwrap();
            let columns = &summary.names.columns["energy.csv"];
            let column = columns.iter().position(|(name, unit)| (&name[..], &unit[..]) == ("contact loss", "J"));
            assert_eq!((column.is_some(), summary.energies.contact_loss.is_some()), (touches, touches), "{}", run.name);
            let rows = table(place.path(), "energy.csv");
            assert!(rows.iter().all(|row| row.len() == columns.len()), "{}", run.name);
            let Some(column) = column else { continue };
            let (lost, energy) = (summary.tools["wall"].loss.unwrap(), rows[0][1]);
            assert!(lost > 0.1 * energy, "{}: {lost} of {energy} J", run.name);
            near(run.name, rows[rows.len() - 1][column], lost, energy, 1e-12);
        }
    }
}
