//! Hands that stand still: so do their tools, whatever these take along.

use crate::configurations::{configurations, near};
use glam::DVec3;
use sinew::Simulation;
use sinew::port::{DevicePose, Touch};

/// What a hand feels that goes down and stands still, in the last fifth of the time that it stands.
fn held_still(simulation: &mut Simulation, start: DVec3, depth: f64) -> Vec<Touch> {
    let mut port = simulation.open_port("hand").unwrap();
    let mut held = Vec::new();
    for tick in 1..=400 {
        let time = 1e-3 * f64::from(tick);
        let share = (time / 0.15).min(1.0);
        let down = depth * share * share * (3.0 - 2.0 * share);
        port.send(&DevicePose { time, place: start - DVec3::Z * down, ..DevicePose::default() });
        simulation.advance_to(time).unwrap();
        if tick > 350 {
            held.push(port.touch());
        }
    }
    held
}

/// Whether a hand with such a spring stands still on a block, and feels what two springs in series would.
fn stands_still(solver: &str, density: f64, stiffness: f64) {
    let run = &configurations()[0];
    let (start, depth) = (DVec3::new(0.015, 0.015, 0.0215), 2.5e-3);
    let law = if solver.is_empty() { "" } else { ", law: Penalty(share: 0.5)" };
    let scene = |follow: &str| {
        format!(
            "(duration: 10, {solver}
            bodies: {{\"b\": (mesh: Box(size: (0.03, 0.03, 0.015), cells: (7, 7, 4)), material: \"m\")}},
            materials: {{\"m\": (density: {density}, neo_hookean: Young(young: 1e4, poisson: 0.45), damping: 30)}},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
            tools: {{\"ball\": (shape: Sphere(radius: 0.006), at: (0.015, 0.015, 0.0215),
                port: (name: \"hand\", speed: 0.3, follow: {follow}))}},
            contacts: [Tool(tool: \"ball\"{law})])"
        )
    };
    let name = format!("{solver}{density} kg/m³, {stiffness} N/m");
    let mut soft = run.start(&scene(&format!("Proxy(stiffness: {stiffness})")));
    let held = held_still(&mut soft, start, depth);
    let [least, most] = [f64::min, f64::max].map(|of| held.iter().map(|touch| touch.force.z).reduce(of).unwrap());
    let force = 0.5 * (least + most);
    assert!(force > 5e-3, "{name}: {force} N");
    near(&name, most, least, force, 0.05);
    // the spring's force is that of the tissue
    let place = held.iter().map(|touch| touch.place.z).sum::<f64>() / held.len() as f64;
    near(&name, stiffness * (place - (start.z - depth)), force, force, 0.05);
    // and the tissue's that which a hand feels that is put there
    let mut stiff = run.start(&scene("Position"));
    let put = held_still(&mut stiff, start, start.z - place);
    near(&name, put[put.len() - 1].force.z, force, force, 0.05);
}

/// Nodes that a tool takes along have mass, which a proxy without mass answers a batch later: it stands still when the
/// hand does, whatever the hand's spring.
#[test]
fn a_proxy_stands_still_when_the_hand_does() {
    for (density, stiffness) in [(1000.0, 400.0), (1000.0, 100.0), (1000.0, 50.0), (100.0, 100.0)] {
        stands_still("", density, stiffness);
    }
}

#[test]
fn a_proxy_stands_still_in_implicit_steps() {
    stands_still("solver: Implicit(step: 1e-3), ", 1000.0, 20.0);
}
