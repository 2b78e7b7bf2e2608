//! Threads between bodies: tension, tearing, knots, momentum, energy, bits.

use crate::bits::{bits_do_not_depend, start};
use crate::configurations::{configurations, cpu_and_long_gpu, near};
use glam::DVec3;
use sinew::Simulation;
use sinew::components::{DisplacementIncrement, Precision};

/// Two cubes of 2 cm, 1 cm apart, and a stitch between the middles of the faces that look at each other.
pub fn cubes(low: &str, rest: &str, stitch: &str) -> String {
    let cube = |more: &str| format!("(mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3)), material: \"m\" {more})");
    format!(
        "(duration: 1, bodies: {{\"low\": {}, \"up\": {}}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3), {low})}}, {rest}
        attachments: [Suture(name: \"stitch\", from: (body: \"low\", at: (0.01, 0.01, 0.02)),
            to: (body: \"up\", at: (0.01, 0.01, 0.03)), {stitch})])",
        cube(""),
        cube(", translate: (0, 0, 0.03)"),
    )
}

/// Two cubes with a stitch, of which one is held and the other moves off by 20 mm within a second.
pub fn pulled_apart(stiffness: f64, strength: f64) -> String {
    cubes(
        "",
        "constraints: [Fixed(body: \"low\", on: All),
            Prescribed(body: \"up\", on: All, displacement: (0, 0, 0.02), curve: Ramp(end: 1))],
        output: (energies_every: 0.1),",
        &format!("stiffness: {stiffness}, strength: {strength}"),
    )
}

/// C27: a stitch that is pulled by a body that is moved tears at its strength, and what it stored is lost.
#[test]
fn a_suture_tears_at_its_strength_and_what_it_stored_is_booked() {
    let (strength, stiffness) = (0.4, 50.0);
    let text = pulled_apart(stiffness, strength);
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&text);
        near("before the first step", simulation.attachment("stitch").unwrap().length, 0.01, 0.01, 1e-6);
        let (mut most, mut last) = (0.0_f64, 0.0);
        while simulation.time() < 0.6 {
            simulation.advance(1).unwrap();
            let reading = simulation.attachment("stitch").unwrap();
            if reading.holds == 1 {
                assert!((reading.energy - reading.force.z.powi(2) / (2.0 * stiffness)).abs() < 1e-6, "{reading:?}");
                assert_eq!(reading.broke_at, None);
                last = reading.force.z;
            }
            most = most.max(reading.force.z);
        }
        let reading = simulation.attachment("stitch").unwrap();
        let what = format!("{}: {reading:?}", run.name);
        near(&what, most, strength, strength, 0.02);
        near(&what, last, most, strength, 1e-9);
        assert!(most < strength && reading.holds == 0 && reading.force == DVec3::ZERO, "{what}");
        near(&what, reading.broke_at.unwrap(), 0.4, 0.4, 0.02);
        let stored = strength * strength / (2.0 * stiffness);
        near(&what, reading.loss, stored, stored, 0.04);
        // who moves the cube has done that work, and nobody has it now
        let energies = simulation.energies().unwrap();
        near(&what, energies.constraint_work.unwrap() - energies.kinetic, stored, stored, 0.05);
        let elastic = energies.strain + energies.hourglass;
        assert!(elastic < 1e-6 * stored, "{what}: {elastic} J");
    }
}

/// Where some of the mass that it is in goes a thread is softer: it tears where what it bears is its strength, not
/// where it would be if all were there, and it stores what draws it.
#[test]
fn a_suture_in_what_is_left_of_its_tissue_tears_at_its_strength() {
    let (strength, stiffness, slack) = (0.4, 50.0, 0.01);
    let removal = "removal: [(body: \"low\", on: Box(min: (-1, 0.013, 0.013), max: (1, 1, 1)), when: At(0.1))],";
    let text = pulled_apart(stiffness, strength).replace("constraints:", &format!("{removal} constraints:"));
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&text);
        let mut last = simulation.attachment("stitch").unwrap();
        while simulation.time() < 0.95 && simulation.attachment("stitch").unwrap().holds == 1 {
            last = simulation.attachment("stitch").unwrap();
            let what = format!("{}: {last:?}", run.name);
            let stored = 0.5 * last.force.z * (last.length - slack);
            near(&what, last.energy, stored, strength * strength / stiffness, 1e-6);
            assert_eq!(last.loss, 0.0, "{what}");
            simulation.advance(1).unwrap();
        }
        let (reading, stretch) = (simulation.attachment("stitch").unwrap(), last.length - slack);
        let what = format!("{}: {reading:?} after {last:?}", run.name);
        assert!(reading.holds == 0 && reading.energy == 0.0, "{what}");
        near(&what, last.force.z, strength, strength, 0.02);
        // a third of the mass has gone
        near(&what, last.force.z, stiffness * stretch * 2.0 / 3.0, strength, 1e-3);
        near(&what, reading.loss, 0.5 * strength * stretch, 0.5 * strength * stretch, 0.02);
    }
}

/// Of two free cubes momentum stays, and energy goes to and fro between the thread, motion and strain.
#[test]
fn a_suture_draws_two_cubes_together_and_keeps_momentum_and_energy() {
    let text = cubes("", "output: (energies_every: 0.1),", "stiffness: 20, length: 0.008");
    for run in configurations() {
        let mut simulation = run.start(&text);
        let stored = 0.5 * 20.0 * 0.002_f64.powi(2);
        let (mut least, mut masses, mut before) = (f64::INFINITY, 0.0, None::<(f64, f64)>);
        while simulation.time() < 0.12 {
            simulation.advance(1).unwrap();
            let reading = simulation.attachment("stitch").unwrap();
            // what the bodies have is known in the middle of a step, how long the thread is at its ends
            if let Some((length, others)) = before {
                let pulled = f64::max(0.5 * (reading.length + length) - 0.008, 0.0);
                near(run.name, others + 0.5 * 20.0 * pulled * pulled, stored, stored, 0.03);
            }
            let energies = simulation.energies().unwrap();
            before = Some((reading.length, energies.kinetic + energies.strain + energies.hourglass));
            least = least.min(reading.energy);
        }
        assert!(least < 0.01 * stored, "{}: it has been slack", run.name);
        let rate = 1.0 / simulation.time_step();
        let mut momentum = DVec3::ZERO;
        for body in ["low", "up"] {
            let all = simulation.masses(body).unwrap();
            let view = simulation.column::<DisplacementIncrement>(body).unwrap();
            for (&row, mass) in view.node_rows().iter().zip(&all) {
                momentum += view.values().vector(row as usize) * rate * *mass;
                masses += mass;
            }
        }
        let speed = (2.0 * stored / masses).sqrt();
        near(run.name, momentum.length(), 0.0, masses * speed, run.bound(1e-12, 1e-5));
    }
}

#[test]
fn knots_shorten_a_suture_to_what_they_leave() {
    let text = cubes(
        "damping: 60",
        "constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0))],",
        "stiffness: 40, tighten: 0.008, curve: Smooth(end: 0.5)",
    );
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&text);
        simulation.advance_to(1.0).unwrap();
        let reading = simulation.attachment("0").err().map(|error| error.to_string());
        assert!(reading.unwrap().contains("there is stitch"), "it has a name");
        let reading = simulation.attachment("stitch").unwrap();
        near(&format!("{}: {reading:?}", run.name), reading.length, 0.002, 0.01, 1e-2);
        assert_eq!((reading.holds, reading.broke_at), (1, None));
    }
}

/// A thread that is a thousand times as stiff as the tissue makes the step smaller, and stays stable.
#[test]
#[ignore = "long"]
fn a_stiff_suture_counts_for_the_step() {
    let step = |stiffness: &str| {
        let text = cubes("", "", &format!("stiffness: {stiffness}, length: 0.0099"));
        start(&text, Precision::F64, 1)
    };
    let (soft, mut stiff) = (step("1"), step("1e5"));
    assert!(stiff.time_step() < 0.2 * soft.time_step(), "{} and {} s", stiff.time_step(), soft.time_step());
    // it goes slack and taut: energies in the middle of steps swing, but do not grow
    let mut most = |steps: u32| {
        let each = (0..steps).map(|_| {
            stiff.advance(1).unwrap();
            let energies = stiff.energies().unwrap();
            energies.kinetic + energies.strain
        });
        each.fold(0.0, f64::max)
    };
    let (early, late) = (most(3000), most(6000));
    assert!(late < 1.1 * early, "{late} J after {early} J");
}

/// At rest: a thread bears what hangs on it.
#[test]
fn a_cube_hangs_on_a_suture_at_rest() {
    let text = cubes(
        "",
        "analysis: Static(), loads: [Gravity(body: \"low\", acceleration: (0, 0, -9.81))],
        constraints: [Fixed(body: \"up\", on: Plane(normal: (0, 0, 1), at: 0.05)),
            Fixed(body: \"low\", on: Plane(normal: (1, 0, 0), at: 0), axes: [X, Y])],",
        "stiffness: 20",
    );
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&text);
        simulation.finish().unwrap();
        let weight = 1000.0 * 8e-6 * 9.81;
        let reading = simulation.attachment("stitch").unwrap();
        near(&format!("{}: {reading:?}", run.name), reading.force.z, weight, weight, 1e-3);
        near(run.name, reading.length, 0.01 + weight / 20.0, 0.01, 1e-3);
    }
}

/// The same bits on any number of threads, fused or not, and from any step on.
#[test]
fn bits_of_a_suture_do_not_depend_on_threads_or_pauses() {
    let cubes = cubes(
        "damping: 5",
        "loads: [Gravity(body: \"up\", acceleration: (1, 2, 9.81))],
        constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0))],",
        "stiffness: 40, strength: 0.12",
    );
    let text = cubes.replace("(3, 3, 3)", "(6, 6, 6)");
    let has_torn = |simulation: &mut Simulation| {
        let reading = simulation.attachment("stitch").unwrap();
        assert!(reading.broke_at.is_some(), "it has torn: {reading:?}");
    };
    bits_do_not_depend(&text, &["up"], [0.02, 0.15], [|_| {}, has_torn]);
}

/// Where the tissue that it is in goes, a thread comes out.
#[test]
fn a_suture_comes_out_with_its_tissue() {
    let text = cubes(
        "",
        "removal: [(body: \"low\", on: Sphere(center: (0.01, 0.01, 0.018), radius: 0.004), when: At(0.1))],
        constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0)),
            Fixed(body: \"up\", on: Plane(normal: (0, 0, 1), at: 0.05))],",
        "stiffness: 40, length: 0.009",
    );
    for run in configurations() {
        let mut simulation = run.start(&text);
        simulation.advance_to(0.09).unwrap();
        assert_eq!(simulation.attachment("stitch").unwrap().holds, 1, "{}", run.name);
        simulation.advance_to(0.11).unwrap();
        let reading = simulation.attachment("stitch").unwrap();
        assert!(reading.holds == 0 && reading.loss > 0.0, "{}: {reading:?}", run.name);
        near(run.name, reading.broke_at.unwrap(), 0.1, 0.1, 0.02);
    }
}
