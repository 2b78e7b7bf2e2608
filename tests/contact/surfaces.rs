//! Bodies against each other and themselves: closed forms of impact and rest, momentum, energy, bits.

use crate::bits::bits;
use crate::configurations::{ELEMENTS, configurations, cpu_and_long_gpu, near};
use glam::DVec3;
use sinew::Simulation;
use sinew::components::{
    ContactForce, Displacement, DisplacementIncrement, MEETING_NUMBERS, Precision, SurfaceTouch, WORK_NUMBERS, Work,
};
use sinew::mesh::{Locator, Mesh};
use sinew::systems::{Registry, SurfaceContacts};

const TISSUE: &str = "\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))";

/// Momentum of a body (kg m/s), in the middle of the last step.
fn momentum(simulation: &mut Simulation, body: &str) -> DVec3 {
    let masses = simulation.masses(body).unwrap();
    let rate = 1.0 / simulation.time_step();
    let view = simulation.column::<DisplacementIncrement>(body).unwrap();
    let steps: Vec<DVec3> = view.node_rows().iter().map(|&row| view.values().vector(row as usize)).collect();
    masses.iter().zip(steps).map(|(mass, step)| step * rate * *mass).sum()
}

/// The sum of what others do to a body (N).
fn force(simulation: &mut Simulation, body: &str) -> DVec3 {
    simulation.column::<ContactForce>(body).unwrap().values().vectors().sum()
}

/// Two equal bars in uniaxial strain, one at rest, one that comes: they touch for 2 L/c, the force is ρ c A v/2, and
/// they exchange their velocities. The law loses the kinetic energy of the touching half layers: 1/(4n) to 1/(8n).
#[test]
fn two_bars_exchange_their_velocities() {
    let (length, speed, side) = (0.1, 0.02, 0.01_f64);
    let modulus: f64 = 3000.0 * 0.55 / (1.45 * 0.1);
    let c = (modulus / 1000.0).sqrt();
    for run in cpu_and_long_gpu() {
        for cells in [40, 80] {
            let bar = format!("mesh: Box(size: ({side}, {side}, {length}), cells: (1, 1, {cells})), material: \"m\"");
            let mut simulation = run.start(&format!(
                "(duration: 0.1, bodies: {{\"low\": ({bar}), \"high\": ({bar}, translate: (0, 0, {}), velocity: (0, 0, -{speed}))}},
                materials: {{{TISSUE}}}, integration: (step: 1e-4),
                constraints: [Fixed(body: \"low\", on: All, axes: [X, Y]), Fixed(body: \"high\", on: All, axes: [X, Y])],
                contacts: [Between(bodies: (\"low\", \"high\"))], output: (energies_every: 0.01))",
                length + 1e-5
            ));
            let what = format!("{}, {cells} cells", run.name);
            let (mut impulse, mut first, mut last, mut mean, mut count) = (0.0, f64::NAN, 0.0, 0.0, 0.0);
            let masses: f64 = simulation.masses("high").unwrap().iter().sum();
            while simulation.time() < 0.085 {
                simulation.advance(1).unwrap();
                let pushed = force(&mut simulation, "high").z;
                impulse += pushed * simulation.time_step();
                if pushed > 0.0 {
                    last = simulation.time();
                    if first.is_nan() {
                        first = last;
                    }
                }
                let share = simulation.time() * c / (2.0 * length);
                if share > 0.25 && share < 0.75 {
                    (mean, count) = (mean + pushed, count + 1.0);
                }
            }
            let exact = 1000.0 * c * side * side * speed / 2.0;
            near(&what, mean / count, exact, exact, 0.015);
            let [low, high] = ["low", "high"].map(|body| momentum(&mut simulation, body).z);
            let all = masses * speed;
            near(&what, low + high, -all, all, run.bound(1e-12, 1e-5));
            near(&what, impulse, all, all, 0.02);
            near(&what, low, -all, all, 0.02);
            near(&what, last - first, 2.0 * length / c, 2.0 * length / c, 0.04);
            let energies = simulation.energies().unwrap();
            let start = 0.5 * masses * speed * speed;
            // nobody else does work
            let lost = energies.contact_loss.unwrap();
            assert!(lost > 0.0, "{what}: lost {lost} J");
            near(&what, energies.load_work.unwrap(), -lost, start, run.bound(1e-12, 1e-5));
            // nor to one of them alone: what comes loses all that it has, and the other gets it
            for body in ["low", "high"] {
                let taken = simulation.contact(body).unwrap().loss.unwrap();
                let view = simulation.column::<Work>(body).unwrap();
                let work: f64 = (0..view.values().len()).step_by(WORK_NUMBERS).map(|i| view.values().get(i)).sum();
                near(&format!("{what}, {body}"), work, -taken, start, run.bound(1e-12, 3e-5));
                near(&format!("{what}, {body}"), taken.abs(), start, start, 0.1);
            }
            let share = (energies.kinetic + energies.internal_work.unwrap()) / start;
            assert!(share >= 1.0 - 1.0 / f64::from(cells) && share <= 1.001, "{what}: {share} of the energy");
        }
    }
}

/// Two cubes of 2 cm, one on the other, with meshes that do not match, on a table that weighs them: 2 m g below, m g
/// between, and nobody creeps.
#[test]
#[ignore = "long"]
fn a_stack_bears_its_weight_and_stands_still() {
    let weight = 1000.0 * 8e-6 * 9.81;
    for run in configurations() {
        // a step on a GPU comes to the host and goes back
        let on_gpu = run.name.starts_with("GPU");
        for cells in if on_gpu { vec![4] } else { vec![3, 4] } {
            let mut simulation = run.start(&format!(
                "(duration: 2, bodies: {{
                    \"low\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3)), material: \"m\"),
                    \"high\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: ({cells}, {cells}, 3)), material: \"m\", translate: (0, 0, 0.02))}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 20)}},
                loads: [Gravity(body: \"low\", acceleration: (0, 0, -9.81)), Gravity(body: \"high\", acceleration: (0, 0, -9.81))],
                tools: {{\"table\": (shape: Plane())}}, integration: (step: 5e-4),
                contacts: [Tool(tool: \"table\", body: \"low\", friction: 0.5), Between(bodies: (\"low\", \"high\"), friction: 0.5)])"
            ));
            simulation.advance_to(1.5).unwrap();
            let earlier = simulation.displacements("high").unwrap();
            simulation.advance_to(2.0).unwrap();
            let what = format!("{}, {cells} cells above", run.name);
            let moved = simulation.displacements("high").unwrap().into_iter().zip(earlier);
            let farthest = moved.map(|(now, then)| now.distance(then)).fold(0.0, f64::max);
            assert!(farthest < 1e-7, "{what}: {farthest} m in half a second");
            let between = force(&mut simulation, "high");
            near(&what, between.z, weight, weight, 1e-3);
            near(&what, between.truncate().length(), 0.0, weight, 1e-3);
            near(&what, (force(&mut simulation, "low") + between).length(), 0.0, weight, run.bound(1e-12, 1e-5));
            near(&what, -simulation.tool("table").unwrap().force.z, 2.0 * weight, weight, 2e-3);
            // what one sweep leaves: .13 h p/E is .4 mm × the pressure 200 Pa over 3 kPa
            let view = simulation.column::<SurfaceTouch>("high").unwrap();
            let numbers = view.values();
            let gap = |row: usize| numbers.get(MEETING_NUMBERS * row + 5);
            let least = (0..numbers.len() / MEETING_NUMBERS).map(gap).fold(0.0, f64::min);
            assert!(least > -0.2 * (0.02 / 3.0) * (weight / 4e-4) / 3e3, "{what}: {least} m");
        }
    }
}

/// Two free cubes that meet obliquely: momentum and its moment are kept, and energy is never made.
#[test]
fn an_oblique_collision_keeps_momentum_and_its_moment() {
    for run in cpu_and_long_gpu() {
        for friction in ["0", "0.4"] {
            let cube = "mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\"";
            let other = "mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3)), material: \"m\"";
            let mut simulation = run.start(&format!(
                "(duration: 0.05, bodies: {{\"a\": ({cube}),
                    \"b\": ({other}, rotate: (20, 35, 10), translate: (0.012, 0.008, 0.032), velocity: (-0.1, 0.02, -0.5))}},
                materials: {{{TISSUE}}}, contacts: [Between(bodies: (\"a\", \"b\"), friction: {friction})],
                output: (energies_every: 0.001))"
            ));
            let moments = |simulation: &mut Simulation| {
                let (mut momentum, mut moment) = (DVec3::ZERO, DVec3::ZERO);
                for body in ["a", "b"] {
                    let masses = simulation.masses(body).unwrap();
                    let rest = simulation.rest_positions(body).unwrap();
                    let u = simulation.displacements(body).unwrap();
                    let rate = 1.0 / simulation.time_step();
                    let view = simulation.column::<DisplacementIncrement>(body).unwrap();
                    for (node, &row) in view.node_rows().iter().enumerate() {
                        let step = view.values().vector(row as usize);
                        let p = step * rate * masses[node];
                        momentum += p;
                        moment += (rest[node] + u[node] - 0.5 * step).cross(p);
                    }
                }
                (momentum, moment)
            };
            simulation.advance(1).unwrap();
            let (momentum, moment) = moments(&mut simulation);
            let before = simulation.energies().unwrap();
            let before = before.kinetic + before.internal_work.unwrap();
            let (mut most, mut highest) = (0.0_f64, 0.0_f64);
            while simulation.time() < 0.05 {
                simulation.advance(5).unwrap();
                most = most.max(force(&mut simulation, "b").length());
                let now = simulation.energies().unwrap();
                let share = (now.kinetic + now.internal_work.unwrap()) / before;
                highest = highest.max(share);
                assert!(share <= 1.0 + run.bound(1e-9, 1e-5), "{}: {now:?} of {before} J", run.name);
            }
            assert!(most > 0.1, "they never met: {most} N");
            let (now, moment_now) = moments(&mut simulation);
            let what = format!("{}, friction {friction}", run.name);
            println!("{what}: at most {highest} of the energy");
            let scale = momentum.length();
            near(&what, (now - momentum).length(), 0.0, scale, run.bound(1e-10, 1e-5));
            // friction acts across the gap between a point and its face
            let bound = if friction == "0" { run.bound(1e-10, 1e-5) } else { 1e-3 };
            near(&what, (moment_now - moment).length(), 0.0, scale * 0.02, bound);
        }
    }
}

/// Two cubes of every kind of element that meet face on: momentum stays, none is inside the other, and the law loses no
/// more than touching half layers.
#[test]
fn cubes_of_every_kind_of_element_bounce_off_each_other() {
    for run in cpu_and_long_gpu() {
        for elements in ELEMENTS {
            let cube = |cells: u32| {
                format!(
                    "mesh: Box(size: (0.02, 0.02, 0.02), cells: ({cells}, {cells}, {cells}), elements: {elements}), material: \"m\""
                )
            };
            let mut simulation = run.start(&format!(
                "(duration: 0.05, bodies: {{\"a\": ({}), \"b\": ({}, translate: (0.003, 0.002, 0.0201), velocity: (0, 0, -0.2))}},
                materials: {{{TISSUE}}}, contacts: [Between(bodies: (\"a\", \"b\"))], output: (energies_every: 0.01))",
                cube(4),
                cube(3)
            ));
            let what = format!("{}, {elements}", run.name);
            let before = simulation.energies().unwrap().kinetic;
            let momentum_before = momentum(&mut simulation, "b").z;
            let mut most = 0.0_f64;
            let mut deepest = 0.0_f64;
            while simulation.time() < 0.05 {
                simulation.advance(3).unwrap();
                most = most.max(force(&mut simulation, "b").z);
                for body in ["a", "b"] {
                    let view = simulation.column::<SurfaceTouch>(body).unwrap();
                    let numbers = view.values();
                    let gaps = (0..numbers.len() / MEETING_NUMBERS).map(|row| numbers.get(MEETING_NUMBERS * row + 5));
                    deepest = gaps.fold(deepest, f64::min);
                }
            }
            let [a, b] = ["a", "b"].map(|body| momentum(&mut simulation, body).z);
            near(&what, a + b, momentum_before, momentum_before, run.bound(1e-10, 1e-5));
            assert!(a < 0.5 * momentum_before, "{what}: {a} of {momentum_before} kg m/s went over");
            let energies = simulation.energies().unwrap();
            let share = (energies.kinetic + energies.internal_work.unwrap()) / before;
            println!("{what}: {share:.4} of the energy, {deepest:.2e} m, {most:.3} N");
            assert!(share > 0.8 && share <= 1.0 + run.bound(1e-9, 1e-5), "{what}: {share} of the energy");
            assert!(deepest > -2.5e-4, "{what}: {deepest} m");
        }
    }
}

/// The same bits for any number of threads, fused or not, from any step on, and whatever the lists' skin.
#[test]
fn bits_do_not_depend_on_threads_lists_or_pauses() {
    let scene = "(duration: 0.04, bodies: {
            \"a\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (8, 8, 8)), material: \"m\"),
            \"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (6, 6, 6)), material: \"m\", rotate: (20, 35, 10),
                translate: (0.012, 0.008, 0.032), velocity: (-0.1, 0.02, -0.8))},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
        contacts: [Between(bodies: (\"a\", \"b\"), friction: 0.3)])";
    for precision in [Precision::F32, Precision::F64] {
        let start = |threads: usize, text: &str| crate::bits::start(text, precision, threads);
        let found = |simulation: &mut Simulation| bits(simulation, &["a", "b"]);
        let mut one = start(1, scene);
        while force(&mut one, "b").length() == 0.0 {
            assert!(one.time() < 0.04, "they never touch");
            one.advance(1).unwrap();
        }
        one.advance(30).unwrap();
        let steps = one.step_count();
        let wanted = found(&mut one);
        let mut other = start(3, scene);
        other.advance(steps).unwrap();
        assert!(found(&mut other) == wanted, "3 threads, {precision:?}");
        let mut unfused = start(2, &scene.replace("duration", "fuse: false, duration"));
        unfused.advance(steps).unwrap();
        assert!(found(&mut unfused) == wanted, "not fused, {precision:?}");
        for skin in [1e-9, 3.0] {
            let mut other = start(1, scene);
            other.world_mut().resource_mut::<SurfaceContacts>().skin = skin;
            other.advance(steps).unwrap();
            assert!(found(&mut other) == wanted, "skin {skin}, {precision:?}");
        }
        let mut paused = start(1, scene);
        paused.advance(steps - 25).unwrap();
        let kept = paused.snapshot().unwrap();
        paused.advance(40).unwrap();
        paused.restore(&kept).unwrap();
        paused.advance(25).unwrap();
        assert!(found(&mut paused) == wanted, "taken back, {precision:?}");
        let mut resumed = start(1, scene);
        resumed.restore(&kept).unwrap();
        resumed.advance(25).unwrap();
        assert!(found(&mut resumed) == wanted, "resumed, {precision:?}");
    }
}

/// A tube that two plates press flat: its wall meets itself, and does not pass.
#[test]
fn a_tube_pressed_flat_does_not_pass_itself() {
    for run in cpu_and_long_gpu() {
        let scene = |contact: &str| {
            format!(
                "(duration: 0.4, bodies: {{\"t\": (mesh: Tube(inner: 0.008, outer: 0.01, height: 0.01, cells: (2, 24, 4)), material: \"m\", rotate: (0, 90, 0))}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3), damping: 50)}},
                tools: {{\"top\": (shape: Plane(), rotation: (180, 0, 0), at: (0, 0, 0.0101), moves: [(displacement: (0, 0, -0.0084), curve: Smooth(end: 0.35))]),
                    \"bottom\": (shape: Plane(), at: (0, 0, -0.0101), moves: [(displacement: (0, 0, 0.0084), curve: Smooth(end: 0.35))])}},
                contacts: [Tool(tool: \"top\"), Tool(tool: \"bottom\"){contact}])"
            )
        };
        let mut passed = None;
        // once is enough
        if run.options.precision == Precision::F64 {
            let mut alone = run.start(&scene(""));
            alone.advance_to(0.4).unwrap();
            passed = Some(passed_by(&mut alone, &scene("")));
            assert!(passed > Some(10), "without contact the walls pass each other: {passed:?} nodes");
        }
        let mut simulation = run.start(&scene(", Itself()"));
        simulation.advance_to(0.4).unwrap();
        let view = simulation.column::<SurfaceTouch>("t").unwrap();
        let numbers = view.values();
        let rows = numbers.len() / MEETING_NUMBERS;
        let touching = (0..rows).filter(|row| numbers.get(MEETING_NUMBERS * row + 4) > 1.0).count();
        let deepest = (0..rows).map(|row| numbers.get(MEETING_NUMBERS * row + 5)).fold(0.0, f64::min);
        println!("{}: {touching} nodes touch, {deepest:.2e} m; without contact {passed:?} are inside", run.name);
        assert!(touching > 30 && deepest > -2e-4, "{}: {touching} touch, {deepest} m", run.name);
        assert_eq!(passed_by(&mut simulation, &scene("")), 0, "{}", run.name);
    }
}

/// How many nodes of the upper half of the tube are a tenth of an edge (.2 mm) deep in elements of the lower half.
fn passed_by(simulation: &mut Simulation, scene: &str) -> usize {
    let file = crate::configurations::scene_of(scene, std::path::Path::new("."));
    let mut mesh = sinew::assembly::mesh_of(&file.scene.bodies["t"], &file).unwrap();
    let rest = simulation.rest_positions("t").unwrap();
    let u = simulation.displacements("t").unwrap();
    mesh.points = rest.iter().zip(u).map(|(place, u)| *place + u).collect();
    let below = |element: &usize| mesh.element(*element).iter().all(|&node| rest[node as usize].z < -1e-3);
    let lower = mesh.cells.select((0..mesh.element_count()).filter(below), |node| node);
    let lower = Mesh { points: mesh.points.clone(), cells: lower, ..Mesh::default() };
    let locator = Locator::new(&lower);
    let upper = rest.iter().zip(&mesh.points).filter(|(rest, _)| rest.z > 1e-3);
    upper.filter(|(_, place)| locator.holds(**place + DVec3::Z * 2e-4).is_some()).count()
}

/// Who asks what runs leaves it alone: on a GPU its lists of what may be near what, and where they lie.
#[test]
fn a_run_that_is_explained_goes_on_as_if_it_were_not() {
    for run in cpu_and_long_gpu() {
        let block = "mesh: Box(size: (0.02, 0.02, 0.02), cells: (2, 2, 2)), material: \"m\"";
        let text = format!(
            "(duration: 0.2, bodies: {{\"low\": ({block}), \"high\": ({block}, translate: (0.005, 0, 0.021))}},
            materials: {{{TISSUE}}}, loads: [Gravity(acceleration: (0, 0, -9.81))],
            constraints: [Fixed(body: \"low\", on: Set(\"z0\"))], contacts: [Between(bodies: (\"low\", \"high\"))])"
        );
        let [mut asked, mut left_alone] = [run.start(&text), run.start(&text)];
        for time in [0.02, 0.05, 0.1] {
            asked.advance_to(time).unwrap();
            left_alone.advance_to(time).unwrap();
            asked.explain(&Registry::default()).unwrap();
            if run.options.precision == Precision::F32 {
                asked.explain_on_gpu(&Registry::default()).unwrap();
            }
        }
        assert!(force(&mut asked, "high").z > 0.0, "{}: they do not touch", run.name);
        assert!(bits(&mut asked, &["low", "high"]) == bits(&mut left_alone, &["low", "high"]), "{}", run.name);
    }
}

/// Bodies that are far apart sleep, by what their steps add up to; one that a program puts beside the other is seen in
/// the next step all the same.
#[test]
fn a_body_that_is_put_beside_another_is_seen_at_once() {
    for run in configurations().into_iter().filter(|run| !run.name.starts_with("GPU")) {
        let block = "mesh: Box(size: (0.02, 0.02, 0.02), cells: (2, 2, 2)), material: \"m\"";
        let mut simulation = run.start(&format!(
            "(duration: 2, bodies: {{\"low\": ({block}),
                \"high\": ({block}, translate: (0.003, 0, 0.5), velocity: (0, 0, -0.5))}},
            materials: {{{TISSUE}}}, contacts: [Between(bodies: (\"low\", \"high\"))], guards: (off: [Energy]))"
        ));
        simulation.advance(100).unwrap();
        let figures = simulation.world().resource::<SurfaceContacts>().figures();
        assert!(figures.asleep >= 99 && figures.builds == 1, "{}: {figures:?}", run.name);
        let high = simulation.body("high").unwrap();
        let mut u = simulation.world_mut().get_mut::<Displacement>(high).unwrap();
        for row in 0..u.len() / 3 {
            let at = u.vector(row);
            u.set_vector(row, DVec3::new(at.x, at.y, 1e-6 - 0.48));
        }
        simulation.advance(1).unwrap();
        assert!(force(&mut simulation, "high").z > 0.0, "{}", run.name);
    }
}

/// Copies that stand on each other at rest meet, with nodes, faces and edges: what is near at rest is left out of one
/// piece of a body alone.
#[test]
fn copies_that_touch_at_rest_meet() {
    for more in ["", ", points: Faces", ", edges: true"] {
        let text = format!(
            "(duration: 0.3, bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (2, 2, 2)), material: \"m\",
                copies: 2, apart: (0, 0, 0.01))}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.3), damping: 30)}},
            constraints: [Fixed(on: Set(\"copy 0\"))], contacts: [Itself(sweeps: 4{more})],
            loads: [Gravity(acceleration: (0, 0, -9.81))])"
        );
        let mut simulation = crate::bits::start(&text, Precision::F64, 1);
        let warned: Vec<String> =
            simulation.summary("").unwrap().guards.warnings.iter().map(|of| of.message.clone()).collect();
        assert!(warned.iter().all(|message| !message.contains("never meet")), "{warned:?}");
        simulation.finish().unwrap();
        let u = simulation.displacements("b").unwrap();
        let lowest = u.iter().map(|u| u.z).fold(0.0, f64::min);
        // under its weight, which comes at once, its top goes down by 2 ρ g H²/2E = 33 µm; one that falls goes 44 cm
        assert!(lowest > -3.6e-5 && lowest < -1e-7, "{more}: {lowest}");
    }
}
