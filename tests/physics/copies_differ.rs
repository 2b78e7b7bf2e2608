//! Copies that differ in where fibres run, in density, damping and viscosity, and in the directions of loads and
//! motions: each as the body would be by itself, to the rounding of sums in another order (1e-11 of the largest
//! displacement in f64, 1e-4 in f32).

use crate::configurations::{Configuration, configurations, near};
use glam::DVec3;
use sinew::scene::schema::PerCopy;
use sinew::{Error, Simulation};

/// A scene: what differs, in the numbers of one copy, and the pieces that say so of all copies.
struct Case {
    scene: fn([f64; 8]) -> String,
    per_copy: fn() -> String,
}

/// Of three copies: x and z of the direction of quadratic fibres, y of an axis that others run around; density (kg/m³);
/// damping (1/s); time of stiffness-proportional damping (s); share and time (s) of a term.
const MATERIALS: [[f64; 8]; 3] = [
    [1.0, 0.5, 0.3, 1000.0, 5.0, 2e-4, 0.4, 0.05],
    [-0.2, 2.0, 0.0, 400.0, 0.0, 0.0, 0.1, 0.002],
    [0.0, -1.0, -0.8, 1900.0, 40.0, 1e-3, 0.6, 0.5],
];

/// A number for each copy.
fn values(numbers: &[[f64; 8]; 3], k: usize) -> String {
    let numbers = numbers.map(|of_copy| format!("{:?}", of_copy[k]));
    format!("Values([{}])", numbers.join(", "))
}

fn per_copy_of_materials() -> String {
    let places = [
        "fibres.direction[0]",
        "fibres.direction[2]",
        "exponential_fibres[1].direction.axis[1]",
        "density",
        "damping",
        "stiffness_damping",
        "prony.terms[1].alpha",
        "prony.terms[1].tau",
    ];
    let of = |(k, place): (usize, &&str)| format!("\"m.{place}\": {}", values(&MATERIALS, k));
    let volumetric = "\"m.prony.volumetric[0].tau\": Values([0.05, 0.002, 0.5])".to_string();
    places.iter().enumerate().map(of).chain([volumetric]).collect::<Vec<_>>().join(", ")
}

/// Two materials, of which one is the one that differs; families and terms of no weight come before those that do.
fn of_materials([x, z, axis, density, damping, rate, alpha, tau]: [f64; 8]) -> String {
    format!(
        "(duration: 10, SETTINGS
        bodies: {{\"b\": (mesh: Cylinder(radius: 0.01, height: 0.03, across: 4, along: 6, elements: ELEMENTS),
            material: \"m\", regions: [(on: Box(min: (-1, -1, 0.02), max: (1, 1, 1)), material: \"top\")], COPIES)}},
        materials: {{\"m\": (density: {density}, damping: {damping}, stiffness_damping: {rate},
            neo_hookean: Young(young: 3e3, poisson: 0.4),
            fibres: (eta: 500, direction: Along({x}, 0.1, {z})),
            exponential_fibres: [(k1: 0, k2: 1, direction: Along(1, 0, 0)),
                (k1: 200, k2: 1, direction: Around(axis: (0.2, {axis}, 1)))],
            prony: (terms: [(alpha: 0, tau: 1), (alpha: {alpha}, tau: {tau}), (alpha: 0.1, tau: 0.1)],
                volumetric: [(alpha: 0.2, tau: {tau})])),
            \"top\": (density: 1100, damping: 3, ogden: (terms: [(mu: 900, alpha: 2.5)], bulk: 9e3))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        loads: [NodalForce(on: Plane(normal: (0, 0, 1), at: 0.03), force: (0.02, 0, 0.02), share: Total, curve: Ramp(end: 0.02)),
            Gravity(body: \"b\", acceleration: (0, 3, -9.81))])"
    )
}

/// Factors of three copies: of a force, of a traction along z, of gravity along y, and of a motion along x and y.
const ACTIONS: [[f64; 8]; 3] = [
    [1.0, -0.5, 2.0, 0.3, -4.0, 1.0, 0.2, 0.0],
    [0.0, 1.5, 0.5, -1.0, 2.0, 0.0, -1.0, 0.5],
    [-1.0, 0.0, -0.7, 2.0, 0.0, -0.6, 0.4, 0.0],
];

/// Loads and a motion whose components are those numbers, or the ones that they multiply.
fn of_actions(n: [f64; 8]) -> String {
    format!(
        "(duration: 10, SETTINGS
        bodies: {{\"b\": (mesh: Box(size: (0.03, 0.03, 0.06), cells: (2, 2, 3), elements: ELEMENTS), material: \"m\", COPIES),
            \"still\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (1, 1, 1)), material: \"m\")}},
        materials: {{\"m\": (density: 1000, damping: 5, neo_hookean: Young(young: 3e3, poisson: 0.4))}},
        constraints: [Fixed(body: \"b\", on: Plane(normal: (0, 0, 1), at: 0)),
            Prescribed(body: \"b\", on: Plane(normal: (0, 0, 1), at: 0.06), axes: [X, Y], displacement: ({}, {}, 0),
                gradient: (({}, 0, 0), (0, 0, {}), (0, 0, 0)), MOTION curve: Ramp(end: 0.02))],
        loads: [NodalForce(body: \"b\", on: Plane(normal: (0, 0, 1), at: 0.04), force: ({}, {}, {}), share: Total, FORCE
                curve: Ramp(end: 0.02)),
            Traction(body: \"b\", on: Surface(normal: (0, 1, 0)), traction: (20, 30, {}), TRACTION curve: Ramp(end: 0.02)),
            Gravity(body: \"b\", acceleration: (1, {}, -2), GRAVITY)])",
        1e-3 * n[5],
        1e-3 * n[6],
        0.02 * n[5],
        0.02 * n[6],
        0.01 * n[0],
        0.02 * n[1],
        0.03 * n[2],
        50.0 * n[3],
        9.0 * n[4],
    )
}

/// The text with what differs in place of its words, or with none of it.
fn written(text: String, all: bool) -> String {
    let axes = |k: [&str; 3]| format!("per_copy: Axes(x: {}, y: {}, z: {}),", k[0], k[1], k[2]);
    let one = "Values([1, 1, 1])";
    let v = |k| values(&ACTIONS, k);
    let places = [
        ("FORCE", axes([&v(0), &v(1), &v(2)])),
        ("TRACTION", axes([one, one, &v(3)])),
        ("GRAVITY", axes([one, &v(4), "Linear(1, 1)"])),
        ("MOTION", axes([&v(5), &v(6), one])),
    ];
    places.iter().fold(text, |text, (word, per_copy)| text.replace(word, if all { per_copy } else { "" }))
}

const CASES: [Case; 2] = [
    Case { scene: of_materials, per_copy: || format!("per_copy: {{{}}}", per_copy_of_materials()) },
    Case { scene: of_actions, per_copy: String::new },
];

impl Case {
    fn numbers(&self) -> [[f64; 8]; 3] {
        if (self.per_copy)().is_empty() { ACTIONS } else { MATERIALS }
    }

    /// All copies in one body.
    fn of_all(&self, elements: &str, settings: &str) -> String {
        let first = if (self.per_copy)().is_empty() { [1.0; 8] } else { self.numbers()[0] };
        let text = written((self.scene)(first), true).replace("COPIES", &format!("copies: 3, {}", (self.per_copy)()));
        text.replace("ELEMENTS", elements).replace("SETTINGS", settings)
    }

    /// A copy by itself.
    fn alone(&self, copy: usize, elements: &str, settings: &str) -> String {
        let text = written((self.scene)(self.numbers()[copy]), false).replace("COPIES", "");
        text.replace("ELEMENTS", elements).replace("SETTINGS", settings)
    }
}

/// Displacements of the body after so many steps, and as many of another length.
fn end(mut simulation: Simulation, steps: [u64; 2], other_step: f64, name: &str) -> Vec<DVec3> {
    simulation.advance(steps[0]).unwrap_or_else(|error| panic!("{name}: {error}"));
    if steps[1] > 0 {
        simulation.set_time_step(other_step).unwrap();
        simulation.advance(steps[1]).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    simulation.displacements("b").unwrap()
}

/// Each copy ends where it ends by itself.
fn each_goes_as_by_itself(run: &Configuration, case: &Case, elements: &str, settings: &str, bound: f64) {
    let steps = if settings.contains("Implicit") { [6, 0] } else { [200, 100] };
    let end = |text: &str| end(run.start(text), steps, 3e-5, run.name);
    let many = end(&case.of_all(elements, settings));
    let nodes = many.len() / 3;
    let largest = many.iter().map(|u| u.length()).fold(0.0, f64::max);
    assert!(largest > 1e-4, "{largest}");
    for copy in 0..3 {
        let one = end(&case.alone(copy, elements, settings));
        assert_eq!(one.len(), nodes);
        let own = &many[copy * nodes..(copy + 1) * nodes];
        let off = own.iter().zip(&one).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / largest;
        println!("{} {elements} copy {copy}: {off:e} of {bound:e}", run.name);
        assert!(off <= bound, "{} {elements} copy {copy}: {off:e}", run.name);
    }
}

const STEPS: &str = "integration: (step: 5e-5),";

#[test]
#[ignore = "long"]
fn copies_that_differ_in_all_do_what_each_does_by_itself() {
    for run in configurations() {
        for case in &CASES {
            each_goes_as_by_itself(&run, case, "Tet4", STEPS, run.bound(1e-11, 1e-4));
        }
    }
}

#[test]
#[ignore = "long"]
fn copies_that_differ_do_so_with_all_elements() {
    for run in configurations() {
        for elements in ["Tet4NodalPressure", "Hex8", "Hex8MeanDilatation", "Wedge6", "Tet10"] {
            for case in &CASES {
                each_goes_as_by_itself(&run, case, elements, STEPS, run.bound(1e-11, 1e-4));
            }
        }
    }
}

/// Newton's iterations end within their tolerance of a step's motion: see `copies`.
#[test]
#[ignore = "long"]
fn copies_that_differ_step_implicitly() {
    for run in configurations() {
        let solver = "solver: Implicit(scheme: Euler, step: 0.01, tolerance: 1e-8),";
        each_goes_as_by_itself(&run, &CASES[0], "Hex8", solver, run.bound(1e-5, 1e-3));
    }
}

/// The stable step is that of the copy that needs the smallest, by itself. With damping proportional to stiffness that
/// holds of elements' bounds; the frequency of all is taken with the largest time of all copies, which is safe.
#[test]
fn the_stable_step_is_that_of_the_quickest_copy() {
    let case = &CASES[0];
    for run in configurations() {
        for bound in ["Elements", "Auto"] {
            let settings = format!("integration: (bound: {bound}),");
            let alone = [0, 1, 2].map(|copy| run.start(&case.alone(copy, "Tet4", &settings)).time_step());
            let least = alone.into_iter().fold(f64::INFINITY, f64::min);
            assert!(least < 0.9 * alone[0], "{alone:?}");
            let found = run.start(&case.of_all("Tet4", &settings)).time_step();
            assert!(found <= 1.02 * least && (bound == "Auto" || found >= 0.98 * least), "{found} of {alone:?}");
        }
        // in frames of edges each element has a law of its own beside
        let frames = "corotational: Young(young: 3e3, poisson: 0.4, rotation: Frame)";
        for law in ["neo_hookean: Young(young: 3e3, poisson: 0.4)", frames] {
            let step = |density: &str, copies: &str| {
                let simulation = run.start(&format!(
                    "(duration: 10, bodies: {{\"b\": (mesh: Box(size: (0.03, 0.03, 0.06), cells: (2, 2, 3)), material: \"m\", {copies})}},
                    materials: {{\"m\": (density: {density}, {law})}})"
                ));
                simulation.time_step()
            };
            let all = step("1000", "copies: 3, per_copy: {\"m.density\": Values([1000, 400, 1900])}");
            near(run.name, all, step("400", ""), all, 0.02);
        }
    }
}

/// Nodes of each copy weigh what they weigh by themselves, and elements hold and lose what they do.
#[test]
fn masses_and_energies_are_those_of_each_copy() {
    for run in configurations() {
        // without compensated sums, for which a GPU's kernel has no buffer left
        let settings =
            "integration: (step: 5e-5, compensated: false), output: (energies_every: 0.005), guards: (every: 50),";
        let case = &CASES[0];
        let of = |text: &str| {
            let mut simulation = run.start(text);
            let masses = simulation.masses("b").unwrap();
            simulation.advance(200).unwrap_or_else(|error| panic!("{}: {error}", run.name));
            assert!(simulation.guards().imbalance.abs() < 0.01, "{}: {:?}", run.name, simulation.guards());
            let energies = simulation.energies().unwrap();
            (masses, [energies.kinetic, energies.strain])
        };
        let (masses, all) = of(&case.of_all("Hex8", settings));
        let each = [0, 1, 2].map(|copy| of(&case.alone(copy, "Hex8", settings)));
        let largest = masses.iter().copied().fold(0.0, f64::max);
        let off = masses.iter().zip(each.iter().flat_map(|(masses, _)| masses)).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) <= run.bound(1e-14, 1e-6) * largest, "{}", run.name);
        for k in 0..2 {
            let sum = each.iter().map(|(_, energies)| energies[k]).sum::<f64>();
            near(run.name, all[k], sum, sum, run.bound(1e-10, 1e-3));
        }
    }
}

/// Numbers of the law may go on changing while it runs, beside viscosity that differs; what else differs may not.
#[test]
fn only_laws_of_copies_change_while_they_run() {
    for run in configurations() {
        let case = &CASES[0];
        let settings = "integration: (step: 2e-5, bound: Elements),";
        let with = |young: &str| {
            let law = format!("per_copy: {{\"m.neo_hookean.young\": {young},");
            case.of_all("Hex8", settings).replace("per_copy: {", &law)
        };
        let text = with("Values([3000, 2000, 4000])");
        let end = |mut simulation: Simulation| {
            simulation.advance(100).unwrap_or_else(|error| panic!("{}: {error}", run.name));
            simulation.displacements("b").unwrap()
        };
        let mut set = run.start(&text);
        set.change(&["bodies.b.per_copy.\"m.neo_hookean.young\"=Linear(2000, 1000)".into()]).unwrap();
        let first = end(run.start(&text));
        assert!(end(set) == end(run.start(&with("Linear(2000, 1000)"))), "{}", run.name);
        for place in ["density", "prony.terms[1].tau", "fibres.direction[0]"] {
            let sets = [format!("bodies.b.per_copy.\"m.{place}\"=Values([1, 2, 3])")];
            let mut simulation = run.start(&text);
            let refused = simulation.change(&sets);
            assert!(matches!(refused, Err(Error::Scene(_))), "{}: {place}: {refused:?}", run.name);
            assert!(end(simulation) == first, "{}: {place}", run.name);
        }
    }
}

/// Directions have the length 1, and each is as likely as any other: means of components over n draws are 0 within 5
/// deviations of √(1/3n), of products of two components δ/3 within 5 of √(4/45n) at most.
#[test]
fn each_direction_is_as_likely_as_any_other() {
    let count = 4000;
    let drawn = PerCopy::Directions { seed: 3 }.vectors("a", count);
    assert_eq!(drawn, PerCopy::Directions { seed: 3 }.vectors("a", count));
    assert!(drawn != PerCopy::Directions { seed: 4 }.vectors("a", count));
    let n = count as f64;
    assert!(drawn.iter().all(|unit| (unit.length() - 1.0).abs() < 1e-15 * 4.0));
    for i in 0..3 {
        let mean = drawn.iter().map(|unit| unit[i]).sum::<f64>() / n;
        assert!(mean.abs() < 5.0 * (1.0 / (3.0 * n)).sqrt(), "{i}: {mean}");
        for k in 0..3 {
            let product = drawn.iter().map(|unit| unit[i] * unit[k]).sum::<f64>() / n;
            let expected = if i == k { 1.0 / 3.0 } else { 0.0 };
            assert!((product - expected).abs() < 5.0 * (4.0 / (45.0 * n)).sqrt(), "{i} {k}: {product}");
        }
    }
}
