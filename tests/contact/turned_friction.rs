//! What friction holds goes along with what turns: between plates that turn, and above a face that tilts.

use crate::bits::start;
use crate::configurations::{cpu_and_long_gpu, near};
use glam::{DMat3, DQuat, DVec3};
use sinew::Simulation;
use sinew::components::Precision;

/// Edges of the cube between the plates (m).
const EDGE: f64 = 0.01 / 3.0;

/// A cube of 1 cm between plates that press it together by a tenth, and then turn with it about its middle by a vector
/// (degrees).
fn gripped(degrees: DVec3) -> String {
    let way = |side: f64| {
        let key = |number: i32| {
            let share = f64::from(number) / 45.0;
            let (time, turn) = (0.1 + 0.4 * share, degrees * share);
            let at = rotation(turn) * DVec3::new(0.0, 0.0, 0.0055 * side);
            let [x, y, z] = at.to_array();
            format!(", (t: {time:?}, at: ({x:?}, {y:?}, {z:?}), rotation: ({:?}, {:?}, {:?}))", turn.x, turn.y, turn.z)
        };
        let keys: String = (1..=45).map(key).collect();
        format!("[(t: 0, at: (0, 0, {:?})), (t: 0.1, at: (0, 0, {:?})){keys}]", 0.006 * side, 0.0055 * side)
    };
    format!(
        "(duration: 0.7, solver: Implicit(step: 0.01),
        bodies: {{\"a\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3), elements: Hex8), material: \"m\",
            translate: (-0.005, -0.005, -0.005))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3), damping: 20)}},
        tools: {{\"up\": (shape: Box(size: (0.03, 0.03, 0.002)), path: {}),
            \"low\": (shape: Box(size: (0.03, 0.03, 0.002)), path: {})}},
        contacts: [Tool(tool: \"up\", friction: 0.8, thin: true, law: Penalty(share: 1)),
            Tool(tool: \"low\", friction: 0.8, thin: true, law: Penalty(share: 1))])",
        way(1.0),
        way(-1.0)
    )
}

fn rotation(degrees: DVec3) -> DMat3 {
    DMat3::from_quat(DQuat::from_scaled_axis(degrees * (std::f64::consts::PI / 180.0)))
}

/// Where nodes of a body are (m), at rest and now.
fn places(simulation: &mut Simulation, body: &str) -> Vec<(DVec3, DVec3)> {
    let (rest, u) = (simulation.rest_positions(body).unwrap(), simulation.displacements(body).unwrap());
    rest.into_iter().zip(u).map(|(rest, u)| (rest, rest + u)).collect()
}

/// The elastic slip of a spring turns with its tool, and what pressed along another normal before rubs along none:
/// corners crept by the depth times the angle (.3 mm about an axis in the plates, .055 mm about that across), and
/// plates were pushed aside by 13 % of what they press with.
#[test]
fn plates_that_turn_take_along_what_friction_holds_in_implicit_steps() {
    let found = [DVec3::ZERO, 90.0 * DVec3::X, 90.0 * DVec3::Z].map(|degrees| {
        let mut simulation = start(&gripped(degrees), Precision::F64, 1);
        simulation.advance_to(0.7).unwrap();
        let back = rotation(degrees).transpose();
        let force = back * simulation.tool("up").unwrap().force;
        (places(&mut simulation, "a").into_iter().map(|(_, now)| back * now).collect::<Vec<_>>(), force)
    });
    let [(still, pressed), turned @ ..] = &found;
    assert!(pressed.z > 0.05 && still.len() == 64, "{pressed}");
    for ((places, force), axis) in turned.iter().zip(["x", "z"]) {
        for (now, expected) in places.iter().zip(still) {
            near(&format!("about {axis}, {expected}"), now.distance(*expected), 0.0, EDGE, 5e-3);
        }
        near(&format!("about {axis}: pressed"), force.z, pressed.z, pressed.z, 5e-3);
        near(&format!("about {axis}: aside"), force.truncate().length(), 0.0, pressed.z, 5e-3);
    }
}

/// A block that lies above a plate, by a thickness, while the plate tilts by 30°.
fn tilted(thickness: f64, [plate, block]: [&str; 2], (solver, law): (&str, &str)) -> String {
    format!(
        "(duration: 0.75, {solver} bodies: {{
            \"plate\": (mesh: Box(size: (0.03, 0.02, 0.004), cells: ({plate}), elements: Hex8MeanDilatation), material: \"m\",
                translate: (-0.015, -0.01, -0.004)),
            \"block\": (mesh: Box(size: (0.01, 0.01, 0.006), cells: ({block}), elements: Hex8MeanDilatation), material: \"m\",
                translate: (-0.005, -0.005, {thickness:?}))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.4), damping: 30)}},
        loads: [Gravity(body: \"block\", acceleration: (0, 0, -9.81), curve: Smooth(end: 0.1))],
        constraints: [Prescribed(body: \"plate\", on: All, rotation: (0, 30, 0), center: (0, 0, 0),
            curve: Smooth(start: 0.15, end: 0.65))],
        contacts: [Between(bodies: (\"plate\", \"block\"), friction: 1, thickness: {thickness:?} {law})])"
    )
}

/// The mean of the places of the block's lower nodes (m), as the plate sees it.
fn feet(simulation: &mut Simulation, thickness: f64) -> DVec3 {
    let back = rotation(30.0 * DVec3::Y).transpose();
    let places = places(simulation, "block");
    let feet: Vec<DVec3> =
        places.iter().filter(|(rest, _)| (rest.z - thickness).abs() < 1e-6).map(|(_, now)| back * *now).collect();
    feet.iter().sum::<DVec3>() / feet.len() as f64
}

/// What is held at a distance goes along the face as this turns: that is no slip. It crept by the thickness times the
/// angle, .52 mm.
#[test]
fn what_sticks_above_a_face_tilts_with_it() {
    let thickness = 1e-3;
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&tilted(thickness, ["3, 2, 1", "2, 2, 2"], ("", "")));
        simulation.advance_to(0.75).unwrap();
        let feet = feet(&mut simulation, thickness);
        near(&format!("{}: along", run.name), feet.x, 0.0, thickness, 0.02);
        near(&format!("{}: above", run.name), feet.z, thickness, thickness, 0.02);
    }
    let by_springs = ("solver: Implicit(step: 0.005),", ", law: Penalty(share: 1)");
    let mut simulation = start(&tilted(thickness, ["5, 3, 1", "4, 4, 3"], by_springs), Precision::F64, 1);
    simulation.advance_to(0.75).unwrap();
    let feet = feet(&mut simulation, thickness);
    near("implicit: along", feet.x, 0.0, thickness, 0.05);
    near("implicit: above", feet.z, thickness, thickness, 0.2);
}
