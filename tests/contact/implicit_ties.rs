//! Threads, glue and grasps in implicit steps: springs inside the forces, and motion that is told.

use crate::bits::{bits_do_not_depend, start};
use crate::configurations::near;
use crate::glue::bars;
use crate::grasp::LIFTED;
use crate::sutures::{cubes, pulled_apart};
use glam::DVec3;
use sinew::Simulation;
use sinew::components::Precision;

/// A scene by implicit steps, its tools with springs.
fn solved(text: &str, step: &str) -> String {
    text.replace("(duration:", &format!("(solver: Implicit(step: {step}, tolerance: 1e-4), duration:"))
        .replace("Tool(tool: \"table\")", "Tool(tool: \"table\", law: Penalty(share: 1))")
}

/// Of an implicit step force, length and direction are those of its end: the thread that a cube swings on pulls at what
/// it hangs on as that is held.
#[test]
fn a_suture_pulls_along_itself_at_the_end_of_the_step() {
    let text = "(duration: 0.1, solver: Implicit(step: 5e-3), bodies: {
            \"a\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (1, 1, 1), elements: Hex8), material: \"m\"),
            \"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (1, 1, 1), elements: Hex8), translate: (0.02, 0, 0),
                material: \"m\", velocity: (0, 0, 0.3))},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 1e5, poisson: 0.3))},
        constraints: [Fixed(body: \"a\", on: All)],
        attachments: [Suture(name: \"s\", from: (body: \"a\", at: (0.01, 0.005, 0.005)),
            to: (body: \"b\", at: (0.02, 0.005, 0.005)), stiffness: 10, tighten: 1e-3)],
        probes: {\"r\": (body: \"a\", what: Reaction, on: All)})";
    let mut simulation = start(text, Precision::F64, 1);
    for time in [0.02, 0.04, 0.1] {
        simulation.advance_to(time).unwrap();
        let force = simulation.attachment("s").unwrap().force;
        let held = DVec3::from_slice(&simulation.probe("r").unwrap());
        near(&format!("{time} s"), (force + held).length(), 0.0, 1e-3, 1e-9);
        assert!(force.length() > 1e-3, "{time} s: {force}");
    }
}

/// As explicit steps do it (`sutures`): strength, what it stored, and nothing that is left.
#[test]
fn a_suture_tears_at_its_strength() {
    let (strength, stiffness) = (0.4, 50.0);
    let text = pulled_apart(stiffness, strength);
    let mut simulation = start(&solved(&text, "0.004"), Precision::F64, 1);
    let mut most = 0.0_f64;
    while simulation.time() < 0.599 {
        simulation.advance(1).unwrap();
        let reading = simulation.attachment("stitch").unwrap();
        most = most.max(reading.force.z);
    }
    let reading = simulation.attachment("stitch").unwrap();
    near("most", most, strength, strength, 0.02);
    assert!(most < strength && reading.holds == 0 && reading.force == DVec3::ZERO, "{reading:?}");
    near("time", reading.broke_at.unwrap(), 0.4, 0.4, 0.02);
    let stored = strength * strength / (2.0 * stiffness);
    near("loss", reading.loss, stored, stored, 0.04);
    let energies = simulation.energies().unwrap();
    near("work", energies.constraint_work.unwrap() - energies.kinetic, stored, stored, 0.05);
    // its force grows by the way: the mean of both ends of each step is what it stores
    near("its own work", energies.load_work.unwrap(), -reading.loss, stored, 1e-6);
}

/// Of a thread whose tissue goes length, energy and time are those at the end of the step before: in the next one
/// nothing draws it, and what it was in springs back by .4 mm.
#[test]
fn a_suture_comes_out_as_it_was_drawn_last() {
    let text = cubes(
        "",
        "removal: [(body: \"low\", on: Sphere(center: (0.01, 0.01, 0.018), radius: 0.004), when: At(0.1))],
        constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0)),
            Fixed(body: \"up\", on: Plane(normal: (0, 0, 1), at: 0.05))],",
        "stiffness: 40, length: 0.008",
    );
    let mut simulation = start(&solved(&text, "0.005"), Precision::F64, 1);
    let (mut last, mut time) = (simulation.attachment("stitch").unwrap(), 0.0);
    while simulation.time() < 0.15 && simulation.attachment("stitch").unwrap().holds == 1 {
        (last, time) = (simulation.attachment("stitch").unwrap(), simulation.time());
        simulation.advance(1).unwrap();
    }
    simulation.advance(3).unwrap();
    let reading = simulation.attachment("stitch").unwrap();
    assert!(reading.holds == 0 && last.energy > 1e-5, "{reading:?} after {last:?}");
    assert_eq!((reading.length, reading.loss, reading.energy), (last.length, last.energy, 0.0), "{last:?}");
    near("time", reading.broke_at.unwrap(), time, 1.0, 1e-12);
    near("time of removal", time, 0.1, 0.1, 0.06);
}

/// A cube that swings on a thread through its middle, which tears as it draws with half more than its weight: from then
/// on it falls by g in each step. With the force of the thread at its beginning the first step changed the velocity by
/// .26 g Δt, with the accelerations that this had made by .87 g Δt.
#[test]
fn what_hung_from_a_thread_falls_from_when_that_tears() {
    let cube = |more: &str| {
        let mesh = "Box(size: (0.01, 0.01, 0.01), cells: (1, 1, 1), elements: Hex8)";
        format!("(mesh: {mesh}, material: \"m\" {more})")
    };
    let mut simulation = start(
        &format!(
            "(duration: 0.05, solver: Implicit(step: 1e-3, scheme: GeneralizedAlpha(), tolerance: 1e-10),
            bodies: {{\"a\": {}, \"b\": {}}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e5, poisson: 0.3))}},
            constraints: [Fixed(body: \"a\", on: All)], loads: [Gravity(body: \"b\", acceleration: (0, 0, -9.81))],
            attachments: [Suture(name: \"s\", from: (body: \"b\", at: (0.005, 0.005, -0.015)),
                to: (body: \"a\", at: (0.005, 0.005, 0)), stiffness: 10, strength: 0.0145)],
            probes: {{\"v\": (body: \"b\", on: All, what: Velocity)}})",
            cube(""),
            cube(", translate: (0, 0, -0.02)"),
        ),
        Precision::F64,
        1,
    );
    while simulation.time() < 0.04 && simulation.attachment("s").unwrap().holds == 1 {
        simulation.advance(1).unwrap();
    }
    near("time", simulation.attachment("s").unwrap().broke_at.unwrap(), 0.021, 0.021, 1e-9);
    let mut before = simulation.probe("v").unwrap()[2];
    for step in 1..6 {
        simulation.advance(1).unwrap();
        let now = simulation.probe("v").unwrap()[2];
        near(&format!("step {step}"), now - before, -9.81e-3, 9.81e-3, 1e-6);
        before = now;
    }
}

/// A cube that hangs from a thread of fixed ends is at m g/k below where it is slack: the thread is inside the forces
/// of each step, which is far longer than what is stable with it.
#[test]
fn a_cube_hangs_from_a_stiff_thread() {
    let stiffness = 2000.0;
    let text = cubes(
        "damping: 20",
        "constraints: [Fixed(body: \"up\", on: All)], loads: [Gravity(body: \"low\", acceleration: (0, 0, -9.81), curve: Smooth(end: 0.2))],",
        &format!("stiffness: {stiffness}"),
    );
    let mut simulation = start(&solved(&text, "0.01"), Precision::F64, 1);
    simulation.advance_to(1.0).unwrap();
    let (reading, weight) = (simulation.attachment("stitch").unwrap(), 8e-3 * 9.81);
    near("force", reading.force.z, weight, weight, 2e-3);
    near("length", reading.length - 0.01, weight / stiffness, weight / stiffness, 2e-3);
}

/// The pull (Pa, of the area at rest) of a bar with E = 3 kPa and ν = 0 that is drawn out to λ = 1.2 and free at its
/// sides: J = 1 + σ/(3κ), λ² − t² = 3κ (J − 1) J^(5/3)/μ of a side stretch t, J = λ t², P = σ t².
fn drawn_by_a_fifth() -> f64 {
    let (shear, bulk, stretch) = (1.5e3, 1e3, 1.2_f64);
    let pressed = |squared: f64| {
        let volume = stretch * squared;
        3.0 * bulk * (volume - 1.0) * volume.powf(5.0 / 3.0) / shear - (stretch * stretch - squared)
    };
    let (mut low, mut high) = (0.5, 1.5);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if pressed(middle) < 0.0 { low = middle } else { high = middle }
    }
    3.0 * bulk * (stretch * low - 1.0) * low
}

/// Bars of the same mesh that are glued pull as one, and come off at their strength times their area.
#[test]
fn glue_holds_and_breaks() {
    let mut simulation = start(&solved(&bars(["(3, 3, 6)"; 2], ""), "0.01"), Precision::F64, 1);
    simulation.advance_to(1.0).unwrap();
    let reading = simulation.attachment("glue").unwrap();
    assert!(reading.broken.is_empty(), "{reading:?}");
    near("as one", reading.force.z, drawn_by_a_fifth() * 1e-4, drawn_by_a_fifth() * 1e-4, 0.03);
    let mut simulation =
        start(&solved(&bars(["(3, 3, 6)"; 2], ", normal: 200, shear: 400"), "0.01"), Precision::F64, 1);
    let mut most = 0.0_f64;
    while simulation.time() < 0.9 && simulation.attachment("glue").unwrap().holds > 0 {
        simulation.advance(1).unwrap();
        most = most.max(simulation.attachment("glue").unwrap().force.z);
    }
    let reading = simulation.attachment("glue").unwrap();
    // before it breaks within a step of its growth, .65 mN at most
    near("strength", most, 200.0 * 1e-4, 200.0 * 1e-4, 0.04);
    assert!(reading.holds == 0 && reading.broken.len() == 16, "{reading:?}");
    // there are no loads: the force that broke does no work on what flies apart, which was half of all there is
    simulation.advance(1).unwrap();
    let energies = simulation.energies().unwrap();
    let (load_work, given) = (energies.load_work.unwrap(), energies.constraint_work.unwrap());
    near("work of glue", load_work, -reading.loss, given, 0.01);
}

#[test]
fn a_cube_is_grasped_lifted_carried_and_let_go() {
    for precision in [Precision::F64, Precision::F32] {
        let mut simulation = start(&solved(LIFTED, "0.01"), precision, 1);
        let weight = 1000.0 * 8e-6 * 9.81;
        simulation.advance_to(0.88).unwrap();
        let reading = simulation.tool("forceps").unwrap();
        assert_eq!((reading.nodes, reading.work.unwrap()), (0, 0.0), "it is open: {reading:?}");
        near("table", -simulation.tool("table").unwrap().force.z, weight, weight, 2e-3);
        simulation.advance_to(0.95).unwrap();
        let reading = simulation.tool("forceps").unwrap();
        assert_eq!(reading.nodes, 16, "it closes: {reading:?}");
        // it lies there: nothing that the forceps have to do
        near("at closing", reading.force.length(), 0.0, weight, 5e-3);
        simulation.advance_to(2.65).unwrap();
        let reading = simulation.tool("forceps").unwrap();
        let what = format!("{precision:?}: {reading:?}");
        near(&what, -reading.force.z, weight, weight, 1e-3);
        near(&what, reading.force.truncate().length(), 0.0, weight, 1e-3);
        near(&what, reading.torque.length(), 0.0, 0.01 * weight, 5e-3);
        assert_eq!(simulation.tool("table").unwrap().nodes, 0, "{what}");
        let (lifted, rest) = (simulation.displacements("b").unwrap(), simulation.rest_positions("b").unwrap().to_vec());
        for (u, _) in lifted.iter().zip(&rest).filter(|(_, x)| x.z > 0.02 - 1e-9) {
            near(&what, u.x, 0.02, 0.02, 1e-3);
            assert!(u.z > 0.029 && u.z < 0.03, "{what}: {u}");
        }
        // lifted by 3 cm, against damping of 20 1/s at 7.5 and 10 cm/s
        let lift = weight * 0.03 + 20.0 * 8e-3 * (0.075 * 0.03 + 0.1 * 0.02);
        near(&format!("{what}: work"), reading.work.unwrap(), lift, lift, 0.03);
        simulation.advance_to(2.85).unwrap();
        let reading = simulation.tool("forceps").unwrap();
        assert_eq!((reading.nodes, reading.force), (0, DVec3::ZERO), "{what}");
        let after = simulation.displacements("b").unwrap();
        assert!(after[0].z < lifted[0].z - 5e-3, "it falls: {}", after[0]);
    }
}

#[test]
fn bits_of_attachments_do_not_depend_on_threads_and_pauses() {
    let none: fn(&mut Simulation) = |_| {};
    bits_do_not_depend(&solved(LIFTED, "0.02"), &["b"], [1.02, 1.3], [none, none]);
    let glued = bars(["(3, 3, 6)"; 2], ", normal: 200, shear: 400");
    bits_do_not_depend(&solved(&glued, "0.02"), &["low", "up"], [0.3, 0.7], [none, none]);
}
