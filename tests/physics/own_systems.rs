//! Loads of the scene's own in WGSL do what the engine's own loads and closed forms say, on every backend, and know
//! nothing that other systems do not.
//!
//! Bounds: the same sums of the same products in the run's precision: rounding of a few hundred steps, 1e-12 in f64,
//! 1e-5 in f32.

use crate::configurations::{configurations, cpu_and_long_gpu, near};
use sinew::glam::DVec3;
use sinew::systems::Registry;
use sinew::{BackendChoice, Options, Simulation};

/// A folder with files of WGSL.
fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn bar(more: &str) -> String {
    format!(
        "(duration: 10, bodies: {{
            \"a\": (mesh: Box(size: (1, 0.5, 0.5), cells: (7, 3, 3), elements: Tet4), material: \"m\"),
            \"b\": (mesh: Box(size: (1, 0.5, 0.5), cells: (6, 3, 3), elements: Hex8), material: \"m\", translate: (0, 1, 0))}},
        materials: {{\"m\": (density: 1000, damping: 0.5, neo_hookean: Young(young: 2e4, poisson: 0.4))}},
        constraints: [
            Fixed(body: \"a\", on: Plane(normal: (1, 0, 0), at: 0)),
            Prescribed(body: \"b\", on: Plane(normal: (1, 0, 0), at: 0), displacement: (0, 0, 0.02), curve: Smooth(end: 0.2))],
        integration: (step: 0.002), {more})"
    )
}

fn displacements(simulation: &mut Simulation) -> Vec<DVec3> {
    ["a", "b"].map(|body| simulation.displacements(body).unwrap()).concat()
}

/// The largest distance between two fields, as a share of the largest of the second.
fn apart(found: &[DVec3], expected: &[DVec3]) -> f64 {
    let largest = expected.iter().map(|u| u.length()).fold(0.0, f64::max);
    assert!(largest > 1e-4 && found.len() == expected.len(), "{largest}");
    found.iter().zip(expected).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / largest
}

/// What the engine's own loads do, written in WGSL: with a curve, on all nodes and on some.
#[test]
fn gravity_and_nodal_forces_written_in_wgsl_are_those_of_the_engine() {
    let folder = folder(&[
        ("fall.wgsl", "fn fall(node: Node) -> vec3<f32> { return node.curve * vec3f(0, 0, -9.81) * node.mass; }"),
        ("push.wgsl", "fn push(n: Node) -> vec3f { return vec3(0.1, -0.2, 0.3) * n.curve; }"),
    ]);
    let curve = "curve: Smooth(end: 0.1)";
    let on = "on: Plane(normal: (0, 0, 1), at: 0.5)";
    let built_in = bar(&format!(
        "loads: [Gravity(acceleration: (0, 0, -9.81), {curve}), NodalForce(body: \"b\", {on}, force: (0.1, -0.2, 0.3))]"
    ));
    let own = bar(&format!(
        "systems: {{\"fall\": (file: \"fall.wgsl\", {curve}), \"push\": (file: \"push.wgsl\", body: \"b\", {on})}}"
    ));
    for run in cpu_and_long_gpu() {
        let [found, expected] = [&own, &built_in].map(|text| {
            let mut simulation = run.start_in(text, folder.path());
            simulation.advance(200).unwrap_or_else(|error| panic!("{}: {error}", run.name));
            displacements(&mut simulation)
        });
        let error = apart(&found, &expected);
        println!("{}: {error:.2e}", run.name);
        assert!(error <= run.bound(1e-12, 1e-5), "{}: {error:e}", run.name);
    }
}

/// Two systems whose texts declare the same names, helper functions, structs, constants and parameters, each with its
/// own meaning.
const FALL: &str = "struct Numbers { strength: f32 } // of gravity\n\
    @group(0) @binding(0) var<uniform> parameters: Numbers;\n\
    const axis = vec3<f32>(0.0, 0.0, -1.0);\n\
    fn strength(node: Node) -> f32 { return node.mass * parameters.strength; }\n\
    fn fall(node: Node) -> vec3<f32> { return strength(node) * axis; }\n";
const DRAG: &str = "struct Numbers {\n    unused: f32,\n    strength: f32, // 1/m\n}\n\
    @group(0) @binding(0) var<uniform> parameters: Numbers;\n\
    const axis = 1.0;\n\
    fn strength(speed: f32) -> f32 { return axis * parameters.strength * speed; }\n\
    fn drag(node: Node) -> vec3<f32> {\n    return -node.mass * strength(length(node.velocity)) * node.velocity;\n}\n";

/// A body that falls through air: v̇ = g − d v², v = √(g/d) tanh(√(gd) t), z = −ln cosh(√(gd) t)/d. What is computed is
/// v⁺ = v + Δt (g − d v²) with v in the middle of the step before, which lags by half a step: first order.
#[test]
fn a_body_falls_through_air_as_the_closed_form_says() {
    let folder = folder(&[("fall.wgsl", FALL), ("drag.wgsl", DRAG)]);
    let (gravity, drag, end) = (9.81_f64, 0.5_f64, 2.0);
    let depth = (f64::sqrt(gravity * drag) * end).cosh().ln() / drag;
    for run in configurations() {
        let fallen = |step: f64| {
            let text = format!(
                "(duration: {end}, bodies: {{\"a\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e3, poisson: 0.3))}},
                systems: {{
                    \"drag\": (file: \"drag.wgsl\", parameters: {{\"strength\": {drag}, \"unused\": 7}}),
                    \"fall\": (file: \"fall.wgsl\", parameters: {{\"strength\": {gravity}}})}},
                integration: (step: {step}))"
            );
            let mut simulation = run.start_in(&text, folder.path());
            simulation.advance_to(end).unwrap_or_else(|error| panic!("{}: {error}", run.name));
            let all = simulation.displacements("a").unwrap();
            let lowest = all.iter().map(|u| u.z).fold(f64::INFINITY, f64::min);
            let highest = all.iter().map(|u| u.z).fold(f64::NEG_INFINITY, f64::max);
            near(run.name, lowest, highest, depth, run.bound(1e-12, 1e-4));
            -lowest
        };
        let (step, steps) = (1e-3, 2000);
        let found = fallen(step);
        // the first step is half of one from rest
        let (mut speed, mut place) = (0.0, 0.0);
        for number in 0..steps {
            let between = if number == 0 { 0.5 * step } else { step };
            speed += between * (gravity - drag * speed * speed);
            place += step * speed;
        }
        near(run.name, found, place, depth, run.bound(1e-11, 1e-4));
        let error = found - depth;
        near(run.name, found, depth, depth, 2e-3);
        if run.bound(0.0, 1.0) == 0.0 {
            let halved = fallen(0.5 * step) - depth;
            assert!((error / halved - 2.0).abs() < 0.1, "{error:e} becomes {halved:e} with half the step");
        }
    }
}

/// The names of those that share a system's pass.
fn shares_with(simulation: &mut Simulation, name: &str, on_gpu: bool) -> Vec<String> {
    let registry = Registry::default();
    let explained = if on_gpu { simulation.explain_on_gpu(&registry) } else { simulation.explain(&registry) };
    let explained = explained.unwrap_or_else(|error| panic!("{error}"));
    let found = explained.systems.into_iter().find(|system| system.name == name);
    found.unwrap_or_else(|| panic!("there is no {name}")).shares_with
}

#[test]
fn a_system_of_the_scene_shares_the_pass_of_the_engines_own() {
    let folder = folder(&[("fall.wgsl", FALL), ("drag.wgsl", DRAG)]);
    let systems = "systems: {
        \"drag\": (file: \"drag.wgsl\", parameters: {\"strength\": 0.5, \"unused\": 7}),
        \"fall\": (file: \"fall.wgsl\", parameters: {\"strength\": 9.81})}";
    for run in configurations().into_iter().filter(|run| run.options.backend == BackendChoice::Cpu) {
        let mut simulation = run.start_in(&bar(systems), folder.path());
        let all = ["element_forces", "gather", "boundary", "fall", "integrate"];
        assert_eq!(shares_with(&mut simulation, "drag", false), all);
        if run.name == "CPU f32" {
            assert_eq!(shares_with(&mut simulation, "drag", true), &all[1..]);
            let explained = simulation.explain_on_gpu(&Registry::default()).unwrap();
            let labels: Vec<&str> = explained.kernels.iter().map(|kernel| kernel.label.as_str()).collect();
            assert!(
                labels.iter().any(|label| label.contains("gather + boundary + drag + fall + integrate")),
                "{labels:?}"
            );
        }
    }
    // a schedule that is written out has it where it stands
    let schedule =
        "schedule: [\"boundary\", \"element_forces\", \"gather\", \"fall\", \"drag\", \"integrate\", \"observe\"],";
    let mut simulation = configurations()[0].start_in(&bar(&format!("{schedule} {systems}")), folder.path());
    assert_eq!(
        shares_with(&mut simulation, "drag", false),
        ["element_forces", "gather", "boundary", "fall", "integrate"]
    );
}

const GUSTS: &str = "systems: {
    \"drag\": (file: \"drag.wgsl\", parameters: {\"strength\": 0.5, \"unused\": 7}),
    \"fall\": (file: \"fall.wgsl\", parameters: {\"strength\": 9.81})},";

#[test]
fn a_shared_pass_changes_nothing_whatever_the_number_of_threads() {
    let folder = folder(&[("fall.wgsl", FALL), ("drag.wgsl", DRAG)]);
    for run in cpu_and_long_gpu() {
        let end = |fuse: bool, threads: usize| {
            let file = crate::configurations::scene_of(&bar(&format!("{GUSTS} fuse: {fuse}")), folder.path());
            let mut simulation = Simulation::new(&file, &Options { threads, ..run.options.clone() }).unwrap();
            simulation.advance(150).unwrap();
            displacements(&mut simulation)
        };
        let whole = end(true, 1);
        if run.options.backend == BackendChoice::Gpu {
            let error = apart(&end(false, 1), &whole);
            assert!(error < 1e-5, "{}: {error:e}", run.name);
        } else {
            assert_eq!(end(false, 1), whole, "{}", run.name);
            assert_eq!(end(true, 3), whole, "{}", run.name);
        }
    }
}

#[test]
fn a_run_goes_on_from_a_snapshot_to_the_bit_and_not_with_another_text() {
    let (folder, other) = (folder(&[("fall.wgsl", FALL), ("drag.wgsl", DRAG)]), folder(&[("drag.wgsl", DRAG)]));
    std::fs::write(other.path().join("fall.wgsl"), FALL.replace("* axis", "* axis * 1.5")).unwrap();
    for run in cpu_and_long_gpu() {
        let text = bar(GUSTS);
        let mut whole = run.start_in(&text, folder.path());
        whole.advance(60).unwrap();
        let kept = whole.snapshot().unwrap();
        whole.advance(60).unwrap();
        let mut again = run.start_in(&text, folder.path());
        again.restore(&kept).unwrap();
        again.advance(60).unwrap();
        assert_eq!(displacements(&mut whole), displacements(&mut again), "{}", run.name);
        for (text, folder) in [(text.clone(), other.path()), (text.replace("9.81", "9.8"), folder.path())] {
            let refused = run.start_in(&text, folder).restore(&kept).unwrap_err().to_string();
            assert!(refused.contains("systems"), "{refused}");
        }
    }
}

/// A spring f = −k m u on every node raises ω² of the bodies by k at most; its norm is √3 k. The step that follows is
/// stable, and that of the bodies alone is not.
#[test]
fn stiffness_of_a_load_makes_the_step_smaller() {
    let folder = folder(&[
        ("spring.wgsl", "fn spring(node: Node) -> vec3f { return -1e6 * node.mass * node.displacement; }"),
        ("push.wgsl", "fn push(node: Node) -> vec3f { return vec3f(node.mass, 0, 0); }"),
    ]);
    let bar = |systems: &str| {
        bar(&format!("systems: {{\"push\": (file: \"push.wgsl\"), {systems}}}, guards: (off: [Energy])"))
            .replace("integration: (step: 0.002),", "integration: (bound: Elements),")
    };
    let run = &configurations()[0];
    let start = |systems: &str| run.start_in(&bar(systems), folder.path());
    let stable = |simulation: &mut Simulation| simulation.summary("").unwrap().stability.stable_step;
    let (mut alone, mut held) = (start(""), start("\"spring\": (file: \"spring.wgsl\")"));
    let bodies = stable(&mut alone);
    let expected = 2.0 / (4.0 / (bodies * bodies) + 3.0_f64.sqrt() * 1e6).sqrt();
    assert!(expected < 0.5 * bodies, "{bodies} s");
    near("stable step", stable(&mut held), expected, expected, 1e-6);
    assert!(held.summary("").unwrap().stability.because.contains("forces on nodes make"));
    held.advance(2000).unwrap();
    let largest =
        |simulation: &mut Simulation| displacements(simulation).iter().map(|u| u.length()).fold(0.0, f64::max);
    // the prescribed end moves by 0.02
    assert!(largest(&mut held) < 0.021, "{}", largest(&mut held));
    let beyond = bar("\"spring\": (file: \"spring.wgsl\")")
        .replace("bound: Elements", &format!("step: {}, beyond_stable_step: true", 0.9 * bodies))
        .replace(", guards: (off: [Energy])", "");
    let mut beyond = run.start_in(&beyond, folder.path());
    assert!(beyond.advance(2000).is_err() || largest(&mut beyond) > 1.0);
}

/// At rest under its own weight in a static analysis, where loads grow with their curves and nothing has a velocity.
#[test]
fn a_body_comes_to_rest_under_a_load_of_the_scene() {
    let folder = folder(&[(
        "fall.wgsl",
        "fn fall(node: Node) -> vec3f { return node.curve * vec3f(0, 0, -1) * node.mass + 1e9 * node.velocity; }",
    )]);
    let at_rest = |more: &str| bar(more).replace("integration: (step: 0.002),", "analysis: Static(at: 1),");
    for run in cpu_and_long_gpu() {
        let [found, expected] =
            ["systems: {\"fall\": (file: \"fall.wgsl\")}", "loads: [Gravity(acceleration: (0, 0, -1))]"].map(|load| {
                let mut simulation = run.start_in(&at_rest(load), folder.path());
                simulation.finish().unwrap_or_else(|error| panic!("{}: {error}", run.name));
                displacements(&mut simulation)
            });
        let error = apart(&found, &expected);
        // in f32 a residual of 1e-5 of the loads may end the search elsewhere
        assert!(error <= run.bound(1e-9, 1e-3), "{}: {error:e}", run.name);
    }
}

/// Work of a load is that of external forces: what falls turns it into motion, and the balance holds.
#[test]
fn work_of_a_load_is_booked_as_that_of_external_forces() {
    let folder = folder(&[("fall.wgsl", FALL), ("drag.wgsl", DRAG)]);
    for run in cpu_and_long_gpu() {
        let text = bar(&format!("{GUSTS} output: (energies_every: 0.01), guards: (every: 16)"));
        let mut simulation = run.start_in(&text, folder.path());
        simulation.advance(200).unwrap_or_else(|error| panic!("{}: {error}", run.name));
        let e = simulation.energies().unwrap();
        let (loads, held) = (e.load_work.unwrap(), e.constraint_work.unwrap());
        let made = e.kinetic + e.strain + e.hourglass + e.damping_loss.unwrap() - loads - held;
        assert!(loads > 1.0 && made.abs() < run.bound(0.01, 0.02) * loads, "{}: {made} J of {e:?}", run.name);
    }
}
