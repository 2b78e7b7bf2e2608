//! Contact at rest by Newton's iterations: closed forms, and where relaxation with the same springs has bodies.

use crate::bits::start;
use crate::configurations::near;
use glam::DVec3;
use sinew::components::{ContactForce, Precision};
use sinew::{BackendChoice, Options, SceneFile, Simulation};
use std::path::Path;

const NEWTON: &str = "Static(method: Newton)";
const RELAXED: &str = "Static(tolerance: 1e-9)";

/// Finds rest on a number of threads.
fn rest_on(text: &str, precision: Precision, threads: usize) -> Simulation {
    let mut simulation = start(text, precision, threads);
    simulation.finish().unwrap();
    let found = simulation.equilibrium().unwrap();
    println!("{} steps, {found:?}\n{:?}", simulation.step_count(), simulation.implicit_steps());
    assert!(found.reached, "{found:?}");
    simulation
}

fn rest(text: &str) -> Simulation {
    rest_on(text, Precision::F64, 1)
}

/// Found by Newton's iterations, to ten digits of loads.
fn by_newton(text: &str) -> Simulation {
    let simulation = rest(&text.replace("ANALYSIS", NEWTON));
    let found = simulation.equilibrium().unwrap();
    assert!(found.newton_iterations > 0 && found.residual <= 1e-9, "{found:?}");
    simulation
}

/// The largest distance of a body from where it is in another simulation, as a share of its largest displacement.
fn apart(one: &mut Simulation, other: &mut Simulation, body: &str) -> f64 {
    let [one, other] = [one, other].map(|simulation| simulation.displacements(body).unwrap());
    let largest = other.iter().map(|u| u.length()).fold(0.0, f64::max);
    one.iter().zip(&other).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / largest
}

fn block(share: f64, at: f64) -> String {
    format!(
        "(duration: 1, analysis: ANALYSIS,
        bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (4, 4, 1), elements: Hex8MeanDilatation), translate: (0, 0, {at:?}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0))}},
        loads: [Gravity(acceleration: (0, 0, -9.81))],
        tools: {{\"table\": (shape: Plane())}}, contacts: [Tool(tool: \"table\", law: Penalty(share: {share}))])"
    )
}

/// One layer without lateral stretch, whose lower nodes have half of its mass: it sinks in by 2 g Δt²/share. Nothing
/// but the table holds it; one that has to fall first is led there by relaxation.
#[test]
fn a_block_rests_by_its_weight_on_a_table() {
    for (share, at) in [(0.1, 0.0), (1.0, 0.0), (10.0, 0.0), (100.0, 0.0), (1.0, 1e-3)] {
        let mut simulation = by_newton(&block(share, at));
        let step = simulation.summary("").unwrap().stability.bound.time_step;
        let (reading, weight) = (simulation.tool("table").unwrap(), 1000.0 * 4e-6 * 9.81);
        let what = format!("share {share} at {at}");
        near(&format!("{what}: weight"), -reading.force.z, weight, weight, 1e-8);
        let depth = 2.0 * 9.81 * step * step / share;
        near(&format!("{what}: depth"), reading.penetration, depth, depth, 1e-7);
        assert!(reading.nodes == 25 && reading.work.is_none(), "{what}: {reading:?}");
    }
}

fn pressed(friction: f64, depth: f64) -> String {
    format!(
        "(duration: 1, analysis: ANALYSIS,
        bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.005), cells: (8, 8, 4), elements: Hex8MeanDilatation), translate: (0, 0, -0.005), material: \"m\")}},
        materials: {{\"m\": (density: 1060, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: -0.005)),
            Fixed(on: Plane(normal: (1, 0, 0), at: 0), axes: [X]), Fixed(on: Plane(normal: (0, 1, 0), at: 0), axes: [Y])],
        tools: {{\"ball\": (shape: Sphere(radius: 5e-3), at: (0, 0, 5e-3), moves: [(displacement: (0, 0, -{depth:?}))])}},
        contacts: [Tool(tool: \"ball\", on: Surface(normal: (0, 0, 1)), friction: {friction}, law: Penalty(share: 1))],
        probes: {{\"base\": (what: Force(direction: (0, 0, 1)), on: Plane(normal: (0, 0, 1), at: -0.005))}})"
    )
}

#[test]
fn a_ball_presses_as_on_the_way_of_relaxation() {
    let text = pressed(0.0, 1.5e-3);
    let mut solved = by_newton(&text);
    let mut relaxed = rest(&text.replace("ANALYSIS", RELAXED));
    near("apart", apart(&mut solved, &mut relaxed, "b"), 0.0, 1.0, 1e-7);
    let [a, b] = [&mut solved, &mut relaxed].map(|simulation| simulation.tool("ball").unwrap());
    assert!(b.force.z > 1e-3 && b.nodes >= 8 && a.nodes == b.nodes, "{a:?} {b:?}");
    near("force", (a.force - b.force).length(), 0.0, b.force.z, 1e-7);
    near("base", solved.probe("base").unwrap()[0].abs(), a.force.z, a.force.z, 1e-8);
}

#[test]
fn friction_holds_the_surface_under_a_ball() {
    let mut simulation = by_newton(&pressed(0.3, 1e-3));
    let mut smooth = by_newton(&pressed(0.0, 1e-3));
    let (held, slid) = (simulation.tool("ball").unwrap(), smooth.tool("ball").unwrap());
    // what cannot slide aside is harder to press
    assert!(held.force.z > 1.005 * slid.force.z && held.nodes == slid.nodes, "{held:?} {slid:?}");
}

fn stack(points: &str, friction: f64) -> String {
    format!(
        "(duration: 1, analysis: ANALYSIS,
        bodies: {{\"low\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3), elements: Hex8MeanDilatation), material: \"m\"),
            \"high\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (2, 2, 2), elements: Hex8MeanDilatation), rotate: (0, 0, 15), translate: (0.002, -0.003, 0.02), material: \"m\")}},
        materials: {{\"m\": (density: 1050, neo_hookean: Young(young: 3e4, poisson: 0.45))}},
        loads: [Gravity(body: \"low\", acceleration: (0, 0, -9.81)), Gravity(body: \"high\", acceleration: (0, 0, -9.81))],
        tools: {{\"table\": (shape: Plane())}},
        contacts: [Tool(tool: \"table\", body: \"low\", friction: {friction}, law: Penalty(share: 1)),
            Between(bodies: (\"low\", \"high\"), friction: {friction}, points: {points}, law: Penalty(share: 1))])"
    )
}

#[test]
fn each_block_of_a_stack_bears_those_above_it() {
    for (points, friction) in [("Faces", 0.5), ("Nodes", 0.5)] {
        let mut simulation = by_newton(&stack(points, friction));
        let weight = 1050.0 * 8e-6 * 9.81;
        let what = format!("{points}, friction {friction}");
        let table = simulation.tool("table").unwrap().force.z;
        near(&format!("{what}: table"), -table, 2.0 * weight, weight, 1e-8);
        let on = |simulation: &mut Simulation, body: &str| -> DVec3 {
            simulation.column::<ContactForce>(body).unwrap().values().vectors().sum()
        };
        let (on_high, on_low) = (on(&mut simulation, "high"), on(&mut simulation, "low"));
        near(&format!("{what}: high"), on_high.z, weight, weight, 1e-8);
        near(&format!("{what}: they are opposite"), (on_high + on_low).length(), 0.0, weight, 1e-9);
    }
}

/// In f32 and on more threads it is the same rest, to what f32 has of it, and on any number of threads the same bits.
#[test]
fn bits_of_rest_do_not_depend_on_threads() {
    let text = stack("Faces", 0.5).replace("ANALYSIS", NEWTON);
    let mut runs = [1, 2, 3].map(|threads| rest_on(&text, Precision::F32, threads));
    let [first, second, third] = runs.each_mut().map(|simulation| simulation.displacements("high").unwrap());
    assert!(first == second && first == third && first.iter().any(|u| u.length() > 1e-6));
    let mut exact = by_newton(&stack("Faces", 0.5));
    near("in f32", apart(&mut runs[0], &mut exact, "high"), 0.0, 1.0, 5e-3);
}

/// A motion that begins at rest on springs stays there, in implicit steps, whose springs are the same; also where the
/// motion, and not the search for rest, has room for what may be laid bare.
#[test]
fn a_motion_begins_at_rest_on_springs() {
    let second_order = "scheme: GeneralizedAlpha(), ";
    for (points, inverted, scheme) in [
        ("Nodes", "", ""),
        ("Faces", "", ""),
        ("Nodes", ", inversion: Remove", ""),
        ("Faces", ", inversion: Remove", ""),
        ("Nodes", "", second_order),
        ("Faces", "", second_order),
    ] {
        let motion =
            format!("start: Equilibrium(method: Newton), solver: Implicit({scheme}step: 0.01, tolerance: 1e-8),");
        let text = stack(points, 0.5)
            .replace("analysis: ANALYSIS,", &motion)
            .replace("poisson: 0.45)", &format!("poisson: 0.45){inverted}"));
        let mut simulation = start(&text, Precision::F64, 1);
        simulation.settle().unwrap();
        assert!(simulation.preload().unwrap().equilibrium.newton_iterations > 0);
        let before = ["low", "high"].map(|body| simulation.displacements(body).unwrap());
        simulation.advance(20).unwrap();
        for (body, before) in ["low", "high"].into_iter().zip(&before) {
            let now = simulation.displacements(body).unwrap();
            let moved = now.iter().zip(before).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            let largest = before.iter().map(|u| u.length()).fold(0.0, f64::max);
            near(&format!("{points}{inverted} {scheme}: {body} stays"), moved, 0.0, largest, 1e-5);
        }
    }
}

/// Threads and glue hold what nothing else does.
#[test]
fn what_is_sewn_and_glued_rests() {
    let scene = |more: &str| {
        format!(
            "(duration: 1, analysis: ANALYSIS,
            bodies: {{\"a\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (4, 4, 2)), translate: (0, 0, 0.02), material: \"m\"),
                \"b\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (4, 4, 2)), translate: (0, 0, GAP), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))}},
            constraints: [Fixed(body: \"a\", on: Plane(normal: (0, 0, 1), at: 0.03))],
            loads: [Gravity(body: \"a\", acceleration: (0, 0, -2)), Gravity(body: \"b\", acceleration: (0, 0, -2))],
            probes: {{\"top\": (body: \"a\", what: Force(direction: (0, 0, 1)), on: Plane(normal: (0, 0, 1), at: 0.03))}}, {more})"
        )
    };
    let weight = 4e-3 * 2.0;
    let sewn = scene(
        "attachments: [Suture(from: (body: \"a\", at: (0.004, 0.004, 0.02)), to: (body: \"b\", at: (0.004, 0.004, 0.009)), stiffness: 5),
            Suture(from: (body: \"a\", at: (0.016, 0.004, 0.02)), to: (body: \"b\", at: (0.016, 0.004, 0.009)), stiffness: 5),
            Suture(from: (body: \"a\", at: (0.01, 0.016, 0.02)), to: (body: \"b\", at: (0.01, 0.016, 0.009)), stiffness: 5)]",
    )
    .replace("GAP", "-0.001");
    let glued = scene("attachments: [Glue(bodies: (\"b\", \"a\"))]").replace("GAP", "0.01");
    for (what, text) in [("sewn", sewn), ("glued", glued)] {
        println!("{what}");
        let mut simulation = by_newton(&text);
        near(&format!("{what}: weight of both"), simulation.probe("top").unwrap()[0].abs(), 2.0 * weight, weight, 1e-7);
    }
}

/// What a closed tool holds goes with it to where that is at rest, and the tool bears what it takes.
#[test]
fn a_closed_tool_holds_at_rest_as_on_the_way_of_relaxation() {
    let text = "(duration: 1, analysis: ANALYSIS,
        bodies: {\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3), elements: Hex8MeanDilatation), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
        constraints: [Fixed(on: Set(\"z0\"))], loads: [Gravity(acceleration: (0, 0, -9.81))],
        tools: {\"forceps\": (shape: Capsule(length: 0.05, radius: 0.004), at: (0.01, 0.01, 0.02), moves: [(displacement: (2e-3, 0, 1e-3))])},
        attachments: [Grasp(tool: \"forceps\", on: Plane(normal: (0, 0, 1), at: 0.02), closed: Step(start: 0.5))],
        probes: {\"base\": (what: Reaction, on: Set(\"z0\"))})";
    let mut solved = by_newton(text);
    let mut relaxed = rest(&text.replace("ANALYSIS", RELAXED));
    near("apart", apart(&mut solved, &mut relaxed, "b"), 0.0, 1.0, 1e-6);
    let [a, b] = [&mut solved, &mut relaxed].map(|simulation| simulation.tool("forceps").unwrap());
    assert!(a.nodes == 16 && b.nodes == 16 && b.force.length() > 0.02, "{a:?} {b:?}");
    let base = DVec3::from_slice(&solved.probe("base").unwrap());
    let weight = DVec3::new(0.0, 0.0, -1000.0 * 8e-6 * 9.81);
    // the probe has what elements do to what is held, the tool what nodes do to it
    println!("{base} N at the base, {} N at the tool, {weight} N", a.force);
    println!("{} N at the tool of relaxation", b.force);
    near("balance", (base.abs() - (weight - a.force).abs()).length(), 0.0, weight.length(), 1e-7);
    near("force", (a.force - b.force).length(), 0.0, b.force.length(), 1e-6);
}

/// Two blocks that are held at their far ends and come to each other across a gap, by half an edge and more: who meets
/// whom is found on the way.
#[test]
fn blocks_that_are_led_to_each_other_press_as_on_the_way_of_relaxation() {
    for points in ["Nodes", "Faces"] {
        let text = format!(
            "(duration: 1, analysis: ANALYSIS,
            bodies: {{\"low\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (4, 4, 2), elements: Hex8MeanDilatation), material: \"m\"),
                \"high\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3), elements: Hex8MeanDilatation), translate: (0.004, 0.003, 0.012), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4))}},
            constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0)),
                Prescribed(body: \"high\", on: Plane(normal: (0, 0, 1), at: 0.022), displacement: (0, 0, -3e-3))],
            contacts: [Between(bodies: (\"low\", \"high\"), points: {points}, law: Penalty(share: 1))],
            probes: {{\"base\": (body: \"low\", what: Force(direction: (0, 0, 1)), on: Plane(normal: (0, 0, 1), at: 0)),
                \"lid\": (body: \"high\", what: Force(direction: (0, 0, 1)), on: Plane(normal: (0, 0, 1), at: 0.022))}})"
        );
        let mut solved = by_newton(&text);
        let mut relaxed = rest(&text.replace("ANALYSIS", RELAXED));
        let forces = ["base", "lid"].map(|probe| solved.probe(probe).unwrap()[0]);
        assert!(forces[0].abs() > 0.01, "{points}: {forces:?}");
        near(&format!("{points}: both ways"), forces[0] + forces[1], 0.0, forces[0].abs(), 1e-8);
        for body in ["low", "high"] {
            near(&format!("{points}: {body}"), apart(&mut solved, &mut relaxed, body), 0.0, 1.0, 1e-6);
        }
    }
}

/// Hard cases of rest with springs in place of the kinematic law: a ball between plates (H38) and a flat punch (H48).
#[test]
fn hard_cases_rest_where_relaxation_has_them() {
    for (name, count, sets) in [("h38_pressed_ball", 2, vec!["bodies.body.mesh.across=8"]), ("h48_punch", 1, vec![])] {
        let path = format!("{}/scenes/hard/{name}.ron", env!("CARGO_MANIFEST_DIR"));
        let run = |analysis: &str| {
            let laws = (0..count).map(|number| format!("contacts[{number}].law=Penalty(share: 1)"));
            let mut all: Vec<String> = sets.iter().map(|set| set.to_string()).chain(laws).collect();
            all.push(format!("analysis={analysis}"));
            let file = SceneFile::load(Path::new(&path), &all).unwrap();
            let options = Options { backend: BackendChoice::Cpu, precision: Precision::F64, ..Options::default() };
            let mut simulation = Simulation::new(&file, &options).unwrap();
            simulation.finish().unwrap();
            println!("{name}: {:?}\n{:?}", simulation.equilibrium(), simulation.implicit_steps());
            simulation
        };
        let (mut solved, mut relaxed) = (run(NEWTON), run(RELAXED));
        let found = solved.equilibrium().unwrap();
        assert!(found.newton_iterations > 0 && found.residual <= 1e-9, "{found:?}");
        near(name, apart(&mut solved, &mut relaxed, "body"), 0.0, 1.0, 1e-6);
    }
}

/// A ball between plates without friction: the forces of a search say nothing of where it is along them, and whatever
/// rounding leaves of them moves it (.8 mm of 6 cm, if nobody minds).
#[test]
fn what_nothing_holds_across_stays_where_it_is() {
    for (precision, bound) in [(Precision::F64, 1e-9), (Precision::F32, 1e-6)] {
        let text = format!(
            "(duration: 1, analysis: {NEWTON},
            bodies: {{\"b\": (mesh: Ellipsoid(radii: (0.03, 0.03, 0.02), across: 6, elements: Hex8MeanDilatation), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
            tools: {{\"low\": (shape: Plane(), at: (0, 0, -0.02)),
                \"high\": (shape: Box(size: (0.1, 0.1, 0.01)), rounding: 0.001, at: (0, 0, 0.025),
                    moves: [(displacement: (0, 0, -0.01), curve: Smooth(end: 0.3))])}},
            contacts: [Tool(tool: \"low\", law: Penalty(share: 20)), Tool(tool: \"high\", law: Penalty(share: 20))])"
        );
        let mut simulation = rest_on(&text, precision, 1);
        assert!(simulation.equilibrium().unwrap().newton_iterations > 0, "{precision:?}");
        assert!(simulation.tool("low").unwrap().force.z < -0.1, "{precision:?}: it is not pressed");
        let u = simulation.displacements("b").unwrap();
        let aside = u.iter().map(|u| u.truncate()).sum::<glam::DVec2>() / u.len() as f64;
        println!("{precision:?}: {aside:?}");
        assert!(aside.length() < bound, "{precision:?}: {aside:?}");
    }
}

/// A column that a closed tool holds at its foot gives way where one with a clamped foot does (π² E I/(4 L²)), and not
/// where springs of a ring guide its head as well (some eight times as much). Pseudo-steps find rest at the higher
/// load, as they do without what holds and touches.
#[test]
fn whether_rest_lasts_is_asked_with_what_holds_and_touches() {
    let critical = std::f64::consts::PI.powi(2) * 3e3 * 1e-8 / 12.0 / (4.0 * 0.01);
    let ring = "\"ring\": (shape: Tube(length: 0.01, inner: 0.00705, outer: 0.01), at: (0.005, 0.005, 0.095))";
    let touches = "contacts: [Tool(tool: \"ring\", law: Penalty(share: 1))],";
    for (share, ring, touches, buckles) in
        [(0.85, "", "", false), (1.5, "", "", true), (1.5, ring, touches, false), (0.85, ring, touches, false)]
    {
        let text = format!(
            "(duration: 1, analysis: {NEWTON},
            bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.1), cells: (2, 2, 20), elements: Hex8), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0))}},
            tools: {{\"jaws\": (shape: Sphere(radius: 0.01), at: (0.005, 0.005, 0)), {ring}}}, {touches}
            attachments: [Grasp(tool: \"jaws\", on: Plane(normal: (0, 0, 1), at: 0), closed: Step())],
            loads: [NodalForce(on: Plane(normal: (0, 0, 1), at: 0.1), force: (0, 0, {:?}), share: Total)])",
            -share * critical
        );
        let simulation = rest(&text);
        let found = simulation.equilibrium().unwrap();
        assert_eq!(found.unstable, buckles, "{share}, {touches}: {found:?}");
    }
}
