//! Tools that turn about a point: a shaft through a trocar.

use crate::configurations::{cpu_and_long_gpu, near, scene_of};
use glam::{DQuat, DVec3};
use sinew::assembly::motion;

/// A rod whose tip goes sideways and down into a block, its shaft through a point 3 cm above it. `way` is how it moves.
/// The step is told: where it follows what is stable, two of them would be looked at at different times.
fn scene(way: &str) -> String {
    format!(
        "(duration: 0.2, bodies: {{\"b\": (mesh: Box(size: (0.03, 0.03, 0.02), cells: (9, 9, 6)), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 20)}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        tools: {{\"rod\": (shape: Capsule(length: 0.06, radius: 0.006), {way})}},
        contacts: [Tool(tool: \"rod\", friction: 0.1)], integration: (step: 2e-4))"
    )
}

const PIVOT: DVec3 = DVec3::new(0.015, 0.016, 0.05);
const ENDS: [DVec3; 2] = [DVec3::new(0.008, 0.015, 0.0203), DVec3::new(0.021, 0.013, 0.0175)];

/// How it is turned with its tip at a place: the shortest way from upright.
fn turned(tip: DVec3) -> DQuat {
    DQuat::from_rotation_arc(DVec3::Z, (PIVOT - tip).normalize())
}

fn vector(v: DVec3) -> String {
    format!("({}, {}, {})", v.x, v.y, v.z)
}

fn through_a_pivot(more: &str) -> String {
    let [from, to] = ENDS.map(vector);
    scene(&format!("pivot: {}, path: [(t: 0, at: {from}), (t: 0.2, at: {to})] {more}", vector(PIVOT)))
}

#[test]
fn the_axis_goes_through_the_pivot_wherever_the_tip_is() {
    for more in ["", ", moves: [(displacement: (0, 2e-3, 1e-3), rotation: (0, 0, 90), curve: Ramp(end: 0.2))]"] {
        let file = scene_of(&through_a_pivot(more), std::path::Path::new("."));
        let motion = motion(&file.scene.tools["rod"]);
        let mut before = None;
        for step in 0..=100 {
            let share = f64::from(step) / 100.0;
            let pose = motion.pose(0.2 * share, |_| share);
            let tip =
                ENDS[0].lerp(ENDS[1], share) + if more.is_empty() { 0.0 } else { share } * DVec3::new(0.0, 2e-3, 1e-3);
            assert!(pose.at.distance(tip) < 1e-15, "{:?} for {tip}", pose.at);
            let way = PIVOT - pose.at;
            let axis = pose.rotation * DVec3::Z;
            assert!(axis.cross(way).length() < 1e-14 && axis.dot(way) > 0.0, "{axis} and {way}");
            assert!((pose.rotation.transpose() * pose.rotation).abs_diff_eq(glam::DMat3::IDENTITY, 1e-14));
            // no sudden turn about itself
            if let Some(before) = before.replace(pose.rotation) {
                let change: glam::DMat3 = pose.rotation - before;
                assert!(change.to_cols_array().iter().all(|number| number.abs() < 0.05), "{change}");
            }
            // how fast a point of the shaft goes is known to the guards of speed
            let (now, next) = (motion.pose(0.2 * share, |_| share), motion.pose(0.2 * share + 1e-6, |_| share + 5e-6));
            let end = DVec3::new(0.0, 0.0, 0.066);
            let speed = now.place(end).distance(next.place(end)) / 1e-6;
            assert!(speed <= 1.001 * motion.fastest(0.066), "{speed} m/s, at most {}", motion.fastest(0.066));
        }
    }
}

/// The same as a path of many turned places.
#[test]
fn tissue_feels_a_shaft_that_turns_about_its_pivot() {
    let places: Vec<String> = (0..=512)
        .map(|number| {
            let share = f64::from(number) / 512.0;
            let tip = ENDS[0].lerp(ENDS[1], share);
            let degrees = turned(tip).to_scaled_axis() * 180.0 / std::f64::consts::PI;
            format!("(t: {}, at: {}, rotation: {})", 0.2 * share, vector(tip), vector(degrees))
        })
        .collect();
    let by_hand = scene(&format!("path: [{}]", places.join(", ")));
    for run in cpu_and_long_gpu() {
        let forces = [through_a_pivot(""), by_hand.clone()].map(|scene| {
            let mut simulation = run.start(&scene);
            simulation.advance_to(0.15).unwrap();
            simulation.tool("rod").unwrap()
        });
        let force = forces[1].force;
        assert!(force.z > 1e-2, "{}: {:?}", run.name, forces[1]);
        // straight between 512 places, where its turning jumps; of 64 places the force was off by 1.6e-3
        near(run.name, forces[0].force.distance(force), 0.0, force.length(), 1e-3);
        let torque = forces[1].torque;
        near(run.name, forces[0].torque.distance(torque), 0.0, force.length() * 0.01, 1e-3);
        // upright it would press elsewhere
        let mut upright = run.start(&through_a_pivot("").replace("pivot: (0.015, 0.016, 0.05),", ""));
        upright.advance_to(0.15).unwrap();
        let other = upright.tool("rod").unwrap().force;
        assert!(other.distance(force) > 0.02 * force.length(), "{}: {other} and {force}", run.name);
    }
}
