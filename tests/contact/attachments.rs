//! Attachments inside of parts, and whose tissue goes: held nodes, and both sides of what is glued.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, near};
use glam::{DMat3, DVec3};
use sinew::Simulation;
use sinew::components::DisplacementIncrement;

/// A lens that hangs in a rim, with something of each kind of attachment.
const EYE: &str = "bodies: {
        \"lens\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3)), material: \"m\", translate: (0, 0, 0.01)),
        \"rim\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (2, 2, 2)), material: \"m\"),
        \"cap\": (mesh: Box(size: (0.01, 0.01, 0.005), cells: (2, 2, 2)), material: \"m\", translate: (0, 0, 0.0203))},
    materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4), damping: 20)},
    tools: {\"forceps\": (shape: Box(size: (0.004, 0.004, 0.004)), at: (0.005, 0.005, 0.027),
        moves: [(displacement: (1e-3, 0, 1.5e-3), rotation: (0, 0, 20), curve: Smooth(end: 0.05))])},
    constraints: [Fixed(body: \"rim\", on: Set(\"z0\"))],
    attachments: [Glue(name: \"zonule\", bodies: (\"lens\", \"rim\"), normal: 600, shear: 900),
        Tie(from: (body: \"cap\", at: (0.0046, 0.0058, 0.0203)), to: (body: \"lens\", at: (0.0046, 0.0058, 0.02)), strength: 1),
        Suture(name: \"stitch\", from: (body: \"cap\", at: (0.008, 0.005, 0.021)), to: (body: \"lens\", at: (0.008, 0.004, 0.019)),
            stiffness: 5, tighten: 1e-3, curve: Smooth(end: 0.03)),
        Grasp(tool: \"forceps\", body: \"cap\", on: Set(\"z1\"), closed: Step(start: 0.005))],
    probes: {\"pull\": (what: AttachmentForce(attachment: \"stitch\"), every: 0.01)},";
const REST: &str = "duration: 0.05, integration: (step: 5e-5)";

fn ended(run: &Configuration, scene: &str) -> Simulation {
    let mut simulation = run.start(scene);
    simulation.finish().unwrap();
    simulation
}

/// What is attached in a part is attached as in a scene of its own, under the part's name.
#[test]
#[ignore = "long"]
fn attachments_of_a_part_do_what_they_do_in_a_scene_of_their_own() {
    for run in configurations() {
        let mut alone = ended(&run, &format!("({REST}, {EYE})"));
        let mut part = ended(&run, &format!("({REST}, parts: {{\"eye\": (content: ({EYE}))}})"));
        for body in ["lens", "cap"] {
            let of_part = part.displacements(&format!("eye.{body}")).unwrap();
            assert!(alone.displacements(body).unwrap() == of_part, "{}: {body}", run.name);
        }
        for name in ["zonule", "1", "stitch"] {
            let (own, of_part) = (alone.attachment(name).unwrap(), part.attachment(&format!("eye.{name}")).unwrap());
            assert!(own.force.length() > 1e-5 || own.holds == 0, "{}: {name} bears something: {own:?}", run.name);
            assert_eq!(own, of_part, "{}: {name}", run.name);
        }
        let [own, of_part] = [alone.probe("pull").unwrap(), part.probe("eye.pull").unwrap()];
        assert!(own == of_part && own.iter().any(|number| number.abs() > 1e-5), "{}: {own:?}, {of_part:?}", run.name);
        let [own, of_part] = [alone.tool("forceps").unwrap(), part.tool("eye.forceps").unwrap()];
        assert_eq!((own.nodes, own.force), (9, of_part.force), "{}", run.name);
    }
}

/// Placed as a whole it does so turned, and the scene around it attaches what it has to its bodies.
#[test]
#[ignore = "long"]
fn attachments_of_a_part_that_is_turned_pull_turned() {
    let (rotate, translate) = (DVec3::new(40.0, -70.0, 130.0), DVec3::new(0.02, -0.01, 0.03));
    let turn = DMat3::from_rotation_z(rotate.z.to_radians())
        * DMat3::from_rotation_y(rotate.y.to_radians())
        * DMat3::from_rotation_x(rotate.x.to_radians());
    let there = |at: DVec3| (turn * at + translate).to_array().map(|x| format!("{x:?}")).join(", ");
    let [on_lens, off] = [DVec3::new(0.01, 0.005, 0.015), DVec3::new(0.02, 0.005, 0.015)];
    let block = |translate: &str| {
        format!(
            "\"block\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (1, 1, 1)), material: \"hard\", translate: ({translate}) "
        )
    };
    let hard = "\"hard\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4))";
    for run in configurations() {
        // the block is turned with the part, about its middle
        let alone = EYE
            .replacen("bodies: {", &format!("bodies: {{{}),", block("0.02, 0, 0.01")), 1)
            .replacen("materials: {", &format!("materials: {{{hard},"), 1)
            .replacen("constraints: [", "constraints: [Fixed(body: \"block\", on: All),", 1)
            .replacen(
                "Grasp(",
                "Suture(name: \"outer\", from: (body: \"lens\", at: (0.01, 0.005, 0.015)),
                to: (body: \"block\", at: (0.02, 0.005, 0.015)), stiffness: 5, length: 9e-3), Grasp(",
                1,
            );
        let mut alone = ended(&run, &format!("({REST}, {alone})"));
        let mut placed = ended(
            &run,
            &format!(
                "({REST}, bodies: {{{}, rotate: ({}, {}, {}))}}, materials: {{{hard}}},
                constraints: [Fixed(body: \"block\", on: All)],
                parts: {{\"eye\": (content: ({EYE}), rotate: ({}, {}, {}), translate: ({}, {}, {}))}},
                attachments: [Suture(name: \"outer\", from: (body: \"eye.lens\", at: ({})),
                    to: (body: \"block\", at: ({})), stiffness: 5, length: 9e-3)])",
                block(&there(DVec3::new(0.02, 0.0, 0.01))),
                rotate.x,
                rotate.y,
                rotate.z,
                rotate.x,
                rotate.y,
                rotate.z,
                translate.x,
                translate.y,
                translate.z,
                there(on_lens),
                there(off),
            ),
        );
        for (own, of_part) in [("zonule", "eye.zonule"), ("1", "eye.1"), ("stitch", "eye.stitch"), ("outer", "outer")] {
            let (one, other) = (alone.attachment(own).unwrap(), placed.attachment(of_part).unwrap());
            let what = format!("{}: {own}: {one:?}, {other:?}", run.name);
            assert_eq!((one.holds, one.broken), (other.holds, other.broken), "{what}");
            // in f32 forces of ties have the rounding of places times m/Δt² of their nodes, 3e-3 of a millinewton
            let scale = one.force.length().max(1e-3);
            near(&what, (turn * one.force).distance(other.force), 0.0, scale, run.bound(1e-8, 1e-2));
        }
    }
}

/// What bodies of so much momentum have (kg m/s), in the middle of the last step.
pub fn momentum(simulation: &mut Simulation, bodies: &[&str]) -> DVec3 {
    let rate = 1.0 / simulation.time_step();
    let of = |body: &&str| -> DVec3 {
        let masses = simulation.masses(body).unwrap();
        let view = simulation.column::<DisplacementIncrement>(body).unwrap();
        let rows = view.node_rows().iter().zip(masses);
        rows.map(|(&row, mass)| view.values().vector(row as usize) * rate * mass).sum()
    };
    bodies.iter().map(of).sum()
}

pub fn mass(simulation: &mut Simulation, bodies: &[&str]) -> f64 {
    bodies.iter().flat_map(|body| simulation.masses(body).unwrap()).sum()
}

fn is_finite(simulation: &mut Simulation, bodies: &[&str]) -> bool {
    bodies.iter().all(|body| simulation.displacements(body).unwrap().into_iter().all(|u| u.is_finite()))
}

/// Half of what is held goes with its elements: its nodes are held by nobody, those on the edge of the hole with the
/// mass that they have left, momentum is what the tool gives in each step, and energies balance.
#[test]
fn what_goes_in_a_grasp_is_let_go() {
    let text = "(duration: 0.2, bodies: {\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
        tools: {\"forceps\": (shape: Sphere(radius: 0.004), at: (0.01, 0.01, 0.022),
            moves: [(displacement: (2e-3, 0, 6e-3), rotation: (0, 0, 20), curve: Smooth(end: 0.15))])},
        attachments: [Grasp(tool: \"forceps\", on: Plane(normal: (0, 0, 1), at: 0.02), closed: Step(start: 0.01, end: 0.15))],
        removal: [(on: Box(min: (0, 0, 0.015), max: (0.01, 0.02, 0.02)), when: At(0.08))],
        integration: (step: 1e-4), output: (energies_every: 0.01))";
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(text);
        simulation.advance_to(0.0795).unwrap();
        assert_eq!(simulation.tool("forceps").unwrap().nodes, 25, "{}", run.name);
        let (whole, mut removed) = (mass(&mut simulation, &["b"]), 0);
        let scale = whole * 0.06;
        let mut before = (momentum(&mut simulation, &["b"]), whole);
        while simulation.time() < 0.085 {
            simulation.advance(1).unwrap();
            let now = (momentum(&mut simulation, &["b"]), mass(&mut simulation, &["b"]));
            let reading = simulation.tool("forceps").unwrap();
            let given = -reading.force * simulation.time_step();
            if now.1 == before.1 {
                near(
                    &format!("{}: momentum", run.name),
                    (now.0 - before.0).distance(given),
                    0.0,
                    scale,
                    run.bound(1e-11, 1e-5),
                );
            } else {
                removed += 1;
            }
            before = now;
        }
        let reading = simulation.tool("forceps").unwrap();
        let what = format!("{}: {reading:?}", run.name);
        // ten nodes of the upper face are corners of nothing any more
        assert_eq!((removed, reading.nodes), (1, 15), "{what}");
        near(&what, before.1, whole * 56.0 / 64.0, whole, 1e-6);
        simulation.advance_to(0.14).unwrap();
        let held = simulation.tool("forceps").unwrap();
        simulation.advance_to(0.2).unwrap();
        assert!(is_finite(&mut simulation, &["b"]), "{what}");
        let open = simulation.tool("forceps").unwrap();
        assert_eq!((held.nodes, open.nodes, open.force), (15, 0, DVec3::ZERO), "{what}");
        let energies = simulation.energies().unwrap();
        let (work, has) = (energies.load_work.unwrap(), energies.kinetic + energies.strain + energies.hourglass);
        assert!(energies.removed > 0.01 * work && work > 0.0, "{what}: {energies:?}");
        near(&what, work, open.work.unwrap() - open.loss.unwrap(), open.work.unwrap(), run.bound(1e-9, 1e-4));
        // as in `physics/removal.rs`: the work of a step is that of the mean of the forces at its ends, so where a
        // force goes half of it over a step is not there: 2 mN at 6 cm/s over half of 0.1 ms are 6e-9 J
        near(&format!("{what}: {energies:?}"), has + energies.removed, work, work, 2e-3);
    }
}

/// Elements go on both sides of what is glued, and others on neither: ties of what went let go at that time and stay
/// so, the others hold on; momentum changes by what went and by nothing else, and energies balance.
#[test]
#[ignore = "long"]
fn ties_of_what_goes_let_go() {
    let text = "(duration: 0.08, bodies: {
            \"low\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3)), material: \"m\", velocity: (0.02, 0, 0.01)),
            \"up\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\", translate: (0, 0, 0.02))},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3))},
        removal: [(body: \"low\", on: Box(min: (0, 0, 0.014), max: (0.006, 0.006, 0.02)), when: At(0.02)),
            (body: \"up\", on: Box(min: (0.015, 0.015, 0.02), max: (0.02, 0.02, 0.025)), when: At(0.04))],
        attachments: [Glue(bodies: (\"up\", \"low\"))], integration: (step: 5e-5), output: (energies_every: 0.01))";
    let bodies = ["low", "up"];
    for run in configurations() {
        let mut simulation = run.start(text);
        let at_start = 0.5 * 8e-3 * DVec3::new(0.02, 0.0, 0.01).length_squared();
        simulation.advance(1).unwrap();
        let mut before = (momentum(&mut simulation, &bodies), mass(&mut simulation, &bodies));
        let mut removed = 0;
        while simulation.time() < 0.0799 {
            simulation.advance(if run.name.contains("GPU") { 1 } else { 5 }).unwrap();
            let now = (momentum(&mut simulation, &bodies), mass(&mut simulation, &bodies));
            if now.1 == before.1 {
                near(
                    &format!("{}: momentum", run.name),
                    (now.0 - before.0).length(),
                    0.0,
                    3e-4,
                    run.bound(1e-11, 1e-4),
                );
            } else {
                removed += 1;
            }
            before = now;
            let reading = simulation.attachment("0").unwrap();
            // nodes of the upper body over the element that went, whose corner is the middle of none of them; and that
            // one which is a corner of one element alone
            let holds = if simulation.time() < 0.02 - 1e-9 {
                25
            } else if simulation.time() < 0.04 - 1e-9 {
                21
            } else {
                20
            };
            // they let go in the step after
            if !(0.0199..0.0202).contains(&simulation.time()) && !(0.0399..0.0402).contains(&simulation.time()) {
                assert_eq!((reading.holds, reading.broken.len()), (holds, 25 - holds), "{}: {reading:?}", run.name);
            }
        }
        let reading = simulation.attachment("0").unwrap();
        let what = format!("{}: {reading:?}", run.name);
        near(&what, reading.broke_at.unwrap(), 0.02, 0.02, 0.02);
        assert!(removed == 2 && is_finite(&mut simulation, &bodies), "{what}");
        let energies = simulation.energies().unwrap();
        let has = energies.kinetic + energies.strain + energies.hourglass + energies.removed;
        near(&format!("{what}: {energies:?}"), has - energies.load_work.unwrap(), at_start, at_start, 2e-3);
    }
}
