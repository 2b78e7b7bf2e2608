//! Copies of a body go their own ways: each as the body would by itself under its own load and with its own material,
//! to the rounding of sums in another order (1e-11 of the largest displacement in f64, 1e-4 in f32, after 300 steps).

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu};
use crate::element_turns::with_elements;
use glam::DVec3;
use sinew::{Error, Simulation};

fn end(run: &Configuration, elements: &str, copies: &str, load: &str) -> Vec<DVec3> {
    let mut simulation = run.start(&format!(
        "(duration: 10, bodies: {{\"b\": (mesh: Cylinder(radius: 0.01, height: 0.03, across: 4, along: 6, elements: {elements}),
            material: \"m\", {copies})}},
        materials: {{\"m\": (density: 1000, damping: 5, neo_hookean: Young(young: 3e3, poisson: 0.45),
            fibres: (eta: 500, direction: Along(0, 1, 2)), prony: (terms: [(alpha: 0.4, tau: 0.05)]))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], loads: [{load}], integration: (step: 1e-4))"
    ));
    simulation.advance(300).unwrap_or_else(|error| panic!("{error}"));
    simulation.displacements("b").unwrap()
}

fn load(force: f64, more: &str) -> String {
    format!(
        "NodalForce(on: Plane(normal: (0, 0, 1), at: 0.03), force: ({force}, 0, {force}), share: Total, {more} curve: Ramp(end: 0.02))"
    )
}

#[test]
#[ignore = "long"]
fn copies_do_what_the_body_does_by_itself() {
    let runs = configurations();
    for (run, elements) in with_elements(&runs, 0) {
        let by_itself = [(0, -1.0), (2, 0.0), (3, 0.5), (4, 1.0)]
            .map(|(copy, factor)| (copy, end(run, elements, "", &load(0.01 * factor, ""))));
        // at the same place and apart, along x, so that the plane picks the ends of all
        for apart in ["", "apart: (0.05, 0, 0)"] {
            let many = end(run, elements, &format!("copies: 5, {apart}"), &load(0.01, "per_copy: Linear(-1, 1),"));
            let nodes = many.len() / 5;
            let largest = many.iter().map(|u| u.length()).fold(0.0, f64::max);
            for (copy, one) in &by_itself {
                assert_eq!(one.len(), nodes);
                let own = &many[copy * nodes..(copy + 1) * nodes];
                let off = own.iter().zip(one).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / largest;
                assert!(largest > 1e-4 && off <= run.bound(1e-11, 1e-4), "{} {elements} {copy}: {off:e}", run.name);
            }
        }
    }
}

/// Young's modulus (Pa), η of fibres (Pa), k₁ (Pa) and k₂ of a family, of each of three copies.
const PARAMETERS: [[f64; 4]; 3] = [[3e3, 500.0, 200.0, 1.0], [8e3, 100.0, 900.0, 0.2], [1e3, 2e3, 50.0, 3.0]];

/// Pieces of a body of two materials, with so many copies; the parameters of the first material are those given.
fn of_parameters([young, eta, k1, k2]: [f64; 4], body: &str, solver: &str) -> String {
    format!(
        "(duration: 10, {solver}
        bodies: {{\"b\": (mesh: Cylinder(radius: 0.01, height: 0.03, across: 4, along: 6, elements: ELEMENTS),
            material: \"m\", regions: [(on: Box(min: (-1, -1, 0.02), max: (1, 1, 1)), material: \"top\")], {body})}},
        materials: {{\"m\": (density: 1000, damping: 5, neo_hookean: Young(young: {young}, poisson: 0.4),
            fibres: (eta: {eta}, direction: Around(axis: (0, 0, 1))),
            exponential_fibres: [(k1: 0, k2: 1, direction: Along(1, 0, 0)), (k1: {k1}, k2: {k2}, direction: Along(0, 1, 2))],
            prony: (terms: [(alpha: 0.4, tau: 0.05)])),
            \"top\": (density: 1100, ogden: (terms: [(mu: 900, alpha: 2.5)], bulk: 9e3))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        loads: [{}])",
        load(0.02, "")
    )
}

/// `per_copy` with the parameters of all copies.
fn per_copy() -> String {
    let of = |k: usize| PARAMETERS.map(|parameters| parameters[k].to_string()).join(", ");
    format!(
        "per_copy: {{\"m.neo_hookean.young\": Values([{}]), \"m.fibres.eta\": Values([{}]),
            \"m.exponential_fibres[1].k1\": Values([{}]), \"m.exponential_fibres[1].k2\": Values([{}])}},",
        of(0),
        of(1),
        of(2),
        of(3)
    )
}

fn started(run: &Configuration, elements: &str, text: &str) -> Simulation {
    run.start(&text.replace("ELEMENTS", elements))
}

/// Each copy ends where the body with its parameters ends by itself.
fn each_goes_as_by_itself(run: &Configuration, elements: &str, solver: &str, bound: f64) {
    let copies = format!("copies: 3, {}", per_copy());
    let steps = if solver.contains("Implicit") { 6 } else { 300 };
    let end = |text: &str| {
        let mut simulation = started(run, elements, text);
        simulation.advance(steps).unwrap_or_else(|error| panic!("{} {elements}: {error}", run.name));
        simulation.displacements("b").unwrap()
    };
    let many = end(&of_parameters([5e3, 1.0, 1.0, 1.0], &copies, solver));
    let nodes = many.len() / 3;
    let largest = many.iter().map(|u| u.length()).fold(0.0, f64::max);
    assert!(largest > 1e-4, "{largest}");
    for (copy, parameters) in PARAMETERS.into_iter().enumerate() {
        let one = end(&of_parameters(parameters, "", solver));
        let own = &many[copy * nodes..(copy + 1) * nodes];
        let off = own.iter().zip(&one).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / largest;
        assert!(off <= bound, "{} {elements} copy {copy}: {off:e}", run.name);
    }
}

const STEPS: &str = "integration: (step: 5e-5),";

#[test]
fn copies_of_materials_of_their_own_do_what_each_does_by_itself() {
    for run in cpu_and_long_gpu() {
        each_goes_as_by_itself(&run, "Tet4", STEPS, run.bound(1e-11, 1e-4));
    }
}

#[test]
#[ignore = "long"]
fn copies_of_materials_of_their_own_do_so_with_all_elements() {
    for (run, elements) in with_elements(&configurations(), 1) {
        each_goes_as_by_itself(run, elements, STEPS, run.bound(1e-11, 1e-4));
    }
}

/// Newton's iterations end within their tolerance of a step's motion, 1e-6, and another number of conjugate gradients
/// leaves another rest.
#[test]
fn copies_of_materials_of_their_own_step_implicitly() {
    for run in cpu_and_long_gpu() {
        let solver = "solver: Implicit(scheme: Euler, step: 0.01, tolerance: 1e-8),";
        each_goes_as_by_itself(&run, "Hex8", solver, run.bound(1e-5, 1e-3));
    }
}

/// The stable step is that of the stiffest copy by itself, whichever copy that is.
#[test]
fn the_stable_step_is_that_of_the_stiffest_copy() {
    for run in cpu_and_long_gpu() {
        let steps = PARAMETERS.map(|parameters| started(&run, "Tet4", &of_parameters(parameters, "", "")).time_step());
        let copies = format!("copies: 3, {}", per_copy());
        let of_all = started(&run, "Tet4", &of_parameters([5e3, 1.0, 1.0, 1.0], &copies, "")).time_step();
        let least = steps.into_iter().fold(f64::INFINITY, f64::min);
        assert!(steps[1] < 0.9 * steps[0].min(steps[2]), "{steps:?}");
        assert!((of_all / least - 1.0).abs() < 0.02, "{}: {of_all} s of {steps:?} s", run.name);
    }
}

/// Energies of all copies are the sum of each one's; so is what guards see of them.
#[test]
fn energies_are_those_of_each_copy_together() {
    for run in cpu_and_long_gpu() {
        let text = |parameters, body: &str| {
            let scene = of_parameters(parameters, body, "integration: (step: 5e-5), guards: (every: 50),");
            scene.replace("(duration: 10,", "(duration: 10, output: (energies_every: 0.005),")
        };
        let strain = |text: &str| {
            let mut simulation = started(&run, "Hex8MeanDilatation", text);
            simulation.advance(300).unwrap_or_else(|error| panic!("{}: {error}", run.name));
            assert!(simulation.guards().imbalance.abs() < 0.01, "{}: {:?}", run.name, simulation.guards());
            simulation.energies().unwrap().strain
        };
        let copies = format!("copies: 3, {}", per_copy());
        let all = strain(&text([5e3, 1.0, 1.0, 1.0], &copies));
        let sum: f64 = PARAMETERS.into_iter().map(|parameters| strain(&text(parameters, ""))).sum();
        assert!((all / sum - 1.0).abs() < run.bound(1e-10, 1e-3), "{}: {all} J of {sum} J", run.name);
    }
}

/// What differs from copy to copy may change while it runs, and is then as if it had been so: in the same bits.
#[test]
fn parameters_of_copies_change_while_it_runs() {
    for run in cpu_and_long_gpu() {
        let copies = format!("copies: 3, {}", per_copy());
        let text = of_parameters([5e3, 1.0, 1.0, 1.0], &copies, "integration: (step: 2e-5, bound: Elements),");
        let other = "Values([9000, 2000, 4000])";
        let changed = text.replace("Values([3000, 8000, 1000])", other);
        assert!(changed != text);
        let end = |mut simulation: Simulation| {
            simulation.advance(100).unwrap_or_else(|error| panic!("{}: {error}", run.name));
            simulation.displacements("b").unwrap()
        };
        let mut set = started(&run, "Hex8", &text);
        let first = end(started(&run, "Hex8", &text));
        set.change(&[format!("bodies.b.per_copy.\"m.neo_hookean.young\"={other}")]).unwrap();
        let kept = set.snapshot().unwrap();
        let (found, expected) = (end(set), end(started(&run, "Hex8", &changed)));
        assert!(found == expected && found != first, "{}", run.name);
        let mut resumed = started(&run, "Hex8", &text);
        resumed.restore(&kept).unwrap();
        assert!(end(resumed) == expected, "{}: from a snapshot", run.name);
        // the parameters that are the same in all copies go on being changed as they were
        let mut of_all = started(&run, "Hex8", &text);
        of_all.change(&["materials.m.neo_hookean=Young(young: 5e3, poisson: 0.2)".into()]).unwrap();
        let so = end(started(&run, "Hex8", &text.replace("poisson: 0.4", "poisson: 0.2")));
        assert!(end(of_all) == so && so != first, "{}: of all", run.name);
        // what differs stays what does
        let refused = started(&run, "Hex8", &text).change(&["bodies.b.per_copy={}".into()]);
        assert!(matches!(refused, Err(Error::Scene(_))), "{}: {refused:?}", run.name);
    }
}

/// Loads on faces and prescribed motion in copies whose factors differ: each as by itself, under so much.
#[test]
fn loads_and_motion_differ_from_copy_to_copy() {
    const FACTORS: [f64; 3] = [1.0, -0.5, 2.0];
    for run in cpu_and_long_gpu() {
        for elements in ["Tet4", "Tet10"] {
            let end = |copies: &str, factors: [f64; 2], per_copy: &str| {
                let [pressure, moved] = [200.0 * factors[0], 1e-3 * factors[1]];
                let mut simulation = run.start(&format!(
                    "(duration: 10, bodies: {{\"b\": (mesh: Box(size: (0.03, 0.03, 0.06), cells: (2, 2, 3), elements: {elements}),
                        material: \"m\", {copies})}},
                    materials: {{\"m\": (density: 1000, damping: 5, neo_hookean: Young(young: 3e3, poisson: 0.4))}},
                    constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
                        Prescribed(on: Plane(normal: (0, 0, 1), at: 0.06), displacement: (0, 0, {moved}),
                            gradient: ((0, 0, 0), (0, 0, 0), ({moved}, 0, 0)), axes: [Z], {per_copy} curve: Ramp(end: 0.02))],
                    loads: [Pressure(on: Surface(normal: (1, 0, 0)), pressure: {pressure}, {per_copy} curve: Ramp(end: 0.02)),
                        Traction(on: Surface(normal: (0, 1, 0)), traction: (0, {pressure}, 20), {per_copy} curve: Ramp(end: 0.02))],
                    integration: (step: 1e-4))"
                ));
                simulation.advance(300).unwrap_or_else(|error| panic!("{}: {error}", run.name));
                simulation.displacements("b").unwrap()
            };
            let many = end("copies: 3", [1.0, 1.0], "per_copy: Values([1, -0.5, 2]),");
            let nodes = many.len() / 3;
            let largest = many.iter().map(|u| u.length()).fold(0.0, f64::max);
            assert!(largest > 1e-3, "{largest}");
            for (copy, factor) in FACTORS.into_iter().enumerate() {
                // the traction along z, too
                let one = end("copies: 2", [1.0, 1.0], &format!("per_copy: Values([{factor}, 0]),"));
                let own = &many[copy * nodes..(copy + 1) * nodes];
                let off = own.iter().zip(&one).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / largest;
                assert!(off <= run.bound(1e-11, 1e-4), "{} {elements} copy {copy}: {off:e}", run.name);
                assert!(one[nodes..].iter().all(|u| u.length() == 0.0), "{}: nothing moves the other copy", run.name);
            }
            // what is multiplied with 1 is what it is without copies
            let plain = end("", [1.0, 1.0], "");
            let off = plain.iter().zip(&many).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / largest;
            assert!(off <= run.bound(1e-11, 1e-4), "{} {elements}: {off:e}", run.name);
        }
    }
}

/// Elements that go one after the other go alike in all copies, from the middle of each, as those of the body by
/// itself.
#[test]
fn elements_of_all_copies_go_alike() {
    for run in cpu_and_long_gpu() {
        for elements in ["Hex8", "Tet4"] {
            let [mut one, mut many] = ["", "copies: 3, apart: (0.03, 0, 0)"].map(|copies| {
                run.start(&format!(
                    "(duration: 1, integration: (step: 2e-4),
                    bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3), elements: {elements}),
                        material: \"m\", {copies})}},
                    materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))}},
                    removal: [(on: Not(Box(min: (-1, -1, -1), max: (1, 1, 0.003))),
                        when: During(start: 0.002, end: 0.012))])"
                ))
            });
            for step in [20, 35, 50, 60] {
                one.advance(step - one.step_count()).unwrap();
                many.advance(step - many.step_count()).unwrap();
                let (one, many) = (one.fields("b").unwrap().alive, many.fields("b").unwrap().alive);
                let gone = one.iter().filter(|alive| **alive == 0).count();
                // two thirds of them may go
                let all = 2 * one.len() / 3;
                assert!(gone > 0 && (gone == all) == (step == 60), "{}, {elements}: {gone} in step {step}", run.name);
                for (copy, own) in many.chunks(one.len()).enumerate() {
                    assert!(own == one, "{}, {elements}: copy {copy} in step {step}", run.name);
                }
            }
        }
    }
}

/// What is drawn lies where it should, is the same again, and has nothing to do with what is drawn elsewhere.
#[test]
fn draws_are_the_same_in_every_run_and_independent() {
    use sinew::scene::schema::PerCopy;
    let uniform = |seed| PerCopy::Uniform { from: -1.0, to: 1.0, seed };
    let [one, again, other, seeded] =
        [("a", 0), ("a", 0), ("b", 0), ("a", 1)].map(|(name, seed)| uniform(seed).values(name, 4000));
    let of = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>() / x.len() as f64;
    assert_eq!(one, again);
    // uniform on (-1, 1): a mean of squares of 1/3; means of 4000 products lie within 5 deviations, those of squares of
    // 0.3/√4000, of two draws of 1/3 over √4000
    assert!((of(&one, &one) - 1.0 / 3.0).abs() < 5.0 * 0.3 / 4000_f64.sqrt(), "{}", of(&one, &one));
    for others in [&other, &seeded] {
        assert!(of(&one, others).abs() < 5.0 / 3.0 / 4000_f64.sqrt(), "{}", of(&one, others));
    }
    // as many below the geometric mean as above, to 5 deviations of ½√4000
    let drawn = PerCopy::LogUniform { from: 1.0, to: 1e4, seed: 0 }.values("a", 4000);
    assert!(drawn.iter().all(|x| (1.0..=1e4).contains(x)));
    let below = drawn.iter().filter(|x| **x < 100.0).count() as f64;
    assert!((below - 2000.0).abs() < 2.5 * 4000_f64.sqrt(), "{below}");
    assert_eq!(PerCopy::Linear(1.0, 3.0).values("", 5), [1.0, 1.5, 2.0, 2.5, 3.0]);
}

/// The step follows the copy that stiffens most, which is not the stiffest one at rest: its fibres stiffen
/// exponentially as all are pulled alike.
#[test]
fn the_step_follows_the_copy_that_stiffens_most() {
    for run in cpu_and_long_gpu() {
        let [followed, without] = ["8", "0.1"].map(|k2| {
            let mut simulation = run.start(&format!(
                "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.04), cells: (2, 2, 4), elements: Tet4),
                    material: \"m\", copies: 3, per_copy: {{\"m.neo_hookean.young\": Values([3e3, 6e3, 1e3]),
                        \"m.exponential_fibres[0].k2\": Values([0.1, 0.1, {k2}])}})}},
                materials: {{\"m\": (density: 1000, damping: 50, neo_hookean: Young(young: 3e3, poisson: 0.4),
                    exponential_fibres: [(k1: 300, k2: 1, direction: Along(0, 0, 1))])}},
                constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
                    Prescribed(on: Plane(normal: (0, 0, 1), at: 0.04), displacement: (0, 0, 0.02), curve: Smooth(end: 0.2))])"
            ));
            simulation.advance_to(0.25).unwrap_or_else(|error| panic!("{}: {error}", run.name));
            let (step, limit) = (simulation.time_step(), simulation.stable_limit().unwrap().unwrap());
            assert!(step <= limit, "{}: {step} s of {limit} s", run.name);
            assert!(simulation.guards().imbalance.abs() < 0.01, "{}: {:?}", run.name, simulation.guards());
            limit
        });
        assert!(followed < 0.9 * without, "{}: {followed} s, without it {without} s", run.name);
    }
}
