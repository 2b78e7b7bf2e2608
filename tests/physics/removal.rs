//! Removal: when elements go, what is left, what is counted (H17, H18).
//!
//! Mass: what is gone is ρ V of the elements gone, to 1e-6. Energy: KE + IE + HG + removed − W below 1e-4 of W: work is
//! counted to (ωΔt)²/12 with Δt = 1e-3 s and ω < 30/s. An island falls with g: Σ m v grows by Σ m g Δt a step, to
//! rounding (1e-10, 1e-4 in f32).

use crate::columns::{external_forces, inertia, masses, velocities};
use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, near};
use crate::element_turns::with_elements;
use glam::DVec3;
use sinew::Simulation;

/// A bar of 6 cells (or 36 tetrahedra) of 1 m, step 1e-3 s.
fn bar(run: &Configuration, elements: &str, rest: &str) -> Simulation {
    run.start(&format!(
        "(duration: 0.2, bodies: {{\"b\": (mesh: Box(size: (6, 1, 1), cells: (6, 1, 1), elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        integration: (step: 1e-3), output: (energies_every: 0.1), {rest})"
    ))
}

/// Elements of a cell.
fn a_cell(elements: &str) -> usize {
    match &elements[..3] {
        "Tet" => 6,
        "Hex" => 1,
        _ => 2,
    }
}

fn alive(simulation: &mut Simulation) -> Vec<u8> {
    simulation.fields("b").unwrap().alive
}

#[test]
fn elements_go_at_their_time() {
    for run in &configurations() {
        let mut simulation = bar(run, "Hex8", "removal: [(on: Elements([1, 3]), when: At(0.05))]");
        simulation.advance(49).unwrap();
        assert_eq!(alive(&mut simulation), [1; 6], "{}", run.name);
        simulation.advance(1).unwrap();
        assert_eq!(alive(&mut simulation), [1, 0, 1, 0, 1, 1], "{}", run.name);
    }
}

/// Of elements that are all gone J is 1 and stress 0, as fields have it.
#[test]
fn what_is_gone_is_not_deformed() {
    for run in &configurations() {
        let probes = "removal: [(on: Elements([1, 3]), when: At(0.02))],
            probes: {\"j\": (what: VolumeRatio, on: Elements([1, 3])), \"s\": (what: Stress, on: Elements([1, 3])),
                \"both\": (what: VolumeRatio, on: Elements([0, 1]))}";
        let mut simulation = bar(run, "Hex8", probes);
        for steps in [20, 10] {
            simulation.advance(steps).unwrap();
            assert_eq!(simulation.probe("j").unwrap(), [1.0], "{}", run.name);
            assert_eq!(simulation.probe("s").unwrap(), [0.0; 6], "{}", run.name);
            near(run.name, simulation.probe("both").unwrap()[0], 1.0, 1.0, 1e-6);
        }
    }
}

#[test]
fn elements_go_one_after_the_other_from_the_middle_outwards() {
    for run in &configurations() {
        let mut simulation =
            bar(run, "Hex8", "removal: [(on: Elements([0, 1, 2, 3, 4]), when: During(start: 0.02, end: 0.06))]");
        let expected = [
            (19, [1, 1, 1, 1, 1, 1]),
            (20, [1, 1, 0, 1, 1, 1]),
            (30, [1, 0, 0, 1, 1, 1]),
            (40, [1, 0, 0, 0, 1, 1]),
            (50, [0, 0, 0, 0, 1, 1]),
            (60, [0, 0, 0, 0, 0, 1]),
        ];
        for (step, expected) in expected {
            simulation.advance(step - simulation.step_count()).unwrap();
            assert_eq!(alive(&mut simulation), expected, "{}, step {step}", run.name);
        }
    }
}

/// Told gradients make every element the same; each limit is a little below or above what they amount to.
#[test]
#[ignore = "long"]
fn criteria_take_what_passes_them_and_nothing_else() {
    // λ = 1.3, across .9: J = 1.053, Ψ = μ/2 (J^(−2/3) (1.69 + 1.62) − 3) + κ/2 .053²
    let (ratio, shear) = (1.3 * 0.81_f64, 3000.0 / 2.9);
    let energy = 0.5 * shear * (ratio.powf(-2.0 / 3.0) * (1.69 + 1.62) - 3.0) + 0.5e4 * (ratio - 1.0) * (ratio - 1.0);
    let stretched = "((0.3, 0, 0), (0, -0.1, 0), (0, 0, -0.1))";
    let squeezed = "((-0.3, 0, 0), (0, 0, 0), (0, 0, 0))";
    let cases = [
        (stretched, format!("StretchAbove({})", 1.3 - 1e-4), true),
        (stretched, format!("StretchAbove({})", 1.3 + 1e-4), false),
        (stretched, format!("VolumeRatioAbove({})", ratio - 1e-4), true),
        (stretched, format!("VolumeRatioAbove({})", ratio + 1e-4), false),
        (squeezed, "VolumeRatioBelow(0.7001)".into(), true),
        (squeezed, "VolumeRatioBelow(0.6999)".into(), false),
        (stretched, format!("EnergyDensityAbove({})", energy * 0.999), true),
        (stretched, format!("EnergyDensityAbove({})", energy * 1.001), false),
    ];
    for (run, elements) in with_elements(&configurations(), 1) {
        for (gradient, when, goes) in &cases {
            let rest = format!("constraints: [Prescribed(on: All, gradient: {gradient})], removal: [(when: {when})]");
            let mut simulation = bar(run, elements, &rest);
            // they are checked in every tenth step
            simulation.advance(20).unwrap();
            let left = alive(&mut simulation).contains(&1);
            assert_eq!(left, !goes, "{}, {elements}, {when}", run.name);
            let selected = bar(run, elements, &rest.replace("(when:", "(on: Elements([0]), when:"));
            let (mut selected, all) = (selected, 6 * a_cell(elements));
            selected.advance(20).unwrap();
            let gone = alive(&mut selected).iter().filter(|&&alive| alive == 0).count();
            assert_eq!(gone, usize::from(*goes), "{}, {elements}, {when}: only one of {all} may go", run.name);
        }
    }
}

#[test]
#[ignore = "long"]
fn island_falls_with_exactly_g_and_mass_is_booked() {
    for (run, elements) in with_elements(&configurations(), 2) {
        let rest =
            "constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))], loads: [Gravity(acceleration: (0, 0, -9.81))],
            removal: [(on: Box(min: (2, 0, 0), max: (4, 1, 1)), when: At(0.05))]";
        let mut simulation = bar(run, elements, rest);
        let island: Vec<usize> = simulation
            .rest_positions("b")
            .unwrap()
            .iter()
            .enumerate()
            .filter(|(_, x)| x.x > 3.9)
            .map(|(i, _)| i)
            .collect();
        let momentum = |simulation: &mut Simulation| -> (f64, f64) {
            let (m, v) = (masses(simulation, "b"), velocities(simulation, "b"));
            (island.iter().map(|&i| m[i] * v[i].z).sum(), island.iter().map(|&i| m[i]).sum())
        };
        simulation.advance(60).unwrap();
        let (before, mass) = momentum(&mut simulation);
        simulation.advance(100).unwrap();
        let (after, _) = momentum(&mut simulation);
        let what = format!("{}, {elements}", run.name);
        near(&format!("{what}: mass of the island"), mass, 2000.0, 2000.0, run.bound(1e-12, 1e-6));
        near(&format!("{what}: g"), (after - before) / (mass * 0.1), -9.81, 9.81, run.bound(1e-10, 1e-4));
        let summary = simulation.summary("").unwrap();
        near(&format!("{what}: mass removed"), summary.removed_mass, 2000.0, 2000.0, 1e-6);
        assert_eq!(summary.removed_elements, 2 * a_cell(elements));
    }
}

/// Where mass is scaled, what resists acceleration goes with its elements, whose mass and what was added to it, and not
/// with the next check of the stable step.
#[test]
fn scaled_mass_goes_with_its_elements() {
    for run in cpu_and_long_gpu() {
        for (gone, cut) in [("min: (0.02, 0, 0), max: (0.04", 0.02), ("min: (0, 0, 0), max: (0.01", 0.01)] {
            let mut simulation = run.start(&format!(
                "(duration: 0.01, integration: (step: 3e-5, when_unstable: ScaleMass(most: 0.1)),
                bodies: {{\"b\": (mesh: Box(size: (0.04, 0.01, 0.01), cells: (4, 1, 1), elements: Hex8),
                    material: \"soft\", regions: [(on: Box(min: (0, 0, 0), max: (0.01, 0.01, 0.01)), material: \"stiff\")])}},
                materials: {{\"soft\": (density: 1000, neo_hookean: Young(young: 5e3, poisson: 0.3)),
                    \"stiff\": (density: 1000, neo_hookean: Young(young: 4e7, poisson: 0.3))}},
                loads: [Gravity(acceleration: (0, 0, -10))],
                removal: [(on: Box({gone}, 0.01, 0.01)), when: At(3e-3))])"
            ));
            let added = |simulation: &mut Simulation| -> Vec<f64> {
                let (mass, inertia) = (masses(simulation, "b"), inertia(simulation, "b"));
                mass.iter().zip(&inertia).map(|(mass, inertia)| inertia - mass).collect()
            };
            let rest = simulation.rest_positions("b").unwrap();
            let before = added(&mut simulation);
            simulation.advance(100).unwrap();
            let (after, masses) = (added(&mut simulation), masses(&mut simulation, "b"));
            for (node, place) in rest.iter().enumerate() {
                let what = format!("{}, cut at {cut} m, node {node}", run.name);
                let stays = if cut > 0.015 && place.x < 0.015 { before[node] } else { 0.0 };
                // a quarter of an element's gram
                near(&what, after[node], stays, 2.5e-4, run.bound(1e-12, 1e-6));
                let gone = if cut > 0.015 { place.x > 0.025 } else { place.x < 0.005 };
                assert_eq!(masses[node] == 0.0, gone, "{what}");
            }
            assert!(before.iter().any(|added| *added > 1e-6), "{}: nothing was added", run.name);
        }
    }
}

/// Kinetic energy is of all that resists acceleration, and so is what of it goes with elements; the momentum that goes
/// is of what they weigh. A cube moves without a strain, and a third of it goes, at the end of the sixteenth step.
#[test]
fn energy_of_scaled_mass_goes_with_its_elements() {
    let moved = "constraints: [Prescribed(on: All, displacement: (0, 0, 0.02), curve: Ramp(end: 0.02))]";
    for run in cpu_and_long_gpu() {
        for by in ["loads: [Gravity(acceleration: (0, 0, 10))]", moved] {
            let mut simulation = run.start(&format!(
                "(duration: 0.02, integration: (step: 6.5e-4, when_unstable: ScaleMass(most: 1)), {by},
                bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3), elements: Hex8), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))}},
                removal: [(on: Box(min: (0, 0, 0), max: (0.01, 0.01, 0.004)), when: At(0.01))],
                output: (energies_every: 0.005))"
            ));
            simulation.advance(16).unwrap();
            let (what, bound) = (format!("{}, {by}", run.name), run.bound(1e-9, 1e-5));
            let e = simulation.energies().unwrap();
            let work = e.load_work.unwrap() + e.constraint_work.unwrap();
            near(&format!("{what}: all"), e.kinetic + e.strain + e.hourglass + e.removed, work, work, bound);
            near(&format!("{what}: removed"), e.removed, work / 3.0, work, bound);
            let speed = velocities(&mut simulation, "b").iter().map(|v| v.z).fold(0.0, f64::max);
            let summary = simulation.summary("").unwrap();
            let momentum = summary.removed_mass * speed;
            near(&format!("{what}: momentum"), summary.removed_momentum.z, momentum, momentum, bound);
            assert_eq!(summary.removed_elements, 9, "{what}");
        }
    }
}

#[test]
fn nodes_without_elements_are_inactive() {
    for (run, elements) in with_elements(&cpu_and_long_gpu(), 0) {
        let rest = "loads: [Gravity(acceleration: (0, 0, -9.81)), NodalForce(on: All, force: (1, 0, 0))],
            removal: [(on: Box(min: (4, 0, 0), max: (6, 1, 1)), when: At(0.05))]";
        let mut simulation = bar(run, elements, rest);
        simulation.advance(51).unwrap();
        let inactive: Vec<usize> = simulation
            .rest_positions("b")
            .unwrap()
            .iter()
            .enumerate()
            .filter(|(_, x)| x.x > 4.9)
            .map(|(i, _)| i)
            .collect();
        let before = simulation.displacements("b").unwrap();
        simulation.advance(100).unwrap();
        let after = simulation.displacements("b").unwrap();
        for &node in &inactive {
            assert_eq!(before[node], after[node], "{}, {elements}: node {node} is not inactive", run.name);
            assert_eq!(masses(&mut simulation, "b")[node], 0.0);
        }
        assert!(after.iter().all(|u| u.is_finite()));
    }
}

#[test]
#[ignore = "long"]
fn faces_of_removed_elements_bear_no_load() {
    for (run, elements) in with_elements(&configurations(), 1) {
        for load in [
            "Traction(on: Plane(normal: (0, 0, 1), at: 1), traction: (0, 0, -10))",
            "Pressure(on: Plane(normal: (0, 0, 1), at: 1), pressure: 10)",
        ] {
            let rest = format!(
                "constraints: [Prescribed(on: All)], loads: [{load}], removal: [(on: Box(min: (4, 0, 0), max: (6, 1, 1)), when: At(0.05))]"
            );
            let mut simulation = bar(run, elements, &rest);
            let mut net = |steps: u64| {
                simulation.advance(steps).unwrap();
                external_forces(&mut simulation, "b").iter().sum::<DVec3>().z
            };
            let (before, after) = (net(50), net(2));
            near(&format!("{}, {elements}: before", run.name), before, -60.0, 60.0, run.bound(1e-12, 1e-6));
            near(&format!("{}, {elements}: after", run.name), after, -40.0, 60.0, run.bound(1e-12, 1e-6));
        }
    }
}

/// Only one of two materials may lose elements: the elements of the other weigh what they weighed and bear what they
/// bore.
#[test]
fn elements_of_another_material_stay_as_they_are() {
    for run in &configurations() {
        for load in [
            "Traction(on: Plane(normal: (0, 0, 1), at: 1), traction: (0, 0, -10))",
            "Pressure(on: Plane(normal: (0, 0, 1), at: 1), pressure: 10)",
        ] {
            // the first cell is squeezed to nothing, all others stay as they are
            let mut simulation = run.start(&format!(
                "(duration: 0.2, bodies: {{\"b\": (mesh: Box(size: (6, 1, 1), cells: (6, 1, 1), elements: Hex8), material: \"m\",
                    regions: [(on: Box(min: (0, 0, 0), max: (2, 1, 1)), material: \"soft\")])}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45)),
                    \"soft\": (density: 1000, linear: Young(young: 3e3, poisson: 0.45), inversion: Remove)}},
                constraints: [Prescribed(on: Plane(normal: (1, 0, 0), at: 0), displacement: (0.99, 0, 0),
                        curve: Ramp(end: 0.05)), Prescribed(on: Not(Plane(normal: (1, 0, 0), at: 0)))],
                loads: [{load}], integration: (step: 1e-3))"
            ));
            simulation.advance(40).unwrap();
            let before = masses(&mut simulation, "b");
            near(&format!("{}: mass before", run.name), before.iter().sum(), 6000.0, 6000.0, run.bound(1e-12, 1e-6));
            simulation.advance(20).unwrap();
            assert_eq!(simulation.summary("finished").unwrap().removed_elements, 1, "{}", run.name);
            let after = masses(&mut simulation, "b");
            near(&format!("{}: mass after", run.name), after.iter().sum(), 5000.0, 6000.0, run.bound(1e-12, 1e-6));
            let net = external_forces(&mut simulation, "b").iter().sum::<DVec3>().z;
            near(&format!("{}: load after", run.name), net, -50.0, 60.0, run.bound(1e-12, 1e-6));
        }
    }
}

/// Runs a bar from which elements go: what is held at the end, what went with them and what was done on it must
/// balance, to `allowed` of the larger work, or where nodal means are taken to the second of it. Removed energy must be
/// that share of the work at least.
///
/// Around the hole nodal means are taken anew, of fewer elements: the energy of those that stay jumps by what their
/// volumes differed by, and nobody counts that. No smaller step changes it.
fn balances(rest: &str, steps: u64, removed: f64, allowed: [f64; 2]) {
    for (run, elements) in with_elements(&configurations(), 2) {
        let mut simulation = bar(run, elements, rest);
        // of 1 ms, but for elements that need shorter ones on the way
        simulation.advance_to(1e-3 * steps as f64).unwrap();
        let e = simulation.energies().unwrap();
        println!("{e:?}");
        let work = [e.load_work.unwrap(), e.constraint_work.unwrap()];
        let most = work[0].max(work[1]);
        assert!(e.removed > removed * most, "{e:?}");
        let sum = e.kinetic + e.strain + e.hourglass + e.removed - work[0] - work[1];
        let allowed = allowed[usize::from(elements == "Tet4NodalPressure")];
        near(&format!("{}, {elements}", run.name), sum, 0.0, most, allowed);
    }
}

#[test]
fn energy_that_goes_with_elements_is_counted() {
    // clamped at both ends: what is left swings on and does not fall
    let rest = "constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0)), Fixed(on: Plane(normal: (1, 0, 0), at: 6))],
        loads: [Gravity(acceleration: (3, 0, -2))], removal: [(on: Box(min: (2, 0, 0), max: (4, 1, 0.7)), when: At(0.8))]";
    balances(rest, 1200, 0.05, [1e-4, 5e-3]);
}

/// Mass that goes from nodes that are moved takes with it what constraints gave it; that they gave it stays counted.
#[test]
fn work_on_mass_that_is_gone_stays_booked() {
    // in the middle of the motion its end goes, or most of it: 500 kg at 1.4 m/s, where the bar holds 30 J
    let rest = "constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0)),
            Prescribed(on: Plane(normal: (1, 0, 0), at: 6), displacement: (0.6, 0, 0), curve: Smooth(end: 0.8))],
        removal: [(on: Box(min: (5, 0, 0), max: (6, 1, 0.7)), when: At(0.4))]";
    // the work of a step is that of the mean of the forces at its ends: where a force goes that does 1.4 kW, half of it
    // over a step of 1 ms is not there, 0.7 J of 590 to 920 J (and half of that with half the step); nodal means jump
    // by 21 J of 829 J
    balances(rest, 500, 0.2, [1.2e-3, 3e-2]);
}

#[test]
fn a_body_of_which_everything_is_removed_is_no_crash() {
    for (run, elements) in with_elements(&cpu_and_long_gpu(), 0) {
        let rest = "loads: [Gravity(acceleration: (0, 0, -9.81)), Pressure(on: Surface(), pressure: 3)], removal: [(when: At(0.05))],
            probes: {\"stress\": (what: Stress, on: All), \"u\": (what: Displacement, on: All)}";
        let mut simulation = bar(run, elements, rest);
        simulation.advance(200).unwrap();
        let summary = simulation.summary("finished").unwrap();
        near("mass removed", summary.removed_mass, 6000.0, 6000.0, 1e-6);
        assert!(simulation.probe("stress").unwrap().iter().all(|x| *x == 0.0));
        assert!(simulation.probe("u").unwrap().iter().all(|x| x.is_finite()));
        assert_eq!((summary.energies.strain, summary.energies.kinetic), (0.0, 0.0));
    }
}
