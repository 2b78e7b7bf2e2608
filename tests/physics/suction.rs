//! Suction (C28): a closed mouth holds by Δp π r², an open one by χ² of that of what closes it; who is sucked and who
//! sucks feel the same.
//!
//! Faces at the mouth's edge count by the share that is within: at six faces on the radius the area is that of the
//! circle to .5 %, so that χ² times it is Δp π r² to 1.5 %; 3 % are allowed.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, near, scene_of};
use sinew::components::Precision;
use sinew::{Options, Simulation};
use std::f64::consts::PI;

const BORE: f64 = 6e-3;
const PRESSURE: f64 = 1e3;

/// A plate of which all waves die away in a fiftieth of a second: damping of 2000/s takes any that is quicker than
/// 1000/s down by e^-20, and the slowest, of the thickness, has π/2 · 20 m/s / 4 mm = 7900/s. Ten times less steps than
/// with 200/s, and the same rest.
fn calm(elements: &str) -> String {
    plate(elements, GLUED, "").replace("damping: 200", "damping: 2000").replace("duration: 0.2", "duration: 0.02")
}

/// A stiff plate of 20 × 20 × 4 mm, and a tube over it, .2 mm off and a little off its middle.
fn plate(elements: &str, held: &str, rest: &str) -> String {
    format!(
        "(duration: 0.2, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.004), cells: (20, 20, 2),
            elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e5, poisson: 0.3), damping: 200)}},
        {held} tools: {{\"tip\": (shape: Tube(length: 0.03, inner: {BORE}, outer: 8e-3), at: (0.0103, 0.0099, 0.0042))}},
        contacts: [Tool(tool: \"tip\")],
        suction: [(tool: \"tip\", pressure: {PRESSURE}, reach: 5e-4 {rest})],
        probes: {{\"felt\": (what: ToolForce(tool: \"tip\")), \"held\": (what: Reaction, on: Plane(normal: (0, 0, 1), at: 0))}},
        output: (energies_every: 0.05))"
    )
}

const GLUED: &str = "constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],";

/// 4 mm in ten steps, and a reach of .5 mm: when nothing is in the mouth any more nothing is sucked.
#[test]
fn the_pull_of_a_quick_mouth_does_not_trail_behind() {
    let scene = plate("Hex8", GLUED, "")
        .replace(
            "at: (0.0103, 0.0099, 0.0042)",
            "path: [(t: 0, at: (0.0115, 0.01, 0.0042)), (t: 1e-3, at: (0.0315, 0.01, 0.0042))]",
        )
        .replace("contacts: [Tool(tool: \"tip\")],", "integration: (step: 2e-5),");
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&scene);
        simulation.advance(1).unwrap();
        assert!(simulation.tool("tip").unwrap().suction.length() > 0.0, "{}", run.name);
        while simulation.tool("tip").unwrap().suction.length() > 0.0 {
            simulation.advance(1).unwrap();
            let edge = 0.0115 + 20.0 * simulation.time() - BORE;
            assert!(edge < 0.02 + 1e-3, "{}: the mouth's edge is at {edge} m", run.name);
        }
    }
}

#[test]
#[ignore = "long"]
fn a_closed_mouth_pulls_by_pressure_times_area() {
    for run in configurations() {
        for elements in ["Hex8", "Tet4", "Tet10"] {
            let mut simulation = run.start(&calm(elements));
            simulation.advance_to(0.02).unwrap();
            let expected = PRESSURE * PI * BORE * BORE;
            let what = format!("{}, {elements}", run.name);
            let (felt, held) = (simulation.probe("felt").unwrap(), simulation.probe("held").unwrap());
            near(&format!("{what}: felt"), -felt[2], expected, expected, 0.03);
            near(&format!("{what}: held"), -held[2], -felt[2], expected, 1e-3);
            let reading = simulation.tool("tip").unwrap();
            assert_eq!(reading.nodes, 0, "{what}: nothing touches");
            assert_eq!(reading.force, reading.suction, "{what}");
            // about the tool's origin the pull is along its axis
            near(&format!("{what}: moment"), reading.torque.length(), 0.0, expected * BORE, 0.02);
        }
    }
}

/// Whatever faces are in the mouth, larger ones than itself, too: it is closed.
#[test]
fn the_pull_does_not_ask_how_fine_faces_are() {
    let bore = 3e-3;
    for run in cpu_and_long_gpu() {
        for elements in ["Hex8", "Tet4", "Wedge6", "Tet10"] {
            for (cells, shift) in [1, 3, 4, 6, 10, 30].into_iter().flat_map(|cells| [0.0, 1.5e-3].map(|by| (cells, by)))
            {
                let scene = format!(
                    "(duration: 0.01, bodies: {{\"b\": (mesh: Box(size: (0.03, 0.03, 0.005), cells: ({cells}, {cells}, 1),
                        elements: {elements}), material: \"m\")}}, constraints: [Fixed(on: All)],
                    materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e5, poisson: 0.3))}},
                    tools: {{\"tip\": (shape: Tube(length: 0.03, inner: {bore}, outer: 4e-3), at: ({}, 0.0147, 0.007),
                        rotation: (10, 0, 0))}},
                    suction: [(tool: \"tip\", pressure: {PRESSURE}, reach: 3e-3)])",
                    0.015 + shift
                );
                let mut simulation = run.start(&scene);
                simulation.advance(2).unwrap();
                let pull = -simulation.tool("tip").unwrap().suction.z;
                let what = format!("{}, {elements}, {cells} cells, {shift} m", run.name);
                // seen along the axis the mouth is closed; faces are as much larger as they lie aslant
                let expected = PRESSURE * PI * bore * bore / 10.0_f64.to_radians().cos();
                near(&what, pull, expected, expected, run.bound(1e-6, 1e-4));
            }
        }
    }
}

/// Areas are found from places on the face: a thousand metres from the origin they have all their digits.
#[test]
fn far_away_tools_suck_and_pressures_push_as_near() {
    for run in cpu_and_long_gpu() {
        let of = |away: f64| {
            let mut simulation = run.start(&format!(
                "(duration: 0.01, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.004), cells: (7, 7, 2), elements: Tet4),
                    material: \"m\", rotate: (0, 20, 30), translate: ({away}, {}, {}))}},
                constraints: [Fixed(on: All)], loads: [Pressure(on: Surface(), pressure: 100)],
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e5, poisson: 0.3))}},
                tools: {{\"tip\": (shape: Tube(length: 0.03, inner: 6e-3, outer: 8e-3), at: ({}, {}, {}))}},
                suction: [(tool: \"tip\", pressure: {PRESSURE}, reach: 9e-3)],
                probes: {{\"held\": (what: Reaction, on: All), \"one\": (what: Reaction, on: Nodes([0, 5, 17]))}})",
                -away,
                0.5 * away,
                away + 0.009,
                -away + 0.013,
                0.5 * away + 0.004
            ));
            simulation.advance(2).unwrap();
            let felt = simulation.tool("tip").unwrap().force.to_array();
            [felt.to_vec(), simulation.probe("held").unwrap(), simulation.probe("one").unwrap()].concat()
        };
        let (near_by, far) = (of(0.0), of(1000.0));
        for (a, b) in near_by.iter().zip(&far) {
            near(run.name, *b, *a, near_by[2], run.bound(1e-9, 1e-5));
        }
    }
}

/// Faces of the far side are turned away from the mouth: a reach through all of the plate sucks no more and no less.
#[test]
fn what_is_behind_the_tissue_is_not_sucked() {
    for run in cpu_and_long_gpu() {
        for elements in ["Hex8", "Tet4", "Tet10"] {
            let of = |reach: &str| {
                let mut simulation = run.start(&calm(elements).replace("reach: 5e-4", reach));
                simulation.advance(25).unwrap();
                let pull = -simulation.probe("felt").unwrap()[2];
                assert!(pull > 0.5 * PRESSURE * PI * BORE * BORE, "{}, {elements}, {reach}: {pull} N", run.name);
                bits_of(&mut simulation)
            };
            assert!(of("reach: 5e-4") == of("reach: 1e-2"), "{}, {elements}", run.name);
        }
    }
}

/// A plate that is drawn away with less than the mouth holds stays at it, with more it comes off.
#[test]
#[ignore = "long"]
fn a_plate_comes_off_beyond_the_holding_force() {
    for run in configurations() {
        for (share, stays) in [(0.93, true), (1.06, false)] {
            let weight = 1000.0 * 0.02 * 0.02 * 0.004;
            let g = share * PRESSURE * PI * BORE * BORE / weight;
            let loads = format!(
                "loads: [Gravity(acceleration: (0, 0, -{g}), curve: Smooth(start: 0.05, end: 0.15))],
                constraints: [Fixed(on: All, axes: [X, Y])], integration: (safety: 0.3),"
            );
            // sucked at once it would hit the tube, and waves of a few steps a period are counted to a few percent
            let mut simulation = run.start(&plate("Hex8", &loads, ", curve: Smooth(end: 0.04)"));
            simulation.advance_to(0.2).unwrap();
            let low = simulation.displacements("b").unwrap().iter().map(|u| u.z).fold(f64::INFINITY, f64::min);
            assert_eq!(low > -2e-4, stays, "{}: at {share} of the force the plate is {low:e} m off", run.name);
        }
    }
}

/// A mouth that is half over the edge of the plate leaks: χ is a half, and a quarter of the pressure is left.
#[test]
#[ignore = "long"]
fn an_open_mouth_leaks() {
    for run in configurations() {
        let scene = plate("Hex8", GLUED, ", delay: 0.05").replace("at: (0.0103, 0.0099,", "at: (0.0, 0.0099,");
        let mut simulation = run.start(&scene);
        let expected = PRESSURE * PI * BORE * BORE / 8.0;
        simulation.advance_to(0.05).unwrap();
        // follows from the first step on
        let share = 1.0 - (-1.0_f64).exp();
        near(
            &format!("{}: after the delay", run.name),
            -simulation.probe("felt").unwrap()[2],
            share * expected,
            expected,
            0.03,
        );
        simulation.advance_to(0.2).unwrap();
        let share = 1.0 - (-4.0_f64).exp();
        near(
            &format!("{}: after four", run.name),
            -simulation.probe("felt").unwrap()[2],
            share * expected,
            expected,
            0.03,
        );
    }
}

/// What removal bares is sucked in the next step; the energy of it all balances.
#[test]
#[ignore = "long"]
fn bared_faces_are_sucked_at_once() {
    for run in cpu_and_long_gpu() {
        let rest = ", delay: 0.005, curve: Smooth(end: 0.05)), (tool: \"tip\", pressure: 1, bore: 1e-9, reach: 1e-9";
        // where faces change the force jumps: waves of a few steps a period are counted to a few percent
        let scene = plate("Hex8", &format!("{GLUED} integration: (safety: 0.3),"), rest)
            .replace("reach: 5e-4", "reach: 2.5e-3")
            .replace(
                "probes:",
                "removal: [(on: Box(min: (0, 0, 0.002), max: (0.02, 0.02, 0.004)), when: At(0.1))], probes:",
            );
        let mut simulation = run.start(&scene);
        // a check follows removal at once where both are in a tenth step
        simulation.advance_to(0.1).unwrap();
        simulation.advance(30).unwrap();
        assert_eq!(simulation.summary("").unwrap().removed_elements, 400, "{}", run.name);
        let expected = PRESSURE * PI * BORE * BORE;
        near(run.name, -simulation.probe("felt").unwrap()[2], expected, expected, 0.03);
        let e = simulation.energies().unwrap();
        let held = e.kinetic + e.strain + e.hourglass + e.removed;
        let balance = e.load_work.unwrap() + e.constraint_work.unwrap() - e.damping_loss.unwrap() - held;
        near(&format!("{}: {e:?}", run.name), balance, 0.0, e.load_work.unwrap().abs().max(held), 5e-3);
    }
}

fn bits_of(simulation: &mut Simulation) -> Vec<u64> {
    let reading = simulation.tool("tip").unwrap();
    let u = simulation.displacements("b").unwrap();
    u.iter().flat_map(|u| u.to_array()).chain(reading.force.to_array()).map(f64::to_bits).collect()
}

#[test]
fn bits_with_suction_do_not_depend_on_how_steps_are_taken() {
    for run in cpu_and_long_gpu() {
        let of = |threads: usize, fuse: bool, resume: Option<u64>| {
            let removal = "removal: [(when: InTool(tool: \"tip\", reach: 1.5e-3, rate: 1e-5))], probes:";
            let scene = plate("Tet4", GLUED, ", delay: 0.01").replace("probes:", removal);
            let scene = if fuse { scene } else { scene.replace("duration:", "fuse: false, duration:") };
            let options = Options { threads, ..run.options.clone() };
            let mut simulation = Simulation::new(&scene_of(&scene, std::path::Path::new(".")), &options).unwrap();
            if let Some(step) = resume {
                simulation.advance(step).unwrap();
                let snapshot = simulation.snapshot().unwrap();
                simulation = Simulation::new(&scene_of(&scene, std::path::Path::new(".")), &options).unwrap();
                simulation.restore(&snapshot).unwrap();
            }
            simulation.advance(100 - simulation.step_count()).unwrap();
            assert!(simulation.summary("").unwrap().removed_elements > 0, "{}: nothing has gone", run.name);
            bits_of(&mut simulation)
        };
        let first = of(1, true, None);
        for step in [37, 40] {
            assert!(first == of(1, true, Some(step)), "{}: resumed at {step}", run.name);
        }
        if !is_gpu(&run) {
            assert!(first == of(1, false, None), "{}: apart", run.name);
            [2, 3].into_iter().for_each(|n| assert!(first == of(n, true, None), "{}: {n} threads", run.name));
        }
    }
}

fn is_gpu(run: &Configuration) -> bool {
    run.options.precision == Precision::F32 && run.name.starts_with("GPU")
}

/// The mouth is over the seam of two blocks, which close it together as one of twice the size does.
#[test]
fn a_mouth_that_two_bodies_close_is_closed() {
    let pulled = |run: &Configuration, blocks: &[(f64, f64)]| {
        let body = |number: usize| ["b", "c"][number];
        let mesh = |(number, (low, size)): (usize, &(f64, f64))| {
            let cells = (1e3 * size) as u32;
            let mesh = format!("Box(size: ({size}, 0.02, 0.004), cells: ({cells}, 20, 2))");
            format!("\"{}\": (mesh: {mesh}, material: \"m\", translate: ({low}, 0, 0))", body(number))
        };
        let each = |text: &str| {
            (0..blocks.len()).map(|number| text.replace("BODY", body(number))).collect::<Vec<_>>().join(", ")
        };
        let mut simulation = run.start(&format!(
            "(duration: 0.01, bodies: {{{}}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e5, poisson: 0.3), damping: 2000)}},
            constraints: [{}], suction: [{}],
            tools: {{\"tip\": (shape: Tube(length: 0.03, inner: {BORE}, outer: 8e-3), at: (0, 0.0099, 0.0042))}})",
            blocks.iter().enumerate().map(mesh).collect::<Vec<_>>().join(", "),
            each("Fixed(body: \"BODY\", on: Set(\"z0\"))"),
            each("(tool: \"tip\", body: \"BODY\", pressure: 1e3, reach: 5e-4)"),
        ));
        simulation.advance_to(0.01).unwrap();
        -simulation.tool("tip").unwrap().force.z
    };
    for run in cpu_and_long_gpu() {
        let one = pulled(&run, &[(-0.01, 0.02)]);
        let two = pulled(&run, &[(-0.01, 0.01), (0.0, 0.01)]);
        near(&format!("{}: one", run.name), one, PRESSURE * PI * BORE * BORE, PRESSURE * PI * BORE * BORE, 0.03);
        near(&format!("{}: two", run.name), two, one, one, 1e-2);
    }
}

/// What is behind tissue that closes a mouth is not sucked: the floor of a cavity that removal makes under a roof, and
/// a second body; both look at the mouth and are in reach.
#[test]
fn what_is_hidden_behind_others_is_not_sucked() {
    let slab = |name: &str, z: f64| {
        format!(
            "\"{name}\": (mesh: Box(size: (0.03, 0.03, 0.002), cells: (12, 12, 2), elements: Hex8MeanDilatation),
                material: \"t\", translate: (0, 0, {z}))"
        )
    };
    let scene = |bodies: &str, fixed: &str, sucks: &str| {
        format!(
            "(duration: 0.06, bodies: {{{bodies}}},
            materials: {{\"t\": (density: 1000, neo_hookean: Young(young: 2e5, poisson: 0.4), damping: 200)}},
            constraints: [{fixed}],
            tools: {{\"g\": (shape: Tube(length: 0.05, inner: 0.005, outer: 0.006), at: (0.0152, 0.0148, 0.0061))}},
            {sucks} probes: {{\"f\": (what: ToolForce(tool: \"g\"))}})"
        )
    };
    let sides = |body: &str| format!("Fixed(body: \"{body}\", on: Or([Set(\"z0\"), Set(\"x0\"), Set(\"x1\")]))");
    let block = "\"b\": (mesh: Box(size: (0.03, 0.03, 0.006), cells: (12, 12, 6), elements: Hex8MeanDilatation), material: \"t\")";
    let cavity = scene(
        block,
        &sides("b"),
        "removal: [(on: Box(min: (0.005, -1, 0.0039), max: (0.025, 1, 0.0051)), when: At(0.03))],
            suction: [(tool: \"g\", pressure: 200, reach: 0.004)],",
    );
    let two = scene(
        &format!("{}, {}", slab("low", 0.0), slab("high", 0.004)),
        &format!("{}, {}", sides("low"), sides("high")),
        "suction: [(tool: \"g\", body: \"low\", pressure: 200, reach: 0.005),
            (tool: \"g\", body: \"high\", pressure: 200, reach: 0.005)],",
    );
    let closed = 200.0 * PI * 0.005 * 0.005;
    for run in configurations() {
        for (what, text) in [("cavity", &cavity), ("two bodies", &two)] {
            let mut simulation = run.start(text);
            for time in [0.025, 0.06] {
                simulation.advance_to(time).unwrap();
                let felt = -simulation.probe("f").unwrap()[2];
                near(&format!("{}, {what}, {time} s", run.name), felt, closed, closed, 1e-3);
            }
        }
    }
}

/// A mouth half beside a block, whose wall there goes along the axis or leans by a twentieth of a degree either way: it
/// closes nothing of the mouth, and is hardly pulled at.
#[test]
fn a_wall_along_the_axis_is_not_sucked_however_it_leans() {
    let half = 0.5_f64.powi(3) * 200.0 * PI * 0.005 * 0.005;
    let scene = |lean: f64| {
        format!(
            "(duration: 0.2, bodies: {{\"b\": (mesh: Hexahedron(corners: (({lean}, 0, 0), (0.04, 0, 0), (0.04, 0.04, 0),
                ({lean}, 0.04, 0), (0, 0, 0.02), (0.04, 0, 0.02), (0.04, 0.04, 0.02), (0, 0.04, 0.02)), cells: (8, 8, 4),
                elements: Hex8MeanDilatation), material: \"t\")}},
            materials: {{\"t\": (density: 1000, neo_hookean: Young(young: 2e5, poisson: 0.4), damping: 60)}},
            constraints: [Fixed(on: Set(\"z0\"))],
            tools: {{\"g\": (shape: Tube(length: 0.05, inner: 0.005, outer: 0.006), at: (0, 0.0193, 0.0201))}},
            suction: [(tool: \"g\", pressure: 200, reach: 0.003, curve: Smooth(end: 0.1))],
            probes: {{\"f\": (what: ToolForce(tool: \"g\"))}})"
        )
    };
    for run in configurations() {
        for lean in [-2e-5, 0.0, 2e-5] {
            let mut simulation = run.start(&scene(lean));
            let mut aside = 0.0_f64;
            while simulation.time() < 0.2 {
                simulation.advance(20).unwrap();
                aside = aside.max(simulation.probe("f").unwrap()[0].abs());
            }
            let what = format!("{}, leaning by {lean} m", run.name);
            near(&format!("{what}: along the axis"), -simulation.probe("f").unwrap()[2], half, half, 0.02);
            near(&format!("{what}: aside"), aside, 0.0, half, 0.03);
        }
    }
}
