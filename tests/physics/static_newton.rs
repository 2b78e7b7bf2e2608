//! Equilibrium by Newton's iterations: against closed forms, other programs and dynamic relaxation, to residuals that
//! this does not reach; and what is said where there is none, or none that lasts.

use crate::configurations::{near, scene_of};
use crate::implicit::options;
use glam::DVec3;
use sinew::components::Precision;
use sinew::{Error, Options, Simulation};
use std::path::Path;

fn start(scene: &str, precision: Precision) -> Simulation {
    Simulation::new(&scene_of(scene, Path::new(".")), &options(precision, 1)).unwrap()
}

/// Finds rest; where nodes are then, and the simulation.
fn rest(scene: &str, precision: Precision) -> (Vec<DVec3>, Simulation) {
    let mut simulation = start(scene, precision);
    simulation.finish().unwrap();
    let found = simulation.equilibrium().unwrap();
    println!("{} steps, {found:?}\n{:?}", simulation.step_count(), simulation.implicit_steps());
    assert!(found.reached);
    (simulation.displacements("b").unwrap(), simulation)
}

/// Of two fields the largest distance, as a share of the largest displacement.
fn apart(one: &[DVec3], other: &[DVec3]) -> f64 {
    let largest = other.iter().map(|u| u.length()).fold(0.0, f64::max);
    one.iter().zip(other).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / largest
}

/// Two other finite element programs have the top of this cube at −2.625 mm.
#[test]
fn a_cube_rests_where_other_programs_have_it_to_ten_digits_of_its_load() {
    let (u, mut simulation) = rest(
        "(duration: 1, analysis: Static(method: Newton),
        bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (10, 10, 10), elements: Tet4), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], loads: [Gravity(acceleration: (0, 0, -2))])",
        Precision::F64,
    );
    let at = simulation.rest_positions("b").unwrap();
    let top: Vec<f64> = u.iter().zip(at).filter(|(_, at)| at.z > 0.0999).map(|(u, _)| u.z).collect();
    near("top", top.iter().sum::<f64>() / top.len() as f64, -2.6253e-3, 2.6253e-3, 1e-4);
    let (found, took) = (simulation.equilibrium().unwrap().clone(), simulation.implicit_steps().unwrap());
    assert!(found.residual < 1e-10 && found.newton_iterations > 0 && !found.unstable, "{found:?}");
    // dynamic relaxation takes 840 to 1e-5
    assert!(took.passes < 840, "{took:?}");
}

/// Squeezed by prescribed motion, fibres and pressure that follows, sagging bars: where relaxation has them.
#[test]
fn bodies_rest_where_relaxation_has_them() {
    let squeezed = "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: ELEMENT), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.49))},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)), Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), displacement: (0, 0, -0.03))])";
    let pressed = "mesh: Box(size: (0.1, 0.06, 0.05), cells: (5, 3, 3), elements: ELEMENT), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), fibres: (eta: 2000, direction: Along(1, 2, 3)), prony: (terms: [(alpha: 0.5, tau: 0.1)]))},
        constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))], loads: [Gravity(acceleration: (0, 0, -1)), Pressure(on: Surface(normal: (0, 0, 1)), pressure: 60)])";
    for (name, body) in [("squeezed", squeezed), ("pressed", pressed)] {
        for element in ["Tet4", "Tet4NodalPressure", "Hex8MeanDilatation"] {
            let scene = |analysis: &str| {
                format!("(duration: 1, analysis: {analysis}, bodies: {{\"b\": ({}", body.replace("ELEMENT", element))
            };
            println!("{name}, {element}");
            let (relaxed, _) = rest(&scene("Static(tolerance: 1e-8)"), Precision::F64);
            let (u, mut simulation) = rest(&scene("Static(method: Newton)"), Precision::F64);
            near("apart", apart(&u, &relaxed), 0.0, 1.0, 1e-6);
            let found = simulation.equilibrium().unwrap().clone();
            assert!(found.residual < 1e-9 && found.newton_iterations > 0 && !found.unstable, "{found:?}");
            let (u, _) = rest(&scene("Static(method: Newton)"), Precision::F32);
            near("apart in f32", apart(&u, &relaxed), 0.0, 1.0, 3e-3);
            drop(simulation.summary("finished").unwrap());
        }
    }
}

/// A column of side 1 cm and height 10 cm under P at its free end gives way at P = π² E I/(4 L²) = 6.17e-4 N.
fn column(share: f64) -> String {
    let critical = std::f64::consts::PI.powi(2) * 3e3 * 1e-8 / 12.0 / (4.0 * 0.01);
    format!(
        "(duration: 1, analysis: Static(method: Newton),
        bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.1), cells: (2, 2, 20), elements: Hex8), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        loads: [NodalForce(on: Plane(normal: (0, 0, 1), at: 0.1), force: (0, 0, {:?}), share: Total)])",
        -share * critical
    )
}

/// Whichever finds it: far beyond the load at which it buckles pseudo-steps do, which leave what is symmetric so.
#[test]
fn a_column_that_is_about_to_buckle_is_told_of() {
    for (share, buckles) in [(0.85, false), (0.98, false), (1.02, true), (1.15, true), (1.5, true)] {
        let (_, mut simulation) = rest(&column(share), Precision::F64);
        assert_eq!(simulation.equilibrium().unwrap().unstable, buckles, "{share}");
        let warned = simulation.summary("finished").unwrap().guards.warnings;
        assert_eq!(warned.iter().any(|notice| notice.criterion == "equilibrium"), buckles, "{warned:?}");
    }
}

/// Where all nodes are moved as told there is no motion that bodies might give way along.
#[test]
fn where_no_axis_is_free_nothing_gives_way() {
    let (_, mut simulation) = rest(
        "(duration: 1, analysis: Static(method: Newton),
        bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Hex8), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))},
        constraints: [Prescribed(on: All, gradient: ((0.1, 0, 0), (0, 0, 0), (0, 0, 0)))])",
        Precision::F64,
    );
    assert!(!simulation.equilibrium().unwrap().unstable);
    let warned = simulation.summary("finished").unwrap().guards.warnings;
    assert!(warned.is_empty(), "{warned:?}");
}

/// What is told of a block that is held so, under such loads.
fn told(constraints: &str, loads: &str) -> Result<(), Error> {
    let mut simulation = start(
        &format!(
            "(duration: 1, analysis: Static(method: Newton),
            bodies: {{\"b\": (mesh: Box(size: (0.1, 0.06, 0.05), cells: (5, 3, 3), elements: Tet4), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
            constraints: [{constraints}], loads: [{loads}])"
        ),
        Precision::F64,
    );
    let ended = simulation.finish();
    let u = simulation.displacements("b").unwrap();
    assert!(ended.is_ok() || u.iter().all(|u| u.length() < 1e-6), "it stands where it stood");
    ended
}

#[test]
fn what_loads_move_and_nothing_holds_is_named() {
    let on_a_plane = "Fixed(on: Plane(normal: (0, 0, 1), at: 0), axes: [Z])";
    let on_a_hinge = "Fixed(on: Box(min: (-1, -1, -1), max: (1e-6, 1e-6, 1)))";
    let pull = "Traction(on: Surface(normal: (1, 0, 0)), traction: (5, 0, 0))";
    let against = "Traction(on: Surface(normal: (-1, 0, 0)), traction: (-5, 0, 0))";
    for (constraints, loads, expected) in [
        (on_a_plane, pull.to_string(), vec!["body b moves along (1, 0, 0)"]),
        (on_a_plane, "Gravity(acceleration: (0, 0, -1))".into(), vec![]),
        (on_a_plane, format!("{pull}, {against}"), vec![]),
        ("", format!("{pull}, {against}"), vec![]),
        ("", "Gravity(acceleration: (0, 0, -1))".into(), vec!["body b moves along (0, 0, 1)"]),
        (on_a_hinge, "Gravity(acceleration: (0, -1, 0))".into(), vec!["body b turns about (0, 0, 1) through (0, 0, "]),
    ] {
        match told(constraints, &loads) {
            Ok(()) => assert!(expected.is_empty(), "{constraints}, {loads}: {expected:?}"),
            Err(error) => {
                let text = error.to_string();
                println!("{text}");
                assert!(!expected.is_empty() && text.contains("nothing holds"), "{constraints}, {loads}: {text}");
                assert!(expected.iter().all(|part| text.contains(part)), "{constraints}, {loads}: {text}");
            }
        }
    }
}

/// A cube that may turn about a pole, through its middle or along a face, of which one end is tilted as told, and one
/// that hangs on an edge that is moved: held nodes are where they are told to be, and what goes with the edge does not
/// swing about it. Some of it may be left by the bends on the way: 1 % of the motion (6 mm, if nobody minds).
#[test]
fn what_may_turn_about_nodes_that_are_moved_goes_with_them() {
    let pole = |x: f64| {
        let on = |z: f64| format!("on: Sphere(center: ({x:?}, 0.01, {z:?}), radius: 1e-4)");
        format!("Fixed({}), Prescribed({}, displacement: (0.004, 0, -0.002), CURVE)", on(0.0), on(0.02))
    };
    let edge = "Prescribed(on: And([Set(\"x0\"), Set(\"y0\")]), displacement: (0.01, 0, 0), CURVE)".to_string();
    let tilted = DVec3::new(0.004, 0.0, -0.002);
    let end = |x: f64| move |at: DVec3| at.distance(DVec3::new(x, 0.01, 0.02)) < 1e-4;
    let first: Box<dyn Fn(DVec3) -> bool> = Box::new(end(0.01));
    let second: Box<dyn Fn(DVec3) -> bool> = Box::new(end(0.0));
    let third: Box<dyn Fn(DVec3) -> bool> = Box::new(|at: DVec3| at.x < 1e-4 && at.y < 1e-4);
    let cases = [
        ("pole in the middle", pole(0.01), tilted, first),
        ("pole along a face", pole(0.0), tilted, second),
        ("edge", edge, DVec3::new(0.01, 0.0, 0.0), third),
    ];
    for (name, constraints, to, is_told) in &cases {
        for (precision, rounding) in [(Precision::F64, 1e-9), (Precision::F32, 2e-9)] {
            for kind in ["analysis: Static(method: Newton)", "start: Equilibrium(method: Newton)"] {
                let constraints = constraints.replace("CURVE", "curve: Table([(0, 1), (1, 1)])");
                let mut simulation = start(
                    &format!(
                        "(duration: 1, {kind}, constraints: [{constraints}],
                        bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4), elements: Hex8), material: \"m\")}},
                        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))}})"
                    ),
                    precision,
                );
                match kind.contains("analysis") {
                    true => simulation.finish().unwrap(),
                    false => simulation.settle().unwrap(),
                }
                let rest = simulation.rest_positions("b").unwrap();
                let u = simulation.displacements("b").unwrap();
                let far = |of: &dyn Fn(DVec3) -> bool| {
                    let those = u.iter().zip(&rest).filter(|(_, at)| of(**at));
                    let far: Vec<f64> = those.map(|(u, _)| u.distance(*to)).collect();
                    assert!(!far.is_empty() && far.iter().all(|far| far.is_finite()), "{name}: {far:?}");
                    far.into_iter().fold(0.0, f64::max)
                };
                let (told, all) = (far(is_told.as_ref()), far(&|_| true));
                println!("{name}, {precision:?}, {kind}: {told:e} m, all: {all:e} m");
                assert!(told < rounding, "{name}, {precision:?}, {kind}: {told:e} m");
                assert!(*name != "edge" || all < 1e-4, "{name}, {precision:?}, {kind}: {all:e} m");
            }
        }
    }
}

#[test]
fn any_number_of_threads_finds_the_same_bits() {
    let scene = column(0.5).replace("cells: (2, 2, 20)", "cells: (4, 4, 40)");
    let runs = [1, 2, 3].map(|threads| {
        let options = Options { threads, ..options(Precision::F32, threads) };
        let mut simulation = Simulation::new(&scene_of(&scene, Path::new(".")), &options).unwrap();
        simulation.finish().unwrap();
        simulation.displacements("b").unwrap()
    });
    assert!(runs[0].iter().any(|u| u.length() > 1e-5));
    assert!(runs.iter().all(|run| *run == runs[0]));
}

/// What is turned far, and what hangs where it stood out straight.
#[test]
fn relaxation_seeds_what_is_too_far_away() {
    let scene = |analysis: &str, more: &str| {
        format!(
            "(duration: 1, analysis: Static({analysis}),
            bodies: {{\"b\": (mesh: Box(size: (0.2, 0.01, 0.01), cells: (16, 1, 1), elements: Hex8MeanDilatation), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}}, {more})"
        )
    };
    let turned = "constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0)),
        Prescribed(on: Plane(normal: (1, 0, 0), at: 0.2), rotation: (300, 0, 0), center: (0.2, 0.005, 0.005))]";
    let hangs = "constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))], loads: [Gravity(acceleration: (0, 0, -2))]";
    let hangs_down = &hangs.replace("-2)", "-30)");
    for (name, more) in [("turned", turned), ("hangs", hangs), ("hangs down", hangs_down)] {
        let (relaxed, _) = rest(&scene("tolerance: 1e-8", more), Precision::F64);
        let (u, mut simulation) = rest(&scene("method: Newton", more), Precision::F64);
        let attempts = simulation.implicit_steps().unwrap().steps;
        println!("{name}: {attempts} attempts");
        assert_eq!(attempts > 1, name == "hangs down");
        near("apart", apart(&u, &relaxed), 0.0, 1.0, 1e-5);
        let found = simulation.equilibrium().unwrap().clone();
        assert!(found.newton_iterations > 0 && found.residual < 1e-8, "{found:?}");
        drop(simulation.summary("finished").unwrap());
    }
}

#[test]
fn a_motion_may_begin_at_rest_that_newton_found() {
    let mut simulation = start(
        "(duration: 0.2, start: Equilibrium(method: Newton),
        bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Tet4), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), prony: (terms: [(alpha: 0.5, tau: 0.1)]))},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], loads: [Gravity(acceleration: (0, 0, -2))])",
        Precision::F64,
    );
    simulation.settle().unwrap();
    let before = simulation.displacements("b").unwrap();
    let preload = simulation.preload().unwrap().clone();
    assert!(preload.equilibrium.newton_iterations > 0 && preload.equilibrium.residual < 1e-10, "{preload:?}");
    simulation.finish().unwrap();
    near("motion", apart(&simulation.displacements("b").unwrap(), &before), 0.0, 1.0, 1e-8);
}

#[test]
fn what_newton_cannot_do_is_refused_by_name() {
    let scene = |more: &str| {
        format!(
            "(duration: 0.1, {more}, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1)), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))])"
        )
    };
    let refused = |more: &str| match sinew::SceneFile::from_text("test", &scene(more), Path::new("."), &[]) {
        Ok(read) => {
            Simulation::new(&read, &options(Precision::F64, 1)).err().map_or("nothing".into(), |e| e.to_string())
        }
        Err(wrong) => wrong.render(false),
    };
    let tool =
        "tools: {\"t\": (shape: Sphere(radius: 0.01), at: (0, 0, 1))}, contacts: [Tool(tool: \"t\", body: \"b\")]";
    for (more, expected) in [
        ("analysis: Static(method: Guess)", "Guess"),
        ("analysis: Static(how: Newton)", "how"),
        ("start: Equilibrium(at: 1)", "a motion begins at t = 0"),
        (
            &format!("analysis: Static(method: Newton), {tool}"),
            "Newton's iterations cannot take part in the kinematic law of contact",
        ),
        (&format!("start: Equilibrium(method: Newton), {tool}"), "`method: Relaxation` in `start`"),
    ] {
        let told = refused(more);
        assert!(told.contains(expected), "{more}: {told}");
    }
}
