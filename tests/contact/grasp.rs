//! Closed tools take nodes along: weight, carrying, opening, who is held, bits, what is refused.

use crate::bits::{bits_do_not_depend, start};
use crate::configurations::{configurations, cpu_and_long_gpu, near};
use glam::{DQuat, DVec3};
use sinew::Simulation;
use sinew::components::{DisplacementIncrement, Precision};

const TISSUE: &str = "\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 20)";

/// A cube of 2 cm (78.48 mN) that lies on a table until forceps close on its upper face.
pub const LIFTED: &str =
    "(duration: 3, bodies: {\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3), elements: Hex8), material: \"m\")},
    materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 20)},
    loads: [Gravity(acceleration: (0, 0, -9.81))],
    tools: {\"table\": (shape: Plane()), \"forceps\": (shape: Capsule(length: 0.05, radius: 0.004), path: [
        (t: 0, at: (0.01, 0.01, 0.02)), (t: 1, at: (0.01, 0.01, 0.02)), (t: 1.4, at: (0.01, 0.01, 0.05)),
        (t: 1.6, at: (0.03, 0.01, 0.05)), (t: 2.7, at: (0.03, 0.01, 0.05)), (t: 2.9, at: (0.05, 0.01, 0.05))])},
    contacts: [Tool(tool: \"table\")],
    attachments: [Grasp(tool: \"forceps\", on: Plane(normal: (0, 0, 1), at: 0.02), closed: Step(start: 0.9, end: 2.8))],
    output: (energies_every: 0.01))";

/// Momentum (kg m/s), in the middle of the last step.
fn momentum(simulation: &mut Simulation) -> DVec3 {
    let (masses, rate) = (simulation.masses("b").unwrap(), 1.0 / simulation.time_step());
    let view = simulation.column::<DisplacementIncrement>("b").unwrap();
    let rows = view.node_rows().iter().zip(masses);
    rows.map(|(&row, mass)| view.values().vector(row as usize) * rate * mass).sum()
}

/// Kinetic energy and what the elements store (J).
fn energy(simulation: &mut Simulation) -> f64 {
    let energies = simulation.energies().unwrap();
    energies.kinetic + energies.strain + energies.hourglass
}

/// C26.
#[test]
fn a_cube_is_grasped_lifted_carried_and_let_go() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(LIFTED);
        let weight = 1000.0 * 8e-6 * 9.81;
        let largest = weight * 0.03;
        simulation.advance_to(0.88).unwrap();
        let reading = simulation.tool("forceps").unwrap();
        assert_eq!((reading.nodes, reading.work.unwrap()), (0, 0.0), "{}: it is open: {reading:?}", run.name);
        let (mut before, mut closed) = (energy(&mut simulation), false);
        while simulation.time() < 0.95 {
            simulation.advance(1).unwrap();
            let now = energy(&mut simulation);
            near(&format!("{}: energy at {}", run.name, simulation.time()), now, before, largest, 1e-6);
            before = now;
            let reading = simulation.tool("forceps").unwrap();
            // it lies there: nothing that the forceps have to do
            closed |= reading.nodes == 16;
            near(&format!("{}: force at closing", run.name), reading.force.length(), 0.0, weight, 1e-3);
        }
        assert!(closed, "{}: it closes", run.name);
        simulation.advance_to(2.65).unwrap();
        let reading = simulation.tool("forceps").unwrap();
        let what = format!("{}: {reading:?}", run.name);
        near(&what, -reading.force.z, weight, weight, 1e-4);
        near(&what, reading.force.truncate().length(), 0.0, weight, 1e-4);
        // its middle is where the tool is, and what it weighs has no moment about that
        near(&what, reading.torque.length(), 0.0, 0.01 * weight, 1e-3);
        assert_eq!(simulation.tool("table").unwrap().nodes, 0, "{what}");
        let lifted = simulation.displacements("b").unwrap();
        let rest = simulation.rest_positions("b").unwrap();
        for (u, _) in lifted.iter().zip(&rest).filter(|(_, x)| x.z > 0.02 - 1e-9) {
            // the top has been pressed down by its own weight a little before
            near(&what, u.x, 0.02, 0.02, 1e-3);
            assert!(u.z > 0.029 && u.z < 0.03, "{what}: {u}");
        }
        // while it opens the tool goes on
        simulation.advance_to(2.79).unwrap();
        let mut last = momentum(&mut simulation);
        let mut energy_before = energy(&mut simulation);
        assert_eq!(simulation.tool("forceps").unwrap().nodes, 16, "{what}");
        while simulation.time() < 2.81 {
            simulation.advance(1).unwrap();
            let now = momentum(&mut simulation);
            let dt = simulation.time_step();
            let open = simulation.tool("forceps").unwrap().nodes == 0;
            let jump = (now - last).length();
            // what weight and damping do in a step
            let bound = if open { 1.01 * (weight + 20.0 * last.length()) * dt } else { weight * dt };
            assert!(jump <= bound, "{what}: {jump} kg m/s at {}, allowed {bound}", simulation.time());
            let now_energy = energy(&mut simulation);
            let bound = weight * dt * 0.5 + 1e-6 * largest;
            assert!((now_energy - energy_before).abs() < bound, "{what}: from {energy_before} to {now_energy} J");
            (last, energy_before) = (now, now_energy);
        }
        let reading = simulation.tool("forceps").unwrap();
        assert_eq!((reading.nodes, reading.force), (0, DVec3::ZERO), "{what}");
        assert!(last.x > 0.5 * 8e-3 * 0.1, "{what}: it goes on as the tool has drawn it: {last}");
        let energies = simulation.energies().unwrap();
        // gravity has taken what the cube was lifted by, damping what 3 cm at 7.5 cm/s and 3.1 cm at 10 cm/s cost, and
        // what is left is how it moves; to a tenth, as it swings on the way
        let damped = 20.0 * 8e-3 * (0.075 * 0.03 + 0.1 * 0.031);
        let (least, most) = (weight * 0.029, weight * 0.03 + 1.1 * damped + 0.5 * 8e-3 * 0.01);
        assert!(reading.work.unwrap() > least && reading.work.unwrap() < most, "{what}: {reading:?}");
        assert!(energies.load_work.unwrap().abs() < reading.work.unwrap(), "{what}");
    }
}

/// Nodes that are held are where the frame of the tool has taken them.
#[test]
fn what_is_held_turns_with_the_tool() {
    for run in configurations() {
        let mut simulation = run.start(&format!(
            "(duration: 0.4, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3), elements: Tet4), material: \"m\")}},
            materials: {{{TISSUE}}}, constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
            tools: {{\"grip\": (shape: Box(size: (0.01, 0.01, 0.01)), at: (0.01, 0.01, 0.025), rotation: (0, 0, 20),
                moves: [(displacement: (2e-3, 0, 3e-3), rotation: (0, 0, 50), curve: Smooth(end: 0.3))])}},
            attachments: [Grasp(tool: \"grip\", on: Plane(normal: (0, 0, 1), at: 0.02), closed: Step())],
            output: (energies_every: 0.1))"
        ));
        simulation.advance_to(0.4).unwrap();
        let (u, rest) = (simulation.displacements("b").unwrap(), simulation.rest_positions("b").unwrap());
        let about = DVec3::new(0.01, 0.01, 0.025);
        let turn = DQuat::from_rotation_z(50.0_f64.to_radians());
        let mut held = 0;
        for (x, u) in rest.iter().zip(u).filter(|(x, _)| x.z > 0.02 - 1e-9) {
            let wanted = about + DVec3::new(2e-3, 0.0, 3e-3) + turn * (*x - about);
            near(run.name, (*x + u).distance(wanted), 0.0, 0.02, run.bound(1e-12, 1e-6));
            held += 1;
        }
        let reading = simulation.tool("grip").unwrap();
        assert_eq!((held, reading.nodes), (16, 16), "{}", run.name);
        assert!(reading.torque.z < -1e-4 && reading.force.z < -1e-2, "the tissue pulls back: {reading:?}");
        let load_work = simulation.energies().unwrap().load_work.unwrap();
        near(
            run.name,
            load_work,
            reading.work.unwrap() - reading.loss.unwrap(),
            reading.work.unwrap(),
            run.bound(1e-9, 1e-4),
        );
    }
}

/// A ball takes hold of who is inside, or within reach; on closing again, of who is there by then.
#[test]
fn a_tool_takes_what_is_inside_it_when_it_closes() {
    for run in cpu_and_long_gpu() {
        let jaws = ", jaws: Box(size: (0.012, 0.004, 0.0101))";
        for (reach, nodes) in [("", 0), (", reach: 1.2e-3", 1), (", reach: 5.7e-3", 9), (jaws, 3)] {
            let mut simulation = run.start(&format!(
                "(duration: 0.2, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\")}},
                materials: {{{TISSUE}}},
                tools: {{\"ball\": (shape: Sphere(radius: 4e-3), at: (0.01, 0.01, 0.025))}},
                attachments: [Grasp(tool: \"ball\"{reach}, closed: Table([(0, 0), (0.05, 1), (0.1, 1), (0.12, 0)]))])"
            ));
            simulation.advance_to(0.02).unwrap();
            assert_eq!(simulation.tool("ball").unwrap().nodes, 0, "{}: it is open", run.name);
            simulation.advance_to(0.08).unwrap();
            assert_eq!(simulation.tool("ball").unwrap().nodes, nodes, "{}{reach}", run.name);
            simulation.advance_to(0.15).unwrap();
            assert_eq!(simulation.tool("ball").unwrap().nodes, 0, "{}: it is open again", run.name);
        }
    }
}

/// A program opens and closes it by an input.
#[test]
fn a_program_closes_and_opens_a_tool() {
    for run in configurations() {
        let mut simulation = run.start(&format!(
            "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (2, 2, 2)), material: \"m\")}},
            materials: {{{TISSUE}}}, constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
            tools: {{\"ball\": (shape: Sphere(radius: 4e-3), at: (0.01, 0.01, 0.022))}},
            attachments: [Grasp(tool: \"ball\", closed: Input(name: \"squeeze\"))])"
        ));
        for (squeeze, nodes) in [(0.0, 0), (1.0, 1), (0.4, 0), (0.6, 1), (0.0, 0)] {
            simulation.set_input("squeeze", squeeze).unwrap();
            simulation.advance(20).unwrap();
            assert_eq!(simulation.tool("ball").unwrap().nodes, nodes, "{}: {squeeze}", run.name);
        }
    }
}

/// The force above which a node of the bar slips out (N).
const STRENGTH: f64 = 2e-3;

/// A bar whose four upper nodes are drawn up, by 2 mm/s.
fn drawn(solver: &str) -> String {
    format!(
        "(duration: 2, {solver} bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.04), cells: (1, 1, 4), elements: Hex8), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0), damping: 20)}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        tools: {{\"grip\": (shape: Sphere(radius: 0.01), at: (0.005, 0.005, 0.04),
            moves: [(displacement: (0, 0, 4e-3), curve: Ramp(end: 2))])}},
        attachments: [Grasp(tool: \"grip\", on: Plane(normal: (0, 0, 1), at: 0.04), closed: Step(end: 1.95), strength: {STRENGTH})],
        probes: {{\"nodes\": (what: ContactForce, on: Plane(normal: (0, 0, 1), at: 0.04))}})"
    )
}

/// A node slips out above the strength: a bar of 4 nodes at its end bears 4 times that.
fn slip_out(what: &str, simulation: &mut Simulation) {
    let mut most = 0.0_f64;
    while simulation.time() < 1.9 {
        simulation.advance(1).unwrap();
        let reading = simulation.tool("grip").unwrap();
        most = most.max(-reading.force.z);
        // also in the step in which they slip out
        let on_nodes = DVec3::from_slice(&simulation.probe("nodes").unwrap());
        let left = (reading.force + on_nodes).length();
        assert!(left <= 1e-9 * STRENGTH, "{what}: {reading:?}, {on_nodes} at {} s", simulation.time());
    }
    // told of while it is closed, and after it has opened
    for until in [1.9, 2.0] {
        simulation.advance_to(until).unwrap();
        let reading = simulation.tool("grip").unwrap();
        assert_eq!((reading.nodes, reading.slipped), (0, 4), "{what}: at {until} s");
    }
    // nothing narrows the bar, and all four bear the same: what passes it by less than a step adds
    assert!(most > 4.0 * STRENGTH * 0.9999 && most < 4.0 * STRENGTH * 1.02, "{what}: {most}");
}

#[test]
fn nodes_slip_out_above_the_strength() {
    for run in configurations() {
        slip_out(run.name, &mut run.start(&drawn("")));
    }
    slip_out("implicit", &mut start(&drawn("solver: Implicit(step: 5e-3),"), Precision::F64, 1));
}

/// The same bits on any number of threads, fused or not, and from any step on.
#[test]
fn bits_of_a_grasp_do_not_depend_on_threads_or_pauses() {
    let text = LIFTED.replace("(3, 3, 3)", "(8, 8, 8)").replace("start: 0.9, end: 2.8", "start: 0.02, end: 0.1");
    let text = text.replace("t: 1,", "t: 0.01,").replace("t: 1.4,", "t: 0.8,").replace("t: 1.6,", "t: 0.9,");
    let holds = |simulation: &mut Simulation| assert!(simulation.tool("forceps").unwrap().nodes > 0, "it holds");
    let has_worked = |simulation: &mut Simulation| assert!(simulation.tool("forceps").unwrap().work.unwrap() > 0.0);
    bits_do_not_depend(&text, &["b"], [0.06, 0.15], [holds, has_worked]);
}
