//! Motions that begin at equilibrium: at rest where a static analysis says, and staying there.
//!
//! Bar under its own weight with ν = 0, held at z = 0: u(z) = ρ g (L z − z²/2)/E, exact at the nodes of linear
//! elements. At strains of 3e-5 the law's own curvature changes that by as much. Tetrahedra weigh on nodes of one
//! height differently: of them the mean over a layer counts, which is right to second order. A residual of 1e-6 leaves
//! displacements within some 1e-5 of rest, one of 1e-5 (f32) within 1e-4 (`equilibrium`): let go, they swing as far to
//! the other side, the slowest motion's end twice as far as the mean. Its energy is the square of that: 1e-9 and 1e-7
//! of the strain energy.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, near, scene_of};
use crate::element_turns::with_elements;
use crate::grids::bits;
use sinew::{Error, Simulation, Snapshot};
use std::ops::ControlFlow;
use std::path::Path;

/// A block with fibres, viscosity and gravity, squeezed by a pressure and by nodes that are moved already; `further`
/// comes last.
fn block(elements: &str, start: &str, integrator: &str, further: &str) -> String {
    format!(
        "(duration: 0.4, {start}
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45),
            fibres: (eta: 500, direction: Along(1, 0, 1)),
            prony: (terms: [(alpha: 0.3, tau: 0.05), (alpha: 0.2, tau: 3)], volumetric: [(alpha: 0.1, tau: 0.1)],
                {integrator}))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
            Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), axes: [X], displacement: (0.01, 0, 0))],
        loads: [Gravity(acceleration: (0, 0, -9.81)),
            Pressure(on: Surface(normal: (1, 0, 0)), pressure: 600, curve: Table([(0, 0.5), (1, 0.5), (2, 1)]))],
        {further})"
    )
}

/// How far nodes are from where others are, at most (m).
fn apart(a: &[glam::DVec3], b: &[glam::DVec3]) -> f64 {
    assert!(a.len() == b.len() && !a.is_empty());
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, |most, d| if d <= most { most } else { d })
}

fn error_of(run: &Configuration, text: &str) -> (Simulation, String) {
    let mut simulation = run.start(text);
    let error = simulation.advance(1).expect_err("no equilibrium can be there");
    (simulation, error.to_string())
}

#[test]
fn bar_under_its_weight_starts_where_the_closed_form_says_and_stays() {
    let (length, young, gravity) = (0.1, 3e3, 9.81e-4);
    for (run, elements) in cpu_and_long_gpu().iter().flat_map(|run| ["Tet4", "Hex8"].map(|e| (run, e))) {
        let mut simulation = run.start(&format!(
            "(duration: 1, start: Equilibrium(),
            bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.1), cells: (2, 2, 10), elements: {elements}), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: {young}, poisson: 0))}},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
            loads: [Gravity(acceleration: (0, 0, {gravity}))])"
        ));
        let what = format!("{}, {elements}", run.name);
        let rest = simulation.rest_positions("b").unwrap();
        let start = simulation.displacements("b").unwrap();
        let sag = |z: f64| 1000.0 * gravity * (length * z - 0.5 * z * z) / young;
        for layer in 0..=10 {
            let z = 0.01 * f64::from(layer);
            let there = || rest.iter().zip(&start).filter(|(at, _)| (at.z - z).abs() < 1e-6).map(|(_, u)| u.z);
            let mean = there().sum::<f64>() / there().count() as f64;
            let bound = if elements == "Hex8" { run.bound(1e-4, 2e-4) } else { 1e-3 };
            near(&format!("{what}: z = {z}"), mean, sag(z), sag(length), bound);
        }
        let preload = simulation.preload().unwrap().clone();
        assert!(preload.equilibrium.reached && preload.steps > 100 && preload.seconds > 0.0, "{preload:?}");
        let strain = simulation.energies().unwrap().strain;
        let mut most = 0.0_f64;
        for _ in 0..10 {
            simulation.advance(simulation.planned_steps() / 10).unwrap();
            let kinetic = simulation.energies().unwrap().kinetic;
            assert!(kinetic.is_finite());
            most = most.max(kinetic / strain);
        }
        let moved = apart(&simulation.displacements("b").unwrap(), &start) / sag(length);
        println!("{what}: {} steps, kinetic {most:.1e} of the strain energy, moved {moved:.1e}", preload.steps);
        assert!(most <= run.bound(1e-9, 1e-7), "{what}: kinetic energy {most:e} of the strain energy");
        assert!(moved <= run.bound(5e-5, 5e-4), "{what}: moved by {moved:e} of the end's sag");
    }
}

#[test]
#[ignore = "long"]
fn viscous_block_with_fibres_starts_where_the_static_analysis_ends_and_stays() {
    for (run, elements) in with_elements(&configurations(), 0) {
        for integrator in ["integrator: Exact", "integrator: BackwardEuler, reproject: true"] {
            let what = format!("{}, {elements}, {integrator}", run.name);
            let mut at_rest = run.start(&block(elements, "analysis: Static(at: 0),", integrator, ""));
            at_rest.finish().unwrap();
            assert_eq!(at_rest.time(), 0.0);
            let expected = at_rest.displacements("b").unwrap();
            let size = expected.iter().map(|u| u.length()).fold(0.0, f64::max);
            assert!(size > 0.01, "{what}: {size} m is no large deformation");
            let mut simulation = run.start(&block(elements, "start: Equilibrium(),", integrator, ""));
            simulation.observe().unwrap();
            assert_eq!(simulation.step_count(), 0);
            let start = simulation.displacements("b").unwrap();
            assert_eq!(apart(&start, &expected), 0.0, "{what}");
            let mut most = 0.0_f64;
            while !simulation.is_finished() {
                simulation.advance_towards_end(40).unwrap();
                most = most.max(apart(&simulation.displacements("b").unwrap(), &start) / size);
            }
            println!("{what}: moved by {most:.1e} of {size:.3} m");
            assert!(most <= run.bound(2e-5, 2e-4), "{what}: moved by {most:e} of the displacement");
        }
    }
}

/// What is removed, lets go of what was at rest.
#[test]
fn removal_begins_with_the_motion_and_snapshots_are_gone_on_from_without_another_way_to_rest() {
    let removal = "removal: [(on: Box(min: (0.06, 0, 0.03), max: (0.1, 0.1, 0.1)), when: At(0.02))],
        output: (energies_every: 0.01), integration: (step: 5e-4)";
    for (run, elements) in cpu_and_long_gpu().iter().flat_map(|run| ["Tet4NodalPressure", "Hex8"].map(|e| (run, e))) {
        let what = format!("{}, {elements}", run.name);
        let text = block(elements, "start: Equilibrium(),", "", removal);
        let mut whole = run.start(&text);
        let first = whole.snapshot().unwrap();
        let start = whole.displacements("b").unwrap();
        whole.advance(39).unwrap();
        let before = apart(&whole.displacements("b").unwrap(), &start);
        let kept = Snapshot::from_bytes(&whole.snapshot().unwrap().to_bytes().unwrap()).unwrap();
        whole.advance(100).unwrap();
        let after = apart(&whole.displacements("b").unwrap(), &start);
        assert!(before < 1e-5 && after > 1e-3, "{what}: moved by {before:e} m before the removal, {after:e} m after");
        assert!(whole.summary("").unwrap().removed_elements > 0 && whole.preload().is_some());
        let end = bits(&mut whole, "b");
        for (snapshot, steps) in [(&first, 139), (&kept, 100)] {
            let mut other = run.start(&text);
            other.restore(snapshot).unwrap();
            other.advance(steps).unwrap();
            assert!(bits(&mut other, "b") == end, "{what}: another way from step {}", snapshot.step());
            assert!(other.preload().is_none() && other.summary("").unwrap().preload.is_none());
        }
        let unlike = block(elements, "", "", removal);
        assert!(matches!(run.start(&unlike).restore(&kept), Err(Error::Snapshot(_))), "{what}: taken for its own");
    }
}

/// Energies count from the start, where elements hold some already.
#[test]
fn energy_balances_from_the_start() {
    for run in configurations() {
        let text = block("Hex8", "start: Equilibrium(),", "", "").replace("(1, 0.5), (2, 1)", "(0.05, 1)");
        let mut simulation = run.start(&text);
        simulation.finish().unwrap();
        let guards = simulation.guards();
        println!(
            "{}: imbalance {:e}, at start {:e} J of {:e}",
            run.name, guards.imbalance, guards.at_start, guards.scale
        );
        assert!(guards.at_start > 0.1 * guards.scale && guards.warnings.is_empty(), "{}: {guards:?}", run.name);
    }
}

#[test]
fn where_there_is_no_equilibrium_no_step_is_taken() {
    for run in cpu_and_long_gpu() {
        let (mut simulation, error) = error_of(&run, &block("Hex8", "start: Equilibrium(max_steps: 120),", "", ""));
        assert!(error.contains("the motion cannot begin") && error.contains("`tolerance` of `start`"), "{error}");
        assert_eq!(simulation.step_count(), 0);
        let again = simulation.advance(1).expect_err("the second time as the first");
        assert!(matches!(again, Error::NotConverged(_)), "{again}");
        assert_eq!(simulation.step_count(), 0);
        // turned inside out by more than it bears, however slowly
        let crushed = block("Hex8", "start: Equilibrium(),", "", "")
            .replace("displacement: (0.01, 0, 0)", "displacement: (0, 0, -0.2)");
        let (mut simulation, error) = error_of(&run, &crushed.replace("axes: [X]", "axes: [Z]"));
        assert!(error.contains("on the way to the equilibrium of the start"), "{error}");
        let again = simulation.advance(1).expect_err("the second time as the first").to_string();
        assert!(again.contains("on the way to the equilibrium of the start"), "{again}");
        assert_eq!(simulation.step_count(), 0);
    }
}

#[test]
fn what_has_no_meaning_beside_it_is_told() {
    let told = |text: &str| {
        let file = scene_of(text, Path::new("."));
        let mut found = file.diagnostics();
        sinew::scene::validate(&file, &mut found);
        found.render(false)
    };
    let with =
        |old: &str, new: &str| told(&block("Hex8", "start: Equilibrium(tolerance: 1e-5),", "", "").replace(old, new));
    assert_eq!(with("", ""), "");
    assert!(with("material: \"m\")", "material: \"m\", velocity: (1, 0, 0))").contains("`velocity` has no meaning"));
    assert!(with("tolerance: 1e-5", "tolerance: 2").contains("above 0 and below 1"));
    assert!(with("tolerance: 1e-5", "load_steps: 0").contains("at least 1"));
    let unloaded = with("displacement: (0.01, 0, 0))", "displacement: (0.01, 0, 0), curve: Smooth(end: 1))");
    assert_eq!(unloaded, "", "gravity acts");
    let gravity = "Gravity(acceleration: (0, 0, -9.81)),";
    let nothing = block("Hex8", "start: Equilibrium(),", "", "")
        .replace("displacement: (0.01, 0, 0))", "displacement: (0.01, 0, 0), curve: Smooth(end: 1))")
        .replace(gravity, "")
        .replace("(0, 0.5)", "(0, 0)");
    assert!(told(&nothing).contains("nothing acts at t = 0"));
    let free = block("Hex8", "start: Equilibrium(),", "", "")
        .replace("constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),", "constraints: [");
    let free =
        free.replace("Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), axes: [X], displacement: (0.01, 0, 0))", "");
    assert!(told(&free).contains("nothing holds the body"));
    assert!(with("start: ", "analysis: Static(at: -1), start: ").contains("0 or above"));
}

/// A ball in a block at t = 0: what it feels there is what holds the block, and nobody says that nothing acts.
#[test]
fn what_a_tool_feels_at_rest_stands_in_the_first_row() {
    let text = "(duration: 0.01, start: Equilibrium(),
        bodies: {\"b\": (mesh: Box(size: (0.03, 0.03, 0.02), cells: (5, 5, 3), elements: Hex8), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4), damping: 20)},
        constraints: [Fixed(on: Set(\"z0\"))],
        tools: {\"ball\": (shape: Sphere(radius: 0.012), at: (0.015, 0.015, 0.031))}, contacts: [Tool(tool: \"ball\")])";
    let file = scene_of(text, Path::new("."));
    let mut found = file.diagnostics();
    sinew::scene::validate(&file, &mut found);
    assert_eq!(found.render(false), "");
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(text);
        let first = simulation.tool("ball").unwrap();
        simulation.advance(2).unwrap();
        let then = simulation.tool("ball").unwrap();
        assert!(first.force.z > 5e-3 && first.nodes == then.nodes, "{}: {first:?} {then:?}", run.name);
        let off = first.force.distance(then.force);
        near(run.name, off, 0.0, then.force.length(), 1e-3);
    }
}

/// A block glued to another and a thread to a third: what they bear at rest is told before the first step.
#[test]
fn what_glue_and_threads_bear_at_rest_stands_in_the_first_row() {
    let text = "(duration: 0.2, start: Equilibrium(),
        bodies: {
            \"a\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3), elements: Hex8), material: \"m\"),
            \"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3), elements: Hex8), translate: (0.012, 0, 0),
                material: \"m\"),
            \"c\": (mesh: Box(size: (0.006, 0.006, 0.006), cells: (3, 3, 3), elements: Hex8),
                translate: (0.002, 0.002, 0.01), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4))},
        constraints: [Fixed(body: \"a\", on: Plane(normal: (0, 0, 1), at: 0)),
            Fixed(body: \"b\", on: Plane(normal: (0, 0, 1), at: 0))],
        loads: [Gravity(acceleration: (2, 0, -9.81))],
        attachments: [Glue(name: \"g\", bodies: (\"c\", \"a\")), Suture(name: \"s\", stiffness: 10, tighten: 1e-3,
            from: (body: \"a\", at: (0.01, 0.005, 0.005)), to: (body: \"b\", at: (0.012, 0.005, 0.005)))])";
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(text);
        let readings = |simulation: &mut Simulation| ["g", "s"].map(|name| simulation.attachment(name).unwrap());
        let first = readings(&mut simulation);
        simulation.advance(2).unwrap();
        for (first, then) in first.iter().zip(&readings(&mut simulation)) {
            // the weight of .216 g is 2.1 mN
            assert!(first.force.length() > 1e-3 && first.holds == then.holds, "{}: {first:?}, {then:?}", run.name);
            near(run.name, first.force.distance(then.force), 0.0, then.force.length(), run.bound(1e-2, 5e-2));
            near(run.name, first.length, then.length, 2e-3, 1e-3);
            near(run.name, first.energy, then.energy, 4e-7, 1e-2);
        }
    }
}

/// Who waits for it is told how far the search is.
#[test]
fn how_far_the_search_for_the_start_is_is_told_on_the_way() {
    let run = &configurations()[0];
    let mut simulation = run.start(&block("Tet4", "start: Equilibrium(),", "", ""));
    let mut told: Vec<(u64, f64)> = Vec::new();
    let ended = simulation.settle_telling(|steps, found| {
        told.push((steps, found.residual));
        ControlFlow::Continue(())
    });
    assert!(ended.unwrap().is_continue());
    // until it is first looked at
    let told: Vec<_> = told.into_iter().skip_while(|(_, residual)| residual.is_infinite()).collect();
    let preload = simulation.preload().unwrap();
    assert!(told.is_sorted_by(|a, b| a.0 < b.0) && told.iter().all(|(_, residual)| residual.is_finite()), "{told:?}");
    assert_eq!(told.last().unwrap(), &(preload.steps, preload.equilibrium.residual));
    // it is at rest, and nothing is left to tell
    let ended = simulation.settle_telling(|steps, _| panic!("told anew, of {steps} steps"));
    assert!(ended.unwrap().is_continue());
}

/// Who is told may break it off: no state is there then, and who asks for one has the search go on, to the same place.
#[test]
fn the_search_for_the_start_can_be_broken_off_and_goes_on() {
    let run = &configurations()[0];
    let start = || run.start(&block("Tet4", "start: Equilibrium(),", "", ""));
    let (mut whole, mut broken_off) = (start(), start());
    let mut at = 0;
    let ended = broken_off.settle_telling(|steps, _| {
        at = steps;
        ControlFlow::Break(())
    });
    assert!(ended.unwrap().is_break() && at > 0 && broken_off.preload().is_none());
    assert!(bits(&mut broken_off, "b") == bits(&mut whole, "b"));
    let [again, at_once] = [&broken_off, &whole].map(|simulation| simulation.preload().unwrap().steps);
    assert!(again == at_once && at < at_once, "{at} steps, {again}, {at_once}");
}
