//! Static analyses against closed forms, each ending with a residual below its tolerance.
//!
//! Cantilever and column as in `statics`. Column in 1-D strain under a pressure or a dead load p on top: P(λ) = −p, the
//! same λ everywhere, exact on any mesh. Bar stretched to λ with its sides free (closed form 1): t, σ and P at λ = 1.5
//! and 0.7. A residual of 1e-6 leaves displacements within some 1e-5 of rest, one of 1e-5 (f32) within 1e-4.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, near, scene_of};
use crate::grids::grid;
use crate::statics::{first_stress, sag_under_weight};
use bevy_ecs::prelude::*;
use glam::DVec3;
use sinew::components::{ExternalForce, RestPosition};
use sinew::mesh::ElementKind;
use sinew::systems::{Phase, Registry, System};
use sinew::{Error, Simulation};
use std::path::Path;

const MATERIAL: &str = "\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))";

/// Runs to rest and says how many steps that took.
#[track_caller]
pub fn rest(what: &str, simulation: &mut Simulation) -> u64 {
    simulation.finish().unwrap_or_else(|error| panic!("{what}: {error}"));
    let found = simulation.equilibrium().unwrap();
    println!("{what}: at rest after {} steps, {found:?}", simulation.step_count());
    assert!(found.reached && simulation.is_finished());
    simulation.step_count()
}

fn cantilever(analysis: &str, density: f64) -> String {
    format!(
        "(duration: 9, analysis: {analysis},
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.01, 0.01), cells: (10, 1, 1), elements: Hex8), material: \"m\")}},
        materials: {{\"m\": (density: {density}, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 3.5)}},
        constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))],
        loads: [NodalForce(on: Plane(normal: (1, 0, 0), at: 0.1), force: (0, 0, -1e-5), share: Total)],
        probes: {{
            \"tip\": (what: Displacement, on: Plane(normal: (1, 0, 0), at: 0.1)),
            \"held\": (what: Reaction, on: Plane(normal: (1, 0, 0), at: 0)),
        }})"
    )
}

/// A column with lateral motion held, its mesh in a file or made.
fn column(mesh: &str, regions: &str, materials: &str, load: &str) -> String {
    format!(
        "(duration: 1, analysis: Static(),
        bodies: {{\"b\": (mesh: {mesh}, material: \"m\", regions: [{regions}])}}, materials: {{{materials}}},
        constraints: [Fixed(on: All, axes: [X, Y]), Fixed(on: Plane(normal: (0, 0, 1), at: 0))], loads: [{load}],
        probes: {{
            \"top\": (what: Displacement, on: Plane(normal: (0, 0, 1), at: 0.1)),
            \"lower\": (what: Displacement, on: Box(min: (-1, -1, 1e-6), max: (1, 1, 0.050001))),
        }})"
    )
}

fn box_of(elements: &str, along: usize) -> String {
    format!("Box(size: (0.01, 0.01, 0.1), cells: (1, 1, {along}), elements: {elements})")
}

/// λ of P(λ) = −p.
fn stretch_under(pressure: f64) -> f64 {
    let (mut low, mut high) = (0.1, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if first_stress(middle) > -pressure { high = middle } else { low = middle }
    }
    low
}

#[test]
fn cantilever_rests_where_timoshenko_says_and_its_reaction_balances_the_load() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&cantilever("Static()", 1000.0));
        rest(run.name, &mut simulation);
        let tip = simulation.probe("tip").unwrap()[2];
        near(&format!("{}: deflection", run.name), -tip / 1.344633e-3, 0.996, 1.0, 0.005);
        let held = simulation.probe("held").unwrap()[2];
        // the reaction errs by what is not balanced: at 40 free nodes residual and rounding of 1e-4 N
        let found = simulation.equilibrium().unwrap();
        let bound = f64::sqrt(40.0) * (found.residual + found.tolerance) * found.scale;
        near(&format!("{}: reaction", run.name), held, 1e-5, 1.0, bound);
    }
}

#[test]
fn column_rests_where_its_weight_and_its_law_say() {
    for (run, elements) in cpu_and_long_gpu().iter().flat_map(|run| [(run, "Tet4"), (run, "Hex8")]) {
        let load = "Gravity(acceleration: (0, 0, -9.81))";
        let mesh = format!("Box(size: (0.01, 0.01, 0.1), cells: (2, 2, 20), elements: {elements})");
        let mut simulation = run.start(&column(&mesh, "", MATERIAL, load));
        let what = format!("{}, {elements}", run.name);
        rest(&what, &mut simulation);
        let expected = sag_under_weight(9.81);
        near(&what, -simulation.probe("top").unwrap()[2], expected, expected, run.bound(1e-5, 1e-4).max(1e-4));
    }
}

#[test]
fn pressure_and_dead_load_squeeze_a_column_by_the_same_exact_amount() {
    let expected = 0.1 * (1.0 - stretch_under(3000.0));
    for (run, elements) in cpu_and_long_gpu().iter().flat_map(|run| [(run, "Tet4"), (run, "Hex8")]) {
        for load in ["Pressure(on: TOP, pressure: 3000)", "Traction(on: TOP, traction: (0, 0, -3000))"] {
            let load = load.replace("TOP", "Surface(normal: (0, 0, 1))");
            let mut simulation = run.start(&column(&box_of(elements, 10), "", MATERIAL, &load));
            let what = format!("{}, {elements}, {load}", run.name);
            rest(&what, &mut simulation);
            near(&what, -simulation.probe("top").unwrap()[2], expected, expected, run.bound(2e-5, 1e-4));
        }
    }
}

#[test]
fn stretched_and_squeezed_bars_pull_as_the_law_says() {
    for (run, elements) in cpu_and_long_gpu().iter().flat_map(|run| [(run, "Tet4"), (run, "Hex8")]) {
        for (stretch, side, stress) in [(1.5, 0.8363969, 1035.4829), (0.7, 1.1756426, -1347.7943)] {
            let mut simulation = run.start(&format!(
                "(duration: 1, analysis: Static(),
                bodies: {{\"b\": (mesh: Box(size: (0.1, 0.01, 0.01), cells: (5, 1, 1), elements: {elements}), material: \"m\")}},
                materials: {{{MATERIAL}}},
                constraints: [
                    Fixed(on: Plane(normal: (1, 0, 0), at: 0), axes: [X]), Fixed(on: Plane(normal: (0, 1, 0), at: 0), axes: [Y]),
                    Fixed(on: Plane(normal: (0, 0, 1), at: 0), axes: [Z]),
                    Prescribed(on: Plane(normal: (1, 0, 0), at: 0.1), axes: [X], displacement: ({:?}, 0, 0)),
                ],
                probes: {{
                    \"side\": (what: Displacement, on: Plane(normal: (0, 1, 0), at: 0.01)),
                    \"end\": (what: Reaction, on: Plane(normal: (1, 0, 0), at: 0.1)),
                }})",
                0.1 * (stretch - 1.0)
            ));
            let what = format!("{}, {elements}, λ = {stretch}", run.name);
            rest(&what, &mut simulation);
            let found = simulation.probe("side").unwrap()[1] / 0.01 + 1.0;
            near(&format!("{what}: side"), found, side, 1.0, run.bound(1e-5, 1e-4));
            let pull = simulation.probe("end").unwrap()[0] / 1e-4;
            near(&format!("{what}: stress"), pull, stress, 1000.0, run.bound(2e-5, 2e-4));
        }
    }
}

/// Heights of 1:100. A transient run must take the smallest element's step; to rest it takes 16/ω of the slowest motion
/// at the best damping, which leaves (1 + 16)e^(−16) = 2e-6.
#[test]
fn graded_mesh_costs_a_fraction_of_the_steps_of_motion() {
    let ratio = 100_f64.powf(1.0 / 19.0);
    let height = |k: f64| 0.1 * (ratio.powf(k) - 1.0) / (ratio.powf(20.0) - 1.0);
    let mesh = grid([1, 1, 20], |_| ElementKind::Hex8).moved(|x| DVec3::new(0.01 * x.x, 0.01 * x.y, height(x.z)));
    let folder = tempfile::tempdir().unwrap();
    mesh.write(&folder.path().join("mesh.vtk"));
    let load = "Traction(on: Surface(normal: (0, 0, 1)), traction: (0, 0, -3000))";
    let expected = 0.1 * (1.0 - stretch_under(3000.0));
    for run in configurations() {
        let mut simulation = run.start_in(&column("File(path: \"mesh.vtk\")", "", MATERIAL, load), folder.path());
        let steps = rest(run.name, &mut simulation);
        near(run.name, -simulation.probe("top").unwrap()[2], expected, expected, run.bound(2e-5, 1e-4));
        let slowest = std::f64::consts::PI / 2.0 * f64::sqrt(11379.3 / 1000.0) / 0.1;
        let in_motion = 16.0 / slowest / (0.9 * simulation.summary("").unwrap().stable_step);
        println!("{}: {steps} steps instead of {in_motion:.0}", run.name);
        assert!(in_motion > 8.0 * steps as f64, "{steps} of {in_motion}");
    }
}

/// H11: lower half 1e4 times as stiff. In 1-D strain each half has its own exact stretch; the mean over the lower
/// half's five layers of nodes above the held one is 0.6 of the interface's displacement.
#[test]
fn interface_of_stiff_and_soft_goes_where_the_series_says() {
    let stiff = "\"stiff\": (density: 1000, neo_hookean: Young(young: 3e7, poisson: 0.45)),";
    let regions = "(on: Box(min: (-1, -1, -1), max: (1, 1, 0.05)), material: \"stiff\")";
    let load = "Traction(on: Surface(normal: (0, 0, 1)), traction: (0, 0, -1000))";
    let (soft, hard) = (1.0 - stretch_under(1000.0), 1.0 - stretch_under(0.1));
    for (run, elements) in configurations().iter().flat_map(|run| [(run, "Tet4"), (run, "Hex8")]) {
        let scene = column(&box_of(elements, 10), regions, &format!("{stiff} {MATERIAL}"), load);
        let mut simulation = run.start(&scene);
        let what = format!("{}, {elements}", run.name);
        rest(&what, &mut simulation);
        let (middle, top) = (-simulation.probe("lower").unwrap()[2] / 0.6, -simulation.probe("top").unwrap()[2]);
        near(&format!("{what}: interface"), middle, 0.05 * hard, 0.05 * hard, 0.01);
        near(&format!("{what}: top"), top, 0.05 * (soft + hard), 0.05 * soft, run.bound(2e-5, 1e-4));
    }
}

#[test]
fn density_changes_nothing_where_nothing_weighs() {
    for run in cpu_and_long_gpu() {
        let tip = |density: f64| {
            let mut simulation = run.start(&cantilever("Static()", density));
            (rest(run.name, &mut simulation), simulation.probe("tip").unwrap()[2])
        };
        let ((steps, light), (others, heavy)) = (tip(10.0), tip(20_000.0));
        near(run.name, heavy, light, light, run.bound(1e-6, 1e-4));
        assert!(run.bound(1.0, 0.0) == 0.0 || steps.abs_diff(others) <= 40, "{steps} and {others} steps");
    }
}

/// What is pushed too suddenly is taken back; the way does not show in the end.
#[test]
fn block_squeezed_by_sixty_percent_is_the_same_at_any_pace() {
    for run in cpu_and_long_gpu() {
        let squeezed = |more: &str| {
            let mut simulation = run.start(&format!(
                "(duration: 1, analysis: Static({more}),
                bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8), material: \"m\")}},
                materials: {{{MATERIAL}}},
                constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
                    Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), displacement: (0, 0, -0.06))])"
            ));
            rest(run.name, &mut simulation);
            let setbacks = simulation.equilibrium().unwrap().setbacks;
            let fields = simulation.fields("b").unwrap();
            assert!(fields.volume_ratio.iter().all(|&ratio| ratio > 0.5), "{:?}", fields.volume_ratio);
            (setbacks, fields.displacement)
        };
        let ((setbacks, sudden), (none, slow)) = (squeezed("load_steps: 8"), squeezed("load_steps: 1000"));
        let apart = sudden.iter().zip(&slow).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        println!("{}: {setbacks} setbacks, {apart:e} m apart", run.name);
        assert!(setbacks > 0 && none == 0, "{}: {setbacks} and {none} times taken back", run.name);
        assert!(apart < run.bound(1e-6, 1e-5), "{}: {apart:e} m apart", run.name);
    }
}

#[test]
fn viscous_tissue_rests_at_its_long_term_stress() {
    for run in configurations() {
        let top = |shear: f64, prony: &str| {
            let material = format!("\"m\": (density: 1000, neo_hookean: Moduli(shear: {shear}, bulk: 1e4), {prony})");
            let load = "Traction(on: Surface(normal: (0, 0, 1)), traction: (0, 0, -3000))";
            let mut simulation = run.start(&column(&box_of("Hex8", 5), "", &material, load));
            rest(run.name, &mut simulation);
            simulation.probe("top").unwrap()[2]
        };
        let prony = "prony: (terms: [(alpha: 0.5, tau: 0.1), (alpha: 0.2, tau: 100)])";
        let (viscous, elastic) = (top(1000.0, prony), top(300.0, ""));
        near(run.name, viscous, elastic, elastic, run.bound(2e-5, 1e-4));
    }
}

/// Curves count as they stand at `duration`, whatever they were before.
#[test]
fn loads_are_those_at_the_end_of_the_scene() {
    for run in configurations() {
        let top = |curve: &str, pressure: f64| {
            let load = format!("Pressure(on: Surface(normal: (0, 0, 1)), pressure: {pressure}, curve: {curve})");
            let mut simulation = run.start(&column(&box_of("Hex8", 5), "", MATERIAL, &load));
            rest(run.name, &mut simulation);
            assert_eq!(simulation.time(), 1.0);
            simulation.probe("top").unwrap()[2]
        };
        let half = top("Step()", 1500.0);
        near(run.name, top("Table([(0, 0), (0.5, 7), (1, 0.5), (2, 3)])", 3000.0), half, half, run.bound(2e-5, 1e-4));
        assert_eq!(top("Step(end: 1)", 3000.0), 0.0);
    }
}

#[test]
fn body_moved_without_strain_comes_to_rest() {
    for run in configurations() {
        let mut simulation = run.start(&format!(
            "(duration: 1, analysis: Static(), materials: {{{MATERIAL}}},
            bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: Hex8), material: \"m\")}},
            constraints: [Prescribed(on: Plane(normal: (0, 0, 1), at: 0), displacement: (0.1, 0, 0), rotation: (0, 0, 40))])"
        ));
        rest(run.name, &mut simulation);
        let fields = simulation.fields("b").unwrap();
        let worst = fields.stress.iter().flatten().fold(0.0_f64, |worst, s| worst.max(s.abs()));
        // strains of 1e-6 of a body moved by its own size
        assert!(worst < run.bound(0.1, 1.0), "{}: {worst} Pa", run.name);
    }
}

#[test]
fn search_that_is_given_up_says_where_and_how_far_it_came() {
    for run in configurations() {
        let mut simulation = run.start(&cantilever("Static(max_steps: 150)", 1000.0));
        let error = simulation.finish().unwrap_err();
        let text = error.to_string();
        let Error::NotConverged(report) = error else { panic!("{}: {text}", run.name) };
        println!("{text}");
        assert_eq!((report.steps, simulation.step_count(), report.stalled_at), (150, 150, None));
        let (body, node, force) = &report.equilibrium.worst;
        assert!(body == "b" && *node < 44 && *force > 0.0, "{report:?}");
        assert!(report.equilibrium.residual > 1e-3 && !simulation.equilibrium().unwrap().reached);
        for word in ["no equilibrium after 150 steps", &format!("node {node} of body b"), "max_steps", "tolerance"] {
            assert!(text.contains(word), "{word} is not in: {text}");
        }
        assert!(simulation.summary("").unwrap().probes.is_empty(), "a probe shows what is no equilibrium");
    }
}

/// A system of one's own loads as a scene's own load does, on both backends.
#[test]
fn custom_system_finds_its_place_in_a_static_analysis() {
    fn push(mut bodies: Query<(&RestPosition, &mut ExternalForce)>) {
        for (rest, mut force) in &mut bodies {
            for row in 0..rest.0.len() {
                if rest.0[row].z > 0.0999 {
                    let sum = force.vector(row) - DVec3::Z * 0.01;
                    force.set_vector(row, sum);
                }
            }
        }
    }
    for run in configurations() {
        let schedule =
            "schedule: [\"boundary\", \"element_forces\", \"gather\", \"push\", \"integrate\", \"observe\"],";
        let scene = column(&box_of("Hex8", 4), "", MATERIAL, "").replace("loads: [],", schedule);
        let registry = Registry::default().with(System::custom("push", Phase::Loads, "pushes the top", push));
        let mut pushed = Simulation::with_systems(&scene_of(&scene, Path::new(".")), &run.options, &registry).unwrap();
        rest(run.name, &mut pushed);
        let load = "NodalForce(on: Plane(normal: (0, 0, 1), at: 0.1), force: (0, 0, -0.01))";
        let mut loaded = run.start(&column(&box_of("Hex8", 4), "", MATERIAL, load));
        rest(run.name, &mut loaded);
        let (pushed, loaded) = (pushed.probe("top").unwrap()[2], loaded.probe("top").unwrap()[2]);
        assert!(loaded < -1e-3);
        near(run.name, pushed, loaded, loaded, run.bound(2e-5, 1e-4));
    }
}

/// A body that nothing holds never rests under its weight.
#[test]
fn falling_body_is_no_equilibrium() {
    let run: &Configuration = &configurations()[0];
    let mut simulation = run.start(&format!(
        "(duration: 1, analysis: Static(max_steps: 3000), materials: {{{MATERIAL}}},
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: \"m\")}},
        loads: [Gravity(acceleration: (0, 0, -9.81))])"
    ));
    let warned = simulation.warnings().list().iter().any(|warning| warning.message.contains("nothing holds"));
    assert!(warned && matches!(simulation.finish(), Err(Error::NotConverged(_))));
}

#[test]
fn what_has_no_meaning_at_rest_is_refused() {
    let refused = |more: &str| {
        let scene = cantilever("ANALYSIS", 1000.0).replace("duration: 9, analysis: ANALYSIS", more);
        let found = Simulation::check(&scene_of(&scene, Path::new(".")), &Registry::default());
        assert!(found.has_errors(), "{more}");
        found.render(false)
    };
    let text = refused("duration: 9, analysis: Static(), removal: [(when: StretchAbove(2))]");
    assert!(text.contains("cannot remove elements") && text.contains("Transient"), "{text}");
    let text = refused("duration: 9, analysis: Static(tolerance: 0)");
    assert!(text.contains("`tolerance` must be above 0 and below 1"), "{text}");
    let text = refused("duration: 9, analysis: Static(max_steps: 10, load_steps: 20)");
    assert!(text.contains("`load_steps` must be at most `max_steps`"), "{text}");
}

/// It is told as soon as it is far away, and not after all steps that are allowed.
#[test]
fn a_body_that_flies_away_ends_the_search_and_is_named() {
    let run: &Configuration = &configurations()[0];
    for (begins, before) in [("analysis: Static(),", "no equilibrium"), ("start: Equilibrium(),", "the motion cannot")]
    {
        let mut simulation = run.start(&format!(
            "(duration: 1, {begins} materials: {{{MATERIAL}}},
            bodies: {{\"held\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: \"m\"),
                \"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: \"m\", translate: (0.2, 0, 0))}},
            constraints: [Fixed(body: \"held\", on: Set(\"z0\"))],
            loads: [Gravity(acceleration: (0, 0, -9.81))])"
        ));
        let error = simulation.finish().unwrap_err();
        let text = error.to_string();
        println!("{text}");
        let Error::NotConverged(report) = error else { panic!("{text}") };
        assert!(report.steps < 10_000, "{text}");
        assert!(text.starts_with(before) && text.contains("body b flies away along ("), "{text}");
        assert!(text.contains("-1.00)") && text.contains("nothing holds it"), "{text}");
    }
}

/// A cube of 2 mm that a jaw holds half a metre from its hinge is carried round by 120°: it goes 250 of its lengths,
/// and is held all the way.
#[test]
fn what_a_tool_carries_round_far_from_its_origin_does_not_fly_away() {
    let run: &Configuration = &configurations()[0];
    let mut simulation = run.start(
        "(duration: 1, analysis: Static(),
        bodies: {\"b\": (mesh: Box(size: (0.002, 0.002, 0.002), cells: (1, 1, 1)), material: \"m\", translate: (0.5, 0, 0))},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))},
        tools: {\"jaw\": (shape: Box(size: (1.1, 0.01, 0.002)), at: (0, 0, 0.003),
            moves: [(rotation: (0, 0, 120), curve: Smooth(end: 1))])},
        attachments: [Grasp(tool: \"jaw\", body: \"b\", closed: Step(), on: Set(\"z1\"), reach: 0.003)])",
    );
    rest("carried round", &mut simulation);
    let (places, ways) = (simulation.rest_positions("b").unwrap(), simulation.displacements("b").unwrap());
    let turn = glam::DQuat::from_rotation_z(120.0_f64.to_radians());
    for (place, way) in places.iter().zip(&ways) {
        let off = (*place + *way).distance(turn * *place);
        assert!(off < 1e-5, "{place} is {off:e} m off");
    }
}
