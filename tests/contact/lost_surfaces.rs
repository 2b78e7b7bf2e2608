//! What points bore and touched whose surface is gone, or who face nothing any more.

use crate::bits::{bits, start};
use sinew::components::{ContactForce, FaceTouch, Precision, SurfaceTouch};
use sinew::glam::DVec3;
use sinew::{Simulation, Snapshot};

/// A cube with friction on another and a little inside it, whose lower layer goes a part at a time.
const SCENE: &str = "(duration: 0.03, bodies: {
        \"low\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\"),
        \"high\": (mesh: Box(size: (0.016, 0.016, 0.012), cells: (3, 3, 3)), material: \"m\", translate: (0.002, 0.002, 0.0196),
            velocity: (0.05, 0, -0.2))},
    materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
    constraints: [Fixed(body: \"low\", on: Set(\"z0\"))],
    removal: [(body: \"high\", on: Box(min: (0, 0, 0.019), max: (0.02, 0.02, 0.0236)), when: During(start: 0.008, end: 0.02))],
    contacts: [Between(bodies: (\"low\", \"high\"), friction: 0.3POINTS)])";

/// A block that lies on another, of which one or the other end of the upper layer goes.
const EITHER: &str = "(duration: 0.06, bodies: {
        \"low\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\"),
        \"high\": (mesh: Box(size: (0.02, 0.02, 0.012), cells: (3, 3, 3)), material: \"m\", translate: (0.001, 0.001, 0.0201))},
    materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 10)},
    constraints: [Fixed(body: \"low\", on: Set(\"z0\"))], loads: [Gravity(acceleration: (0, 0, -20), body: \"high\")],
    tools: {\"t\": (shape: Sphere(radius: 1e-3), at: (0.01, 0.01, 0.05))},
    removal: [(body: \"low\", on: Box(min: (-1, -1, 0.0149), max: (0.0051, 1, 1)),
            when: InTool(tool: \"t\", reach: 0.1, rate: 1e-3, curve: Input(name: \"left\"), crumb: 0)),
        (body: \"low\", on: Box(min: (0.0149, -1, 0.0149), max: (1, 1, 1)),
            when: InTool(tool: \"t\", reach: 0.1, rate: 1e-3, curve: Input(name: \"right\"), crumb: 0))],
    contacts: [Between(bodies: (\"low\", \"high\"), friction: 0.3POINTS)])";

fn bytes(simulation: &mut Simulation) -> Vec<u8> {
    simulation.snapshot().unwrap().to_bytes().unwrap()
}

/// The sum of what is noted of forces on all nodes of both bodies (N), and of their sizes.
fn forces(simulation: &mut Simulation) -> (DVec3, f64) {
    let (mut sum, mut size) = (DVec3::ZERO, 0.0);
    for body in ["low", "high"] {
        let entity = simulation.body(body).unwrap();
        let force = simulation.world().get::<ContactForce>(entity).unwrap();
        sum += force.vectors().sum::<DVec3>();
        size += force.vectors().map(|force| force.length()).sum::<f64>();
    }
    (sum, size)
}

/// Points that noted how deep they may be and face nothing.
fn stale(simulation: &mut Simulation) -> usize {
    let mut count = 0;
    for body in ["low", "high"] {
        let entity = simulation.body(body).unwrap();
        let of_nodes = &simulation.world().get::<SurfaceTouch>(entity).unwrap().0;
        let of_faces = simulation.world().get::<FaceTouch>(entity).map(|touch| &touch.0);
        for touch in [Some(of_nodes), of_faces].into_iter().flatten() {
            let all = (0..touch.len()).step_by(sinew::components::MEETING_NUMBERS);
            count += all.filter(|&first| touch.get(first + 4) == 0.0 && touch.get(first + 3) != 0.0).count();
        }
    }
    count
}

#[test]
fn a_run_goes_on_from_any_step_while_touching_surfaces_go() {
    for (precision, points) in [
        (Precision::F64, ""),
        (Precision::F32, ""),
        (Precision::F64, ", points: Faces"),
        (Precision::F32, ", points: Faces"),
    ] {
        let scene = &SCENE.replace("POINTS", points);
        let mut whole = start(scene, precision, 1);
        let (mut kept, mut touched, mut gone) = (Vec::new(), 0, 0);
        while !whole.is_finished() {
            if whole.step_count() % 7 == 3 {
                kept.push(bytes(&mut whole));
            }
            whole.advance(1).unwrap();
            touched = touched.max(whole.contact("low").unwrap().points);
            let (sum, size) = forces(&mut whole);
            // who is on no surface any more bears nothing: else one side would have more than the other
            let bound = if precision == Precision::F64 { 1e-12 } else { 1e-5 };
            assert!(sum.length() <= bound * size, "step {}: {sum} of {size} N, {precision:?}", whole.step_count());
            assert_eq!(stale(&mut whole), 0, "step {}, {precision:?}", whole.step_count());
            gone = whole.fields("high").unwrap().alive.iter().filter(|alive| **alive == 0).count();
        }
        assert!(touched > 5 && gone == 54, "{touched} nodes touch, {gone} elements are gone");
        for pair in kept.windows(2) {
            let [from, to] = [&pair[0], &pair[1]].map(|bytes| Snapshot::from_bytes(bytes).unwrap());
            let mut resumed = start(scene, precision, 1);
            resumed.restore(&from).unwrap();
            resumed.advance(7).unwrap();
            let found = Snapshot::from_bytes(&bytes(&mut resumed)).unwrap();
            assert_eq!(to.differences(&found), Vec::<String>::new(), "to step {}, {precision:?}", resumed.step_count());
        }
    }
}

/// Whoever goes back to as many other elements finds their surface: the one of before stayed.
#[test]
fn a_run_goes_back_to_as_many_other_elements() {
    for (precision, points) in [(Precision::F64, ""), (Precision::F32, ", points: Faces")] {
        let scene = &EITHER.replace("POINTS", points);
        let without = |end: &str| {
            let mut simulation = start(scene, precision, 1);
            simulation.set_input(end, 1.0).unwrap();
            simulation.advance(35).unwrap();
            let alive = simulation.fields("low").unwrap().alive.iter().map(|alive| *alive == 1).collect::<Vec<bool>>();
            (simulation, alive)
        };
        let ((mut whole, one), (mut other, another)) = (without("left"), without("right"));
        let count = |alive: &[bool]| alive.iter().filter(|alive| !**alive).count();
        assert!(one != another && count(&one) == 24 && count(&another) == 24, "{one:?}, {another:?}");
        let kept = whole.snapshot().unwrap();
        other.restore(&kept).unwrap();
        for simulation in [&mut whole, &mut other] {
            let mut touched = 0;
            for _ in 0..40 {
                simulation.advance(1).unwrap();
                touched = touched.max(simulation.contact("low").unwrap().points);
            }
            assert!(touched > 3, "{precision:?}: {touched}");
        }
        let [wanted, found] = [&mut whole, &mut other].map(|simulation| bits(simulation, &["low", "high"]));
        assert!(wanted == found, "{precision:?}{points}");
    }
}
