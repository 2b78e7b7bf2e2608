//! Ties and glue: how well they hold, where they break, peeling, momentum, bits.

use crate::bits::{bits_do_not_depend, start};
use crate::configurations::{configurations, cpu_and_long_gpu, near};
use glam::DVec3;
use sinew::Simulation;
use sinew::components::{DisplacementIncrement, Precision};
use sinew::systems::Registry;

/// Two bars of 1 × 1 × 2 cm end to end, of which the upper one is drawn up by 4 mm in a second, slowly at first.
pub fn bars(cells: [&str; 2], glue: &str) -> String {
    let bar = |cells: &str, more: &str| {
        format!("(mesh: Box(size: (0.01, 0.01, 0.02), cells: {cells}), material: \"m\" {more})")
    };
    format!(
        "(duration: 1, bodies: {{\"low\": {}, \"up\": {}}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0), damping: 60)}},
        constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0)),
            Prescribed(body: \"up\", on: Plane(normal: (0, 0, 1), at: 0.04), displacement: (0, 0, 0.008), curve: Smooth(end: 1))],
        attachments: [Glue(name: \"glue\", bodies: (\"low\", \"up\") {glue})], output: (energies_every: 0.1))",
        bar(cells[0], ""),
        bar(cells[1], ", translate: (0, 0, 0.02)"),
    )
}

/// C27: on meshes that match the stress is that of the bars everywhere.
#[test]
fn glue_breaks_at_its_strength() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&bars(["(3, 3, 6)"; 2], ", normal: 200, shear: 400"));
        let mut most = 0.0_f64;
        while simulation.time() < 0.9 && simulation.attachment("glue").unwrap().holds > 0 {
            simulation.advance(1).unwrap();
            most = most.max(simulation.attachment("glue").unwrap().force.z);
        }
        let reading = simulation.attachment("glue").unwrap();
        let what = format!("{}: {reading:?}", run.name);
        near(&what, most, 200.0 * 1e-4, 200.0 * 1e-4, 0.02);
        assert!(reading.holds == 0 && reading.broken.len() == 16, "{what}");
        // numbers of the author: the upper end of the lower bar
        let numbers: Vec<u64> = (6 * 16..7 * 16).collect();
        let mut broken = reading.broken;
        broken.sort_unstable();
        assert_eq!(broken, numbers, "{what}");
    }
}

/// On meshes that do not match, the finer one first, what is glued stays together, the bars as stiff as one.
#[test]
fn what_is_glued_is_one_body() {
    for run in cpu_and_long_gpu() {
        for cells in [["(3, 3, 6)", "(2, 2, 4)"], ["(4, 4, 8)", "(2, 2, 4)"]] {
            let mut simulation = run.start(&bars(cells, ""));
            simulation.advance_to(1.0).unwrap();
            let reading = simulation.attachment("glue").unwrap();
            let what = format!("{} {cells:?}: {reading:?}", run.name);
            // neo-Hookean, ν = 0, drawn out by a fifth: P = μ (λ − 1/λ^...) is that of the other half, whatever it is
            let of_one = {
                let mut one = run.start(
                    "(duration: 1, bodies: {\"b\": (mesh: Box(size: (0.01, 0.01, 0.04), cells: (3, 3, 12)), material: \"m\")},
                    materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0), damping: 60)},
                    constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
                        Prescribed(on: Plane(normal: (0, 0, 1), at: 0.04), displacement: (0, 0, 0.008), curve: Smooth(end: 1))],
                    probes: {\"pull\": (what: Reaction, on: Plane(normal: (0, 0, 1), at: 0.04))})",
                );
                one.advance_to(1.0).unwrap();
                one.probe("pull").unwrap()[2]
            };
            near(&what, reading.force.z, of_one, of_one, 0.02);
            let (low, up) = (ends(&mut simulation, "low", 0.02), ends(&mut simulation, "up", 0.02));
            near(&what, mean(&low).distance(mean(&up)), 0.0, 0.01, 1e-3);
            assert!(reading.broken.is_empty(), "{what}");
        }
    }
}

fn mean(all: &[DVec3]) -> DVec3 {
    all.iter().sum::<DVec3>() / all.len() as f64
}

/// Displacements of the nodes of a body at a height.
fn ends(simulation: &mut Simulation, body: &str, z: f64) -> Vec<DVec3> {
    let u = simulation.displacements(body).unwrap();
    let rest = simulation.rest_positions(body).unwrap();
    rest.iter().zip(u).filter(|(x, _)| (x.z - z).abs() < 1e-9).map(|(_, u)| u).collect()
}

/// A strip that is drawn off from one end comes off node by node, from that end: with a fifth of the step, as with any
/// shorter one. With all of it what snaps back rings, and tears nodes in the middle, too (docs/contact.md).
#[test]
fn glue_is_peeled_from_the_end_that_is_pulled() {
    let text = "(duration: 1, bodies: {
            \"strip\": (mesh: Box(size: (0.04, 0.005, 0.002), cells: (20, 2, 2), elements: Hex8MeanDilatation), material: \"m\",
                translate: (0, 0, 0.005)),
            \"bed\": (mesh: Box(size: (0.04, 0.005, 0.005), cells: (20, 2, 2)), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0), damping: 60)},
        constraints: [Fixed(body: \"bed\", on: Plane(normal: (0, 0, 1), at: 0)),
            Prescribed(body: \"strip\", on: Plane(normal: (1, 0, 0), at: 0), displacement: (0, 0, 0.012), curve: Smooth(end: 1))],
        attachments: [Glue(bodies: (\"strip\", \"bed\"), normal: 400, shear: 4000)],
        integration: (safety: 0.2), output: (energies_every: 0.1))";
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(text);
        let rest = simulation.rest_positions("strip").unwrap();
        let mut before = 0;
        for part in 1..=10 {
            simulation.advance_to(0.1 * f64::from(part)).unwrap();
            let reading = simulation.attachment("0").unwrap();
            let off: Vec<f64> = reading.broken.iter().map(|&node| rest[node as usize].x).collect();
            let front = off.iter().copied().fold(-1.0, f64::max);
            let lower = rest.iter().filter(|x| (x.z - 0.005).abs() < 1e-9);
            // all that lies three rows of elements before the front has come off
            let left = lower.filter(|x| x.x < front - 0.0061).count();
            assert!(reading.broken.len() >= left && reading.broken.len() >= before, "{}: {reading:?}", run.name);
            before = reading.broken.len();
        }
        let reading = simulation.attachment("0").unwrap();
        assert!(before > 12 && reading.holds > 6, "{}: it is half off: {reading:?}", run.name);
        let energies = simulation.energies().unwrap();
        assert!(reading.loss.abs() < 0.02 * energies.constraint_work.unwrap(), "{reading:?}");
        let (held, done) = (
            energies.kinetic + energies.strain + energies.hourglass,
            energies.load_work.unwrap() + energies.constraint_work.unwrap() - energies.damping_loss.unwrap(),
        );
        near(&format!("{}: balance of {energies:?}", run.name), held, done, energies.constraint_work.unwrap(), 0.02);
    }
}

/// A tie breaks at its force, and holds what is a little apart where it is, turned or not.
#[test]
fn a_tie_holds_up_to_its_strength() {
    let text = "(duration: 1, bodies: {
            \"low\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (2, 2, 2)), material: \"m\"),
            \"up\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3)), material: \"m\", translate: (0, 0, 0.011))},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3), damping: 40)},
        constraints: [Fixed(body: \"low\", on: All),
            Prescribed(body: \"up\", on: Plane(normal: (0, 0, 1), at: 0.021), displacement: (0, 0, 0.004), curve: Ramp(end: 1))],
        attachments: [Tie(from: (body: \"up\", at: (0.004, 0.006, 0.011)), to: (body: \"low\", at: (0.004, 0.006, 0.01)), strength: 0.05)])";
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(text);
        let mut most = 0.0_f64;
        while simulation.time() < 1.0 && simulation.attachment("0").unwrap().holds == 1 {
            simulation.advance(1).unwrap();
            most = most.max(simulation.attachment("0").unwrap().force.length());
        }
        let reading = simulation.attachment("0").unwrap();
        assert_eq!(reading.holds, 0, "{}: {most}", run.name);
        near(run.name, most, 0.05, 0.05, 0.02);
    }
}

/// Of free bodies that are glued momentum stays to rounding.
#[test]
fn glue_keeps_momentum_and_makes_no_energy() {
    let text = "(duration: 0.1, bodies: {
            \"low\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (2, 2, 2)), material: \"m\", velocity: (0.1, 0, 0.05)),
            \"up\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3)), material: \"m\", translate: (0.001, 0, 0.01),
                velocity: (-0.05, 0.02, -0.1))},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3))},
        attachments: [Glue(bodies: (\"up\", \"low\"))], output: (energies_every: 0.1))";
    for run in configurations() {
        let mut simulation = run.start(text);
        simulation.advance(1).unwrap();
        let momentum = |simulation: &mut Simulation| {
            let rate = 1.0 / simulation.time_step();
            let mut sum = DVec3::ZERO;
            for body in ["low", "up"] {
                let all = simulation.masses(body).unwrap();
                let view = simulation.column::<DisplacementIncrement>(body).unwrap();
                sum += view
                    .node_rows()
                    .iter()
                    .zip(&all)
                    .map(|(&row, mass)| view.values().vector(row as usize) * rate * *mass)
                    .sum::<DVec3>();
            }
            sum
        };
        let wanted = 1e-3 * DVec3::new(0.05, 0.02, -0.05);
        let mut most = f64::INFINITY;
        while simulation.time() < 0.099 {
            near(run.name, (momentum(&mut simulation) - wanted).length(), 0.0, 1e-4, run.bound(1e-11, 1e-4));
            let energies = simulation.energies().unwrap();
            let now = energies.kinetic + energies.strain + energies.hourglass;
            assert!(now < 1.02 * most, "{}: {now} J after {most}", run.name);
            most = most.min(now);
            simulation.advance(20).unwrap();
        }
        assert_eq!(simulation.attachment("0").unwrap().broken, Vec::<u64>::new());
    }
}

/// Ties of surfaces concern no node that is inside a patch: those move with their patch. A point inside a body does.
#[test]
fn glue_does_not_keep_nodes_from_moving_with_their_patch() {
    let inside = "Tie(from: (body: \"low\", at: (0.005, 0.005, 0.019)), to: (body: \"up\", at: (0.005, 0.005, 0.02)))";
    let gone = "removal: [(body: \"up\", on: Box(min: (0, 0, 0.036), max: (0.01, 0.01, 0.04)), when: At(0.5))],";
    let glued = bars(["(3, 3, 6)"; 2], "");
    let tied = glued.replace("attachments: [", &format!("attachments: [{inside}, "));
    let removed = glued.replace("attachments: [", &format!("{gone} attachments: ["));
    let touched = glued.replace("attachments: [", "contacts: [Between(bodies: (\"low\", \"up\"))], attachments: [");
    for (text, moves) in [(&glued, true), (&touched, true), (&tied, false), (&removed, false)] {
        let explained = start(text, Precision::F64, 1).explain(&Registry::default()).unwrap();
        let forces = explained.systems.iter().find(|system| system.name == "element_forces").unwrap();
        assert_eq!(forces.shares_with.iter().any(|name| name == "gather"), moves, "{:?}: {text}", forces.shares_with);
    }
}

/// The same bits on any number of threads, fused or not, and from any step on.
#[test]
fn bits_of_glue_do_not_depend_on_threads_or_pauses() {
    let text =
        bars(["(4, 4, 8)", "(6, 6, 12)"], ", normal: 60").replace("curve: Smooth(end: 1)", "curve: Ramp(end: 0.3)");
    let some_is_off = |simulation: &mut Simulation| {
        let reading = simulation.attachment("glue").unwrap();
        assert!(!reading.broken.is_empty(), "some is off: {reading:?}");
    };
    bits_do_not_depend(&text, &["up"], [0.05, 0.12], [|_| {}, some_is_off]);
}
