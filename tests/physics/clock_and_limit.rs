//! The clock, and the limit of the time step (H29): .99 of it runs, more is refused, or caught and not handed out as a
//! result.

use crate::configurations::{configurations, cpu_and_long_gpu, near, scene_of};
use sinew::{Error, Simulation};
use std::path::Path;

fn scene(cells: usize, integration: &str) -> String {
    format!(
        "(duration: 100, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: ({cells}, {cells}, {cells}), elements: Hex8), material: \"m\", spin: (1, 0, 0.3))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        integration: ({integration}))"
    )
}

/// The element bound, exact for one cube.
fn limit(cells: usize) -> f64 {
    let run = &configurations()[0];
    run.start(&scene(cells, "")).summary("").unwrap().stable_step
}

/// 2/ω of the cube: ω² = (8/ρ)(3λ + 2μ)·Σ b_x²; Σ b_x² = 8/(16 h²).
#[test]
fn limit_of_a_cube_is_the_closed_form() {
    let (shear, lambda, size) = (3000.0 / 2.9, 1e4 - 2.0 / 3.0 * 3000.0 / 2.9, 0.1);
    let square = 8.0 / 1000.0 * (3.0 * lambda + 2.0 * shear) * 0.5 / (size * size);
    near("limit", limit(1), 2.0 / f64::sqrt(square), 1.0, 1e-9);
}

#[test]
fn just_below_the_limit_a_free_block_runs_on() {
    for run in cpu_and_long_gpu() {
        for cells in [1, 3] {
            let step = format!("step: {:?}", 0.99 * limit(cells));
            let mut simulation = run.start(&scene(cells, &step));
            simulation.advance(10).unwrap();
            let start = simulation.energies().unwrap();
            simulation.advance(9_990).unwrap();
            let end = simulation.energies().unwrap();
            let total = |e: &sinew::components::Energies| e.kinetic + e.strain + e.hourglass;
            println!("{}, {cells}³: {:.3e} J, then {:.3e} J", run.name, total(&start), total(&end));
            assert!(total(&end) < 1.05 * total(&start), "{}: {start:?}, {end:?}", run.name);
            assert_eq!(simulation.time(), 10_000.0 * simulation.time_step());
        }
    }
}

/// The true limit of a block of many elements is above what the elements alone show; 1.02 of what was found (at least
/// 0.98 of the true one) may still run, more may not.
#[test]
fn up_to_the_true_limit_of_all_elements_a_block_runs_on_and_not_beyond() {
    for run in &configurations()[..2] {
        let summary = run.start(&scene(3, "")).summary("").unwrap();
        let found = summary.stability.limit.unwrap();
        assert!(found > 1.05 * summary.stability.bound.time_step, "{:?}", summary.stability);
        let step = format!("step: {:?}", 0.99 * found);
        let mut simulation = run.start(&scene(3, &step));
        simulation.advance(10).unwrap();
        let start = simulation.energies().unwrap();
        simulation.advance(20_000).unwrap();
        let end = simulation.energies().unwrap();
        let total = |e: &sinew::components::Energies| e.kinetic + e.strain + e.hourglass;
        assert!(total(&end) < 1.05 * total(&start), "{}: {start:?}, {end:?}", run.name);
        for factor in [1.05, 1.1, 2.0] {
            let step = format!("step: {:?}", factor * found);
            let refused = Simulation::new(&scene_of(&scene(3, &step), Path::new(".")), &run.options);
            assert!(matches!(refused, Err(Error::Scene(_))), "{factor}");
            let mut insisting = run.start(&scene(3, &format!("{step}, beyond_stable_step: true")));
            assert!(matches!(insisting.advance(20_000), Err(Error::Unstable(_))), "{factor}");
            assert!(insisting.step_history().unwrap().beyond_since.is_some());
        }
    }
}

#[test]
fn just_above_the_limit_a_free_cube_is_reported_and_no_result() {
    for run in cpu_and_long_gpu() {
        for factor in [1.01, 1.1, 2.0] {
            let step = format!("step: {:?}, beyond_stable_step: true", factor * limit(1));
            let mut simulation = run.start(&scene(1, &step));
            assert!(
                simulation.warnings().list().iter().any(|w| w.message.contains("beyond the stable one")),
                "{}",
                run.name
            );
            match simulation.advance(20_000) {
                Err(Error::Unstable(report)) => {
                    println!("{}, {factor}: {report}", run.name);
                    assert_eq!(report.body, "b");
                    assert!(report.good_until < report.time, "{report:?}");
                }
                other => panic!(
                    "{}, {factor}: {other:?} after {} steps, {:?}",
                    run.name,
                    simulation.step_count(),
                    simulation.energies()
                ),
            }
        }
    }
}

#[test]
fn too_large_a_step_is_refused() {
    for run in configurations() {
        let file = scene_of(&scene(1, &format!("step: {:?}", 1.01 * limit(1))), Path::new("."));
        match Simulation::new(&file, &run.options) {
            Err(Error::Scene(wrong)) => {
                let text = wrong.render(false);
                assert!(text.contains("beyond the stable one") && text.contains("beyond_stable_step"), "{text}");
            }
            other => panic!("{}: {:?}", run.name, other.map(|s| s.step_count())),
        }
    }
}
