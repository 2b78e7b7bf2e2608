//! Guards of implicit steps: they see the ends of steps, count the work that was done on elements, and end a run whose
//! steps make energy.

use crate::configurations::{cpu_and_long_gpu, near, scene_of};
use crate::implicit::{options, start};
use sinew::components::Precision;
use sinew::observation::sample;
use sinew::{Error, Simulation};
use std::path::Path;

const SCHEMES: [&str; 2] = ["Euler", "GeneralizedAlpha()"];

fn swinging(scheme: &str, more: &str) -> String {
    format!(
        "(duration: 100, solver: Implicit(scheme: {scheme}, step: 2e-3), {more}
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 5), elements: Hex8), material: \"m\")}},
        materials: {{\"m\": (density: 1000, damping: 3, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        constraints: [Fixed(on: Set(\"z0\")), Prescribed(on: Set(\"z1\"), displacement: (0.02, 0, -0.02),
            curve: Smooth(end: 0.05))],
        loads: [Gravity(acceleration: (0, 0, -9.81))])"
    )
}

/// f32: a part of 1e5 of the energies by the rounding of strains of 1e-2. In the middle of a step as long as these
/// elements would hold some per cent less or more.
#[test]
fn samples_see_the_ends_of_implicit_steps() {
    for (run, scheme) in cpu_and_long_gpu().iter().flat_map(|run| SCHEMES.map(|scheme| (run, scheme))) {
        let mut simulation = run.start(&swinging(scheme, ""));
        simulation.advance(12).unwrap();
        let (energies, fields) = (simulation.energies().unwrap(), simulation.fields("b").unwrap());
        let seen = sample(simulation.world_mut()).unwrap();
        let near = |what: &str, a: f64, b: f64| {
            let scale = energies.kinetic + energies.strain;
            let error = (a - b).abs() / scale;
            assert!(error <= run.bound(1e-12, 1e-5), "{}, {scheme}: {what} {a:e} instead of {b:e}", run.name);
        };
        near("kinetic", seen.kinetic, energies.kinetic);
        near("strain", seen.parts.iter().map(|(_, sums)| sums.strain).sum(), energies.strain);
        assert!(energies.strain > 0.1 * energies.kinetic && energies.kinetic > 0.0, "{energies:?}");
        let least = seen.parts.iter().map(|(_, sums)| sums.least_volume_ratio).fold(f64::MAX, f64::min);
        let at_the_end = fields.volume_ratio.iter().copied().fold(f64::MAX, f64::min);
        assert!((least - at_the_end).abs() < run.bound(1e-12, 1e-5) && least < 0.99, "{least}, {at_the_end}");
    }
}

/// The work that is always counted is the work that is counted in full where energies are asked for; kept as two
/// numbers of f32, to 48 bits.
#[test]
fn work_against_internal_forces_is_counted_in_implicit_steps() {
    for (run, scheme) in cpu_and_long_gpu().iter().flat_map(|run| SCHEMES.map(|scheme| (run, scheme))) {
        let [done, asked] = ["", "output: (energies_every: 2e-3),"].map(|more| {
            let mut simulation = run.start(&swinging(scheme, more));
            simulation.advance(50).unwrap();
            sample(simulation.world_mut()).unwrap().internal_work
        });
        let error = (done / asked - 1.0).abs();
        println!("{}, {scheme}: {done:e} J, {asked:e} J: {error:e}", run.name);
        // in f32 what is counted in full is added up node by node in f32
        assert!(error < run.bound(1e-9, 1e-5), "{}, {scheme}: {done:e} instead of {asked:e}", run.name);
    }
}

/// The lens of `lens_pressed.ron` without fibres and viscosity, at rest under its load, which is let go at once.
fn lens_let_go(solver: &str) -> String {
    let text = std::fs::read_to_string("scenes/lens_pressed.ron").unwrap();
    let start = format!("duration: 0.1, start: Equilibrium(method: Newton), solver: {solver},");
    let text = text.replace("duration: 0.2,", &start).replace("Smooth(end: 0.1)", "Table([(0, 1), (1e-12, 0)])");
    let without = |text: String, word: &str| {
        let line = text.lines().find(|line| line.trim_start().starts_with(word)).unwrap().to_owned();
        text.replace(&line, "")
    };
    without(without(text, "fibres:"), "prony:")
}

/// A lens that is let go rings at 72 Hz. Steps of generalised-α of 20 ms, which keep energy of linear bodies, make 290
/// times what it held; it must not end as if nothing were wrong. Those of implicit Euler take energy, and end.
#[test]
fn implicit_steps_that_make_energy_end_the_run() {
    let end = |scheme: &str, (step, precision): (f64, Precision)| {
        let scene = scene_of(&lens_let_go(&format!("Implicit(scheme: {scheme}, step: {step})")), Path::new("scenes"));
        let mut simulation = Simulation::new(&scene, &options(precision, 1)).unwrap();
        let ended = simulation.finish();
        (ended, simulation.guards(), simulation.energies().unwrap())
    };
    // of such steps rounding in f32 decides whether one is found at all
    let (ended, guards, energies) = end("GeneralizedAlpha()", (0.02, Precision::F64));
    println!("{ended:?}\n{guards:?}\n{energies:?}");
    let Err(Error::Unstable(broken)) = ended else { panic!("{ended:?}") };
    assert_eq!(broken.criterion.name, "energy", "{broken:?}");
    assert!(broken.to_string().contains("lower `step` of the solver"), "{broken}");
    for step in [0.02, 0.01, 0.002] {
        let (ended, guards, energies) = end("Euler", (step, Precision::F32));
        println!("{step}: {guards:?}\n{energies:?}");
        ended.unwrap();
        let least = guards.least_volume_ratio.as_ref().unwrap().value;
        assert!(guards.imbalance < 0.1 && least > 0.5, "{guards:?}");
    }
}

/// A block that sticks to a belt by springs far stiffer than itself: iterations that leave many times what they began
/// with have found nothing.
#[test]
fn a_step_whose_iterations_lead_away_ends_the_run() {
    let mut simulation = start(
        "(duration: 0.3, solver: Implicit(step: 0.02),
        bodies: {\"b\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (4, 4, 2), elements: Hex8), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 5e4, poisson: 0.3), stiffness_damping: 1e-3)},
        loads: [Gravity(acceleration: (0, 0, -9.81))],
        tools: {\"k\": (shape: Plane(), path: [(t: 0, at: (0, 0, 0)), (t: 0.3, at: (0.03, 0, 0))])},
        contacts: [Tool(tool: \"k\", friction: 0.8, law: Penalty(share: 30))])",
    );
    let said = simulation.finish().unwrap_err().to_string();
    assert!(said.contains("times the residual of their beginning is left"), "{said}");
}

/// An egg that falls on a block with friction, by steps 15 times the stable one: iterations find no end of what sticks
/// and slides by turns. Elements that are viscous are known to hold less than they do, so that their balance is silent.
/// Whatever becomes of the run, nobody is handed energy that came from nothing (46 and 72 times what there was).
#[test]
fn friction_that_is_not_solved_makes_no_energy_unseen() {
    let viscous = "prony: (terms: [(alpha: 0.3, tau: 0.05)]), stiffness_damping: 1e-4";
    for (share, damping) in [(5.0, "damping: 5"), (1.0, viscous)] {
        let mut simulation = start(&format!(
            "(duration: 0.05, solver: Implicit(step: 0.002),
            bodies: {{
                \"a\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4), elements: Hex8MeanDilatation), material: \"t\"),
                \"b\": (mesh: Ellipsoid(radii: (0.01, 0.008, 0.008), across: 6, elements: Tet4), material: \"t\",
                    translate: (0.012, 0.01, 0.0285), velocity: (0, 0, -0.2), spin: (0, 5, 3))}},
            materials: {{\"t\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.45), {damping})}},
            tools: {{\"p\": (shape: Plane())}},
            contacts: [Tool(tool: \"p\", body: \"a\", friction: 0.3, law: Penalty(share: {share})),
                Between(bodies: (\"a\", \"b\"), friction: 0.3, law: Penalty(share: {share}))])"
        ));
        let held = |simulation: &mut Simulation| {
            let energies = simulation.energies().unwrap();
            energies.kinetic + energies.strain
        };
        let (begun, ended) = (held(&mut simulation), simulation.finish());
        println!("{share}: from {begun:e} J to {:e} J, {ended:?}", held(&mut simulation));
        match ended {
            Ok(()) => {
                let fastest = simulation.guards().fastest_node.unwrap().value;
                assert!(held(&mut simulation) <= begun && fastest < 0.4, "{share}: {fastest} m/s");
            }
            Err(Error::Unstable(broken)) => {
                let said = broken.to_string();
                assert!(["implicit_step", "energy"].contains(&broken.criterion.name), "{said}");
                assert!(said.contains("`adaptive`"), "{said}");
            }
            Err(other) => panic!("{other}"),
        }
    }
}

/// An egg that falls on a block whose foot is moved by next to nothing, in steps of a length (s), with a tolerance.
fn egg_on_what_is_moved(share: f64, (step, more): (f64, &str), way: f64, damping: &str) -> String {
    format!(
        "(duration: 0.05, solver: Implicit(step: {step:?}{more}),
        bodies: {{
            \"a\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4), elements: Hex8MeanDilatation), material: \"t\"),
            \"b\": (mesh: Ellipsoid(radii: (0.01, 0.008, 0.008), across: 6, elements: Tet4), material: \"t\",
                translate: (0.012, 0.01, 0.0285), velocity: (0, 0, -0.2), spin: (0, 5, 3))}},
        materials: {{\"t\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.45), {damping})}},
        constraints: [Prescribed(body: \"a\", on: Set(\"z0\"), displacement: ({way:e}, 0, 0), curve: Ramp(end: 1))],
        contacts: [Between(bodies: (\"a\", \"b\"), friction: 0.3, law: Penalty(share: {share:?}))])"
    )
}

/// That something is told to go, be it by less than an atom, is no reason to take what leads away: with a tolerance of
/// a tenth of all forces no step may leave more than it began with (13 and 7 times that, and the runs went on).
#[test]
fn what_is_moved_as_told_may_leave_no_more_than_what_is_not() {
    for (share, step, way) in [(20.0, 1e-3, 1e-14), (12.0, 2e-3, 1e-10)] {
        let scene = egg_on_what_is_moved(share, (step, ", tolerance: 0.1"), way, "damping: 5");
        let mut simulation = start(&scene);
        let ended = simulation.finish();
        let left = simulation.implicit_steps().unwrap().largest_residual_left;
        println!("{share}, {step} s, {way:e} m: {left} is left, {ended:?}");
        assert!(left <= 1.0, "{share}, {step} s, {way:e} m: {left} is left, {ended:?}");
    }
}

/// Thirteen steps, all between two checks: the formula makes 12 times the energy that there was, and then takes it
/// again. Nobody is handed what became of the bodies meanwhile as if nothing were wrong.
#[test]
fn what_a_formula_makes_and_takes_again_is_seen() {
    let viscous = "prony: (terms: [(alpha: 0.3, tau: 0.05)]), stiffness_damping: 1e-4";
    let mut simulation = start(&egg_on_what_is_moved(5.0, (4e-3, ""), 1e-6, viscous));
    let held = |simulation: &mut Simulation| {
        let energies = simulation.energies().unwrap();
        energies.kinetic + energies.strain
    };
    let begun = held(&mut simulation);
    let (mut most, mut ended): (f64, Result<(), Error>) = (begun, Ok(()));
    while ended.is_ok() && !simulation.is_finished() {
        ended = simulation.advance(1);
        most = most.max(held(&mut simulation));
    }
    println!("from {begun:e} J to {most:e} J at most, {ended:?}");
    match ended {
        Ok(()) => assert!(most < 1.5 * begun, "{most:e} J of {begun:e} J"),
        Err(Error::Unstable(broken)) => {
            assert!(["implicit_step", "energy"].contains(&broken.criterion.name), "{broken}");
        }
        Err(other) => panic!("{other}"),
    }
}

/// What rubs or is damped turns over many times what it holds, and the formula makes some per cent of that: a block
/// that is pulled over a plane, and bars that begin in motion and are dragged through what damps them, where the sums
/// of Euler keep −½ h c M v² for ever. That is more than a tenth of the largest energy, and nothing is wrong with it.
#[test]
fn what_is_made_of_much_that_is_turned_over_ends_no_run() {
    let slides = "(duration: 0.9, solver: Implicit(step: 0.01, tolerance: 1e-2), output: (energies_every: 0.1),
        bodies: {\"b\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (2, 2, 1), elements: Hex8MeanDilatation), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.45))},
        tools: {\"t\": (shape: Plane())}, contacts: [Tool(tool: \"t\", friction: 0.3, law: Penalty(share: 0.1))],
        constraints: [Prescribed(on: Set(\"x1\"), axes: [X], displacement: (0.2, 0, 0), curve: Ramp(end: 4))],
        loads: [Gravity(acceleration: (0, 0, -9.81), curve: Smooth(end: 0.1))])"
        .to_string();
    let dragged = |duration: f64, step: f64, young: f64| {
        format!(
            "(duration: {duration:?}, solver: Implicit(step: {step:?}), output: (energies_every: 0.1),
            bodies: {{\"b\": (mesh: Box(size: (0.06, 0.01, 0.01), cells: (6, 1, 1), elements: Hex8MeanDilatation), material: \"m\",
                velocity: (0.2, 0, 0))}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: {young:?}, poisson: 0.45), damping: 100)}},
            constraints: [Prescribed(on: Set(\"x1\"), displacement: (0.2, 0, 0), curve: Ramp(end: 1))])"
        )
    };
    for (name, scene) in [("slides", slides), ("soft", dragged(0.5, 0.01, 1e4)), ("stiff", dragged(0.4, 0.02, 1e6))] {
        let mut simulation = start(&scene);
        let ended = simulation.finish();
        let (guards, made) = (simulation.guards(), -simulation.energies().unwrap().scheme_loss.unwrap());
        println!("{name}: {:.1} % made, {ended:?}, {:?}", 100.0 * made / guards.scale, guards.warnings);
        ended.unwrap();
        assert!(made > 0.1 * guards.scale && guards.scale > 0.0, "{name}: {made:e} J of {:e} J", guards.scale);
        let warned = guards.warnings.iter().any(|notice| notice.criterion == "scheme_loss");
        assert!(!warned && guards.checks > 1, "{name}: {:?}", guards.warnings);
    }
}

/// A bar that is at rest and is pulled: no residual is there before its end has been moved, and one iteration leaves
/// many times that.
#[test]
fn what_is_pulled_from_rest_may_take_one_iteration_a_step() {
    for law in ["linear", "corotational", "neo_hookean"] {
        let mut simulation = start(&format!(
            "(duration: 0.3, solver: Implicit(step: 0.01, newton: 1),
            bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.04), cells: (2, 2, 4), elements: Hex8), material: \"m\")}},
            materials: {{\"m\": (density: 1000, {law}: Young(young: 5e4, poisson: 0.3), stiffness_damping: 5e-3)}},
            constraints: [
                Fixed(on: Set(\"z0\"), axes: [Z]), Fixed(on: Set(\"x0\"), axes: [X]), Fixed(on: Set(\"y0\"), axes: [Y]),
                Prescribed(on: Set(\"z1\"), axes: [Z], displacement: (0, 0, 0.002), curve: Smooth(end: 0.2)),
            ])"
        ));
        simulation.finish().unwrap();
        let rest = simulation.rest_positions("b").unwrap();
        let end = simulation.displacements("b").unwrap();
        let far = end.iter().zip(&rest).map(|(u, x)| (u.z - 0.05 * x.z).abs()).fold(0.0, f64::max);
        near(law, far, 0.0, 0.002, 0.02);
    }
}
