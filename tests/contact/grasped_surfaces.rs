//! What a closed tool holds and presses on another body: to contact it is as if it were told where to go.

use crate::bits::bits_do_not_depend;
use crate::configurations::{configurations, near};
use glam::DVec3;
use sinew::Simulation;

/// What is held of what presses.
const ALL: &str = "All";
const LOWER_FACE: &str = "Plane(normal: (0, 0, 1), at: 0.0101)";

/// A block that lies fast, and one above it that goes down by 1.1 mm within 50 ms, 1 mm of it into the lower one: told
/// so, or held by forceps that do.
fn pressed(held: &str, told: bool) -> String {
    let (told, grasped) = match told {
        true => (
            format!(
                ", Prescribed(body: \"high\", on: {held}, displacement: (0, 0, -1.1e-3), curve: Smooth(end: 0.05))"
            ),
            String::new(),
        ),
        false => (
            String::new(),
            format!(
                "tools: {{\"forceps\": (shape: Sphere(radius: 0.01), at: (0.01, 0.01, 0.02),
                    moves: [(displacement: (0, 0, -1.1e-3), curve: Smooth(end: 0.05))])}},
                attachments: [Grasp(tool: \"forceps\", body: \"high\", on: {held}, closed: Step())],"
            ),
        ),
    };
    format!(
        "(duration: 0.2, bodies: {{
            \"low\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (5, 5, 3), elements: Hex8), material: \"m\"),
            \"high\": (mesh: Box(size: (0.01, 0.01, 0.005), cells: (2, 2, 1), elements: Hex8), material: \"m\",
                translate: (0.0045, 0.0055, 0.0101))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3), damping: 60)}},
        contacts: [Between(bodies: (\"low\", \"high\"), friction: 0.3)],
        constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0)){told}], {grasped}
        output: (energies_every: 0.05))"
    )
}

/// How deep it goes in at most (m).
fn deepest(simulation: &mut Simulation) -> f64 {
    let mut deepest = 0.0_f64;
    while simulation.time() < 0.19 {
        simulation.advance(5).unwrap();
        for body in ["low", "high"] {
            deepest = deepest.max(simulation.contact(body).unwrap().penetration);
        }
    }
    deepest
}

fn displacements(simulation: &mut Simulation) -> Vec<DVec3> {
    ["low", "high"].iter().flat_map(|body| simulation.displacements(body).unwrap()).collect()
}

/// Free to contact, what is held went all of the millimetre in.
#[test]
fn what_is_held_goes_in_no_deeper_than_what_is_told_where_to_go() {
    for run in configurations() {
        for held in [ALL, LOWER_FACE] {
            let [mut told, mut grasped] = [true, false].map(|told| run.start(&pressed(held, told)));
            let [of_told, of_grasped] = [&mut told, &mut grasped].map(deepest);
            let what = format!("{}, {held}", run.name);
            assert!(of_told > 1e-5 && of_told < 1e-4, "{what}: a fortieth of an edge at most: {of_told}");
            // how far a point went in the last step contact takes, of what is told, from the next one: they differ by
            // what the curve's acceleration, 6 m/s² a second squared and metre at most, makes of a step in a step
            let change = 6.0 * 1.1e-3 / (0.05 * 0.05) * told.time_step().powi(2);
            near(&what, of_grasped, of_told, change, 1.0);
            let [told, grasped] = [&mut told, &mut grasped].map(displacements);
            for (told, grasped) in told.iter().zip(grasped) {
                assert!(told.distance(grasped) < change, "{what}: {told} and {grasped}");
            }
        }
    }
}

#[test]
fn forceps_feel_what_the_other_body_gets_and_the_books_close() {
    for run in configurations() {
        let mut simulation = run.start(&pressed(ALL, false));
        simulation.advance_to(0.19).unwrap();
        let felt = simulation.tool("forceps").unwrap();
        let [low, high] = ["low", "high"].map(|body| simulation.contact(body).unwrap());
        let what = run.name;
        // 1 mm of 1 cm over a square centimetre, and what the surroundings bear
        assert!(felt.nodes == 18 && felt.force.z > 0.03, "{what}: {felt:?}");
        let force = felt.force.length();
        near(what, (low.force + high.force).length(), 0.0, force, run.bound(1e-14, 1e-6));
        near(what, (felt.force + low.force).length(), 0.0, force, run.bound(1e-14, 1e-6));
        let energies = simulation.energies().unwrap();
        let load_work = energies.load_work.unwrap();
        let taken = felt.loss.unwrap() + low.loss.unwrap() + high.loss.unwrap();
        near(what, load_work, felt.work.unwrap() - taken, felt.work.unwrap(), run.bound(1e-13, 1e-5));
        near(what, energies.contact_loss.unwrap(), taken, felt.work.unwrap(), run.bound(1e-13, 1e-5));
        // of second order in the step
        let kept = energies.kinetic + energies.strain + energies.hourglass + energies.damping_loss.unwrap();
        near(what, kept, load_work, felt.work.unwrap(), 2e-3);
    }
}

/// Where contact makes nodes slip out of forceps that are too weak, it has pushed against held ones, and they are held
/// to the end of that step: else what contact says that it took is not what it took, by a fifth of the tool's work.
#[test]
fn books_close_where_contact_tears_nodes_out_of_forceps() {
    for run in configurations() {
        let text = pressed(ALL, false).replace("closed: Step()", "closed: Step(), strength: 3e-3");
        let mut simulation = run.start(&text);
        simulation.advance_to(0.19).unwrap();
        let felt = simulation.tool("forceps").unwrap();
        let taken = felt.loss.unwrap()
            + ["low", "high"].map(|body| simulation.contact(body).unwrap().loss.unwrap()).iter().sum::<f64>();
        let what = run.name;
        assert!(felt.nodes > 0 && felt.nodes < 18, "{what}: {felt:?}");
        let energies = simulation.energies().unwrap();
        near(what, energies.load_work.unwrap(), felt.work.unwrap() - taken, felt.work.unwrap(), run.bound(1e-13, 1e-5));
        near(what, energies.contact_loss.unwrap(), taken, felt.work.unwrap(), run.bound(1e-13, 1e-5));
    }
}

#[test]
fn bits_of_what_is_held_do_not_depend_on_threads_or_pauses() {
    let touches = |simulation: &mut Simulation| assert!(simulation.contact("low").unwrap().points > 0);
    bits_do_not_depend(&pressed(LOWER_FACE, false), &["low", "high"], [0.04, 0.12], [touches, touches]);
}
