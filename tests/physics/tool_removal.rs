//! Tools that take elements: how much is gone, what is left, what is counted.
//!
//! Volume: a tool that takes Q in a second from what is in its reach has taken Q t after t, to one element, on any
//! mesh. Surface: every edge belongs to an even number of faces. Mass: ρ times the volume that is gone. Energy: what
//! bodies hold and have lost is what loads and constraints have given.

use crate::configurations::{Configuration, cpu_and_long_gpu, near, scene_of};
use sinew::components::Precision;
use sinew::{Options, Simulation};
use std::collections::BTreeMap;

/// A cube of 2 cm, glued below, and a tube that goes into it.
fn drilled(cells: usize, elements: &str, rest: &str) -> String {
    format!(
        "(duration: 0.2, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: ({cells}, {cells}, {cells}),
            elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4), damping: 20)}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        tools: {{\"tip\": (shape: Tube(length: 0.03, inner: 3e-3, outer: 5e-3), rounding: 5e-4,
            path: [(t: 0, at: (0.01, 0.01, 0.0205)), (t: 0.2, at: (0.01, 0.01, 0.014))])}},
        contacts: [Tool(tool: \"tip\", friction: 0.1)],
        removal: [(when: InTool(tool: \"tip\", reach: 6e-3, rate: 2e-6 {rest}))],
        probes: {{\"hole\": (what: RemovedVolume)}}, output: (energies_every: 0.05))"
    )
}

fn gone(simulation: &mut Simulation) -> f64 {
    simulation.probe("hole").unwrap()[0]
}

/// Each edge of the surface, with how many triangles it belongs to: of a quadrilateral's diagonal two.
fn odd_edges(simulation: &mut Simulation, body: &str) -> usize {
    let mut edges: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    for [a, b, c] in simulation.surface_triangles(body).unwrap() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry([from.min(to), from.max(to)]).or_default() += 1;
        }
    }
    edges.values().filter(|count| *count % 2 == 1).count()
}

/// C29.
#[test]
fn a_tool_takes_its_rate_from_any_mesh() {
    for run in cpu_and_long_gpu() {
        for (cells, elements, of_a_cell) in [(4, "Hex8", 1.0), (8, "Hex8", 1.0), (6, "Tet4", 6.0)] {
            let mut simulation = run.start(&drilled(cells, elements, ""));
            let element = (0.02 / cells as f64).powi(3) / of_a_cell;
            let what = format!("{}, {cells} cells, {elements}", run.name);
            let mut before = 0.0;
            while simulation.time() < 0.2 {
                simulation.advance_to((simulation.time() + 0.02).min(0.2)).unwrap();
                let (taken, volume) = (2e-6 * simulation.time(), gone(&mut simulation));
                // one element that is not whole yet, and the ten steps until somebody looks
                let late = 2e-6 * 20.0 * simulation.time_step();
                assert!(volume <= taken * (1.0 + run.bound(1e-9, 1e-4)), "{what}: {volume} of {taken}");
                assert!(volume >= taken - late - element * 1.001, "{what}: {volume} of {taken}, elements of {element}");
                assert!(volume >= before, "{what}");
                before = volume;
                assert_eq!(odd_edges(&mut simulation, "b"), 0, "{what}");
            }
            let summary = simulation.summary("").unwrap();
            let count = summary.removed_elements as f64;
            assert!(count > 1.0, "{what}: {count}");
            near(&format!("{what}: elements"), before, count * element, before, run.bound(1e-9, 1e-4));
            near(
                &format!("{what}: mass"),
                summary.removed_mass,
                1000.0 * before,
                1000.0 * before,
                run.bound(1e-9, 1e-4),
            );
        }
    }
}

/// Work, losses and what went with the elements.
#[test]
fn energies_balance_while_a_tool_takes_elements() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&drilled(6, "Tet4", ""));
        for time in [0.1, 0.2] {
            simulation.advance_to(time).unwrap();
            let (e, tip) = (simulation.energies().unwrap(), simulation.tool("tip").unwrap());
            let held = e.kinetic + e.strain + e.hourglass + e.removed;
            let balance = e.load_work.unwrap() + e.constraint_work.unwrap() - e.damping_loss.unwrap() - held;
            let scale = tip.work.unwrap().abs().max(held);
            near(&format!("{} at {time}: {e:?}", run.name), balance, 0.0, scale, 5e-3);
            assert!(e.removed > 0.0, "{}: {e:?}", run.name);
        }
    }
}

/// While nothing is in reach nothing goes, whatever the rate.
#[test]
fn out_of_reach_nothing_goes() {
    for run in cpu_and_long_gpu() {
        let scene = drilled(4, "Hex8", "").replace("reach: 6e-3", "reach: 2e-3").replace("rate: 2e-6", "rate: 1");
        let mut simulation = run.start(&scene);
        // the first centroids are 2.5 mm below the surface, half a millimetre above which the tip begins
        simulation.advance_to(0.01).unwrap();
        assert_eq!(gone(&mut simulation), 0.0, "{}", run.name);
        simulation.advance_to(0.2).unwrap();
        assert!(gone(&mut simulation) > 0.0, "{}", run.name);
    }
}

/// Without a mouth a tool takes what is around it; what is not chosen stays; at most `burst` go at a time.
#[test]
fn a_ball_takes_what_is_around_it() {
    for run in cpu_and_long_gpu() {
        let scene = drilled(8, "Hex8", ", burst: 3, curve: Step(start: 0.05)")
            .replace("Tube(length: 0.03, inner: 3e-3, outer: 5e-3)", "Sphere(radius: 3e-3)")
            .replace("rounding: 5e-4,", "")
            .replace("0.0205", "0.0235")
            .replace("rate: 2e-6", "rate: 1")
            .replace("(when: InTool", "(on: Box(min: (0, 0, 0), max: (0.01, 0.02, 0.02)), when: InTool");
        let mut simulation = run.start(&scene);
        simulation.advance_to(0.049).unwrap();
        assert_eq!(gone(&mut simulation), 0.0, "{}", run.name);
        let element = 0.0025_f64.powi(3);
        while simulation.step_count() % 10 != 9 || simulation.time() < 0.052 {
            simulation.advance(1).unwrap();
        }
        let before = gone(&mut simulation);
        simulation.advance(1).unwrap();
        let after = gone(&mut simulation);
        near(&format!("{}: three at a time", run.name), after - before, 3.0 * element, element, 1e-3);
        simulation.advance_to(0.2).unwrap();
        let fields = simulation.fields("b").unwrap();
        let alive = &fields.alive;
        assert!(alive.iter().filter(|alive| **alive == 0).count() > 10, "{}", run.name);
        // cells go along x first: the right half has not been chosen
        let right = (0..512).filter(|cell| cell % 8 >= 4);
        assert!(right.into_iter().all(|cell| alive[cell] == 1), "{}", run.name);
    }
}

/// The volume of a cell of the bar (m³).
const CELL: f64 = 1.5625e-8;

/// A bar of cells of 2.5 mm and a ball that goes along the middle of its upper side.
fn passed(path: &str, takes: &str) -> String {
    format!(
        "(duration: 0.2, integration: (step: 2e-4),
        bodies: {{\"b\": (mesh: Box(size: (0.04, 0.01, 0.01), cells: (16, 4, 4), elements: Hex8), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3), damping: 50)}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        tools: {{\"tip\": (shape: Sphere(radius: 2e-3), path: [{path}])}},
        removal: [(when: InTool(tool: \"tip\", {takes}, crumb: 0))], probes: {{\"hole\": (what: RemovedVolume)}})"
    )
}

/// A tool that takes far more than there is clears all in its way, two cells at a time. When it is off it takes
/// nothing, though it goes on its way, and where it takes a ten thousandth, which is less than a cell until the end, no
/// more than the cell that it may have taken in: not what it would have taken where there was nothing.
#[test]
fn what_was_no_tissue_is_not_taken_elsewhere() {
    let path = "(t: 0, at: (0.001, 0.005, 0.01)), (t: 0.2, at: (0.039, 0.005, 0.01))";
    for run in cpu_and_long_gpu() {
        for (curve, most) in [("Step(end: 0.092)", 0.0), ("Table([(0.092, 1), (0.0921, 1e-4)])", 1.0)] {
            let mut simulation = run.start(&passed(path, &format!("reach: 1e-4, rate: 1e-4, curve: {curve}")));
            simulation.advance(460).unwrap();
            let before = gone(&mut simulation);
            near(&format!("{}, {curve}: on", run.name), before, 16.0 * CELL, CELL, 1e-3);
            simulation.advance_to(0.2).unwrap();
            let more = (gone(&mut simulation) - before) / CELL;
            assert!(more <= most + 1e-3, "{}, {curve}: {more} cells", run.name);
        }
    }
}

/// In ten steps it goes twice as far as it reaches: it is looked more often than that.
#[test]
fn a_quick_tip_leaves_no_gaps() {
    let path = "(t: 0, at: (0.001, 0.005, 0.01)), (t: 0.002, at: (0.001, 0.005, 0.01)), \
                (t: 0.012, at: (0.039, 0.005, 0.01))";
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&passed(path, "reach: 1e-4, rate: 1"));
        simulation.advance_to(0.014).unwrap();
        near(&format!("{}: all in its way", run.name), gone(&mut simulation), 32.0 * CELL, CELL, 1e-3);
    }
}

/// So it is of a wand that swings, and whose origin stands still.
#[test]
fn what_swings_leaves_no_gaps() {
    let swing = |at: f64| format!("(t: {at}, at: (0.02, 0.005, 0.05), rotation: (0, 150, 0))");
    let path = format!("{}, (t: 0.012, at: (0.02, 0.005, 0.05), rotation: (0, 210, 0))", swing(0.0));
    for run in cpu_and_long_gpu() {
        let [quick, slow] = [path.clone(), path.replace("0.012", "0.12")].map(|path| {
            let wand = "Capsule(length: 0.045, radius: 1.3e-3)";
            let scene = passed(&path, "reach: 1e-4, rate: 1").replace("Sphere(radius: 2e-3)", wand);
            let mut simulation = run.start(&scene);
            simulation.advance_to(0.14).unwrap();
            gone(&mut simulation) / CELL
        });
        // it may just meet a centroid or not
        assert!(slow > 20.0 && (quick - slow).abs() < 2.1, "{}: {quick} and {slow} cells", run.name);
    }
}

/// What a tool has taken in of a cell when it leaves the tissue is there when it comes again: in ten visits of .4 cells
/// each four go.
#[test]
fn what_was_tissue_is_not_lost_where_a_tool_leaves_it() {
    let visit = |number: u32| {
        let start = 0.02 * f64::from(number);
        let of = |time: f64, height: f64| format!("(t: {}, at: (0.02, 0.005, {height})), ", start + time);
        [of(0.0, 0.01), of(0.01, 0.01), of(0.0102, 0.03), of(0.0198, 0.03)].concat()
    };
    let path: String = (0..10).map(visit).collect();
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&passed(&path, "reach: 5e-3, rate: 6.25e-7"));
        simulation.advance_to(0.2).unwrap();
        // .01 s of each visit, and up to ten steps of .2 ms until somebody looks
        let cells = gone(&mut simulation) / CELL;
        assert!((2.9..5.1).contains(&cells), "{}: {cells} cells", run.name);
    }
}

/// What `burst` keeps back waits, and is told of.
#[test]
fn what_waits_for_its_burst_is_told() {
    let path = "(t: 0, at: (0.02, 0.005, 0.01))";
    for run in cpu_and_long_gpu() {
        let of = |burst: u32| {
            let takes = format!("reach: 5e-3, rate: 3e-5, burst: {burst}");
            let mut simulation = run.start(&passed(path, &takes));
            simulation.advance(200).unwrap();
            (gone(&mut simulation), simulation.tool("tip").unwrap().waiting)
        };
        let (gone, waiting) = of(1);
        // nobody has looked since the 190th step; a cell that is not whole and ten steps are no matter of `burst`
        let (taken, usual) = (190.0 * 2e-4 * 3e-5, CELL + 10.0 * 2e-4 * 3e-5);
        near(run.name, waiting, taken - gone - usual, taken, 1e-3);
        assert!(gone < 0.3 * taken, "{}: {gone} of {taken}", run.name);
        assert_eq!(of(64).1, 0.0, "{}", run.name);
    }
}

/// A rate below 0 is none: what it would have given back is not taken in again before the next cell goes.
#[test]
fn a_rate_below_zero_gives_nothing_back() {
    let path = "(t: 0, at: (0.02, 0.005, 0.01))";
    for run in cpu_and_long_gpu() {
        let of = |off: f64| {
            let curve = format!("Table([(0, {off:?}), (0.05, {off:?}), (0.0501, 0), (0.1, 0), (0.1001, 1)])");
            let takes = format!("reach: 5e-3, rate: 3e-6, curve: {curve}");
            let mut simulation = run.start(&passed(path, &takes));
            simulation.advance_to(0.14).unwrap();
            (gone(&mut simulation) / CELL, bits_of(&mut simulation))
        };
        let ((cells, bits), (others, other_bits)) = (of(-1.0), of(0.0));
        // .04 s, less what is no cell yet and ten steps of .2 ms until somebody looks
        assert!((6.0..7.7).contains(&cells) && cells == others, "{}: {cells} and {others} cells", run.name);
        assert!(bits == other_bits, "{}: other bits", run.name);
    }
}

fn bits_of(simulation: &mut Simulation) -> Vec<u64> {
    let alive = simulation.fields("b").unwrap().alive;
    let u = simulation.displacements("b").unwrap();
    let numbers = u.iter().flat_map(|u| u.to_array()).chain(alive.into_iter().map(f64::from));
    numbers.map(f64::to_bits).collect()
}

/// Threads and snapshots, at any step: the same bits.
#[test]
fn bits_with_what_tools_take_do_not_depend_on_how_steps_are_taken() {
    for run in cpu_and_long_gpu() {
        let of = |threads: usize, resume: Option<u64>| {
            let scene =
                scene_of(&drilled(8, "Tet4", "").replace("rate: 2e-6", "rate: 2e-5"), std::path::Path::new("."));
            let options = Options { threads, ..run.options.clone() };
            let mut simulation = Simulation::new(&scene, &options).unwrap();
            if let Some(step) = resume {
                simulation.advance(step).unwrap();
                let snapshot = simulation.snapshot().unwrap();
                simulation = Simulation::new(&scene, &options).unwrap();
                simulation.restore(&snapshot).unwrap();
            }
            simulation.advance(100 - simulation.step_count()).unwrap();
            assert!(gone(&mut simulation) > 0.0, "{}: nothing has gone", run.name);
            bits_of(&mut simulation)
        };
        let first = of(1, None);
        for step in [37, 40] {
            assert!(first == of(1, Some(step)), "{}: resumed at {step}", run.name);
        }
        if !is_gpu(&run) {
            [2, 3].into_iter().for_each(|n| assert!(first == of(n, None), "{}: {n} threads", run.name));
        }
    }
}

fn is_gpu(run: &Configuration) -> bool {
    run.options.precision == Precision::F32 && run.name.starts_with("GPU")
}
