//! `surface_contact`: the same points touch the same faces, the same edges cross, and by the same forces.

use super::pair::{UNIT, entities, run_in, run_kernels, stir};
use bevy_ecs::prelude::*;
use sinew::backend::gpu::gpu_or_reason;
use sinew::components::*;
use sinew::systems::{Registry, SurfaceContacts};
use sinew::{BackendChoice, Options, SceneFile, Simulation};

/// Two turned blocks of 2 cm whose faces overlap by a little: hexahedra below, tetrahedra above.
const FACES: &str = "
    \"low\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (5, 5, 5), elements: Hex8), material: \"m\"),
    \"high\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4), elements: Tet4), material: \"m\", rotate: (0, 0, 17),
        translate: (0.003, -0.002, 0.01995))";

/// Two bars across each other whose ridges overlap by a little, between nodes.
const RIDGES: &str = "
    \"low\": (mesh: Box(size: (0.06, 0.02, 0.02), cells: (3, 2, 2)), material: \"m\", rotate: (45, 0, 0)),
    \"high\": (mesh: Box(size: (0.02, 0.06, 0.02), cells: (2, 3, 2)), material: \"m\", rotate: (0, -45, 0),
        translate: (0.03, -0.03, 0.0282))";

/// A ring that is open by a little, whose ends overlap where they are nearest.
const RING: &str = "\"low\": (mesh: Tube(inner: 0.005, outer: 0.01, height: 0.006, angle: 359.5, cells: (2, 24, 3), elements: Hex8), material: \"m\")";

/// What of it is near at rest never meets, and that is the inner half of its ends.
const ITSELF: &str = "Itself(body: \"low\", thickness: 3e-5";

const TWO: &str = "Between(bodies: (\"low\", \"high\")";

/// Such bodies, with steps and forces at random, some of whose points stuck.
fn world((bodies, who): (&str, &str), friction: f64, more: &str) -> Simulation {
    let text = format!(
        "(duration: 1, bodies: {{{bodies}}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 20)}},
        contacts: [{who}, friction: {friction}{more})])"
    );
    let scene = SceneFile::from_text("surfaces.ron", &text, std::path::Path::new("."), &[])
        .unwrap_or_else(|wrong| panic!("{}", wrong.render(false)));
    let options = Options { backend: BackendChoice::Cpu, ..Options::default() };
    let mut simulation = Simulation::new(&scene, &options).unwrap();
    stir(&mut simulation);
    let world = simulation.world_mut();
    for body in entities::<ContactForce>(world) {
        stick(&mut world.get_mut::<SurfaceTouch>(body).unwrap());
        split(world, body);
        if let Some(mut touch) = world.get_mut::<FaceTouch>(body) {
            stick(&mut touch);
        }
    }
    simulation
}

/// Some faced others, some stuck, some slid; some in corners.
fn stick(touch: &mut Reals) {
    for point in 0..touch.len() / MEETING_NUMBERS {
        let states = [0.0, 1.0, 2.0, 3.0, 5.0, 6.0, 7.0];
        touch.set(MEETING_NUMBERS * point + 4, states[point % states.len()]);
        touch.set(MEETING_NUMBERS * point, 1e-6);
    }
}

/// Masses of nodes were split into some shares in the last step; only of who bears a force that is kept.
fn split(world: &mut World, body: Entity) {
    let touch = world.get::<SurfaceTouch>(body).unwrap().len();
    for row in 0..touch / MEETING_NUMBERS {
        let shares = [0.0, 0.5, 1.5, 4.0][row % 4];
        world.get_mut::<SurfaceTouch>(body).unwrap().set(MEETING_NUMBERS * row + 8, shares);
        let mut force = world.get_mut::<ContactForce>(body).unwrap();
        (0..3).for_each(|axis| force.set(3 * row + axis, 1e-3 * shares));
    }
}

/// What points of a body did in the step.
fn states(world: &World, body: Entity, of_faces: bool) -> Vec<f64> {
    let touch = match of_faces {
        true => &world.get::<FaceTouch>(body).unwrap().0,
        false => &world.get::<SurfaceTouch>(body).unwrap().0,
    };
    (0..touch.len() / MEETING_NUMBERS).map(|point| touch.get(MEETING_NUMBERS * point + 4)).collect()
}

/// A place is rounded some eight times on its way to a gap (a sum at rest, displacements, the nearest of a triangle,
/// and a difference), that of a point of a face another eight times (weights of four nodes, there and here), each to
/// half a unit of 4 cm, and a force is a gap times what a metre comes to; sums and quotients of forces themselves take
/// some hundred roundings. Where a point just touches on one side and just does not on the other, the shares of its
/// nodes differ, and so do forces around it: of a random field that may be one in fifty.
fn agree(what: &str, make: impl Fn() -> Simulation, (of_faces, roundings, least): (bool, f64, usize)) {
    let Some(mut pair) = run_in("surface_contact", make) else { return };
    let (mut touched, mut different) = (0, Vec::new());
    for body in entities::<ContactForce>(pair.host.world_mut()) {
        let force =
            |simulation: &Simulation, row: usize| simulation.world().get::<ContactForce>(body).unwrap().vector(row);
        let clock = *pair.before().resource::<Clock>();
        let masses = pair.before().get::<Mass>(body).unwrap();
        for row in 0..masses.len() {
            let [host, device] = [force(&pair.host, row), force(&pair.device, row)];
            let to_force = masses.get(row) / (clock.time_step * clock.half_step_interval());
            let bound = roundings * 0.04 * UNIT * to_force + 100.0 * UNIT * host.length();
            touched += usize::from(host.length() > 0.0);
            let off = (host - device).length();
            if off.is_nan() || off > bound {
                different.push(format!("{body} {row}: {host} and {device}, {off:e} of {bound:e}"));
            }
        }
        let [here, there] = [&pair.host, &pair.device].map(|of| states(of.world(), body, of_faces));
        for (point, (here, there)) in here.iter().zip(&there).enumerate().filter(|(_, (here, there))| here != there) {
            different.push(format!("point {point} of {body}: {here} and {there}"));
        }
    }
    assert!(touched >= least, "{what}: only {touched} nodes are touched");
    assert!(50 * different.len() <= touched, "{what}: {} of {touched} nodes: {different:#?}", different.len());
    eprintln!("{what}: {} of {touched} nodes beyond rounding: {different:?}", different.len());
}

/// Forceps hold most of the upper face of the lower block, and move; some nodes have slipped out.
fn held(friction: f64, more: &str) -> Simulation {
    let more = format!(
        "{more})], tools: {{\"forceps\": (shape: Sphere(radius: 0.01),
            path: [(t: 0, at: (0.01, 0.01, 0.025)), (t: 0.5, at: (0.01, 0.012, 0.027), rotation: (0, 5, 0))])}},
        attachments: [Grasp(tool: \"forceps\", body: \"low\", on: Plane(normal: (0, 0, 1), at: 0.02),
            closed: Step(), strength: 1e3"
    );
    let mut simulation = world((FACES, TWO), friction, &more);
    let world = simulation.world_mut();
    let values = world.resource::<Signals>().values().to_vec();
    for body in entities::<ToolHold>(world) {
        let (grasps, mut hold) =
            (world.get::<Grasps>(body).unwrap().clone(), world.get::<ToolHold>(body).unwrap().clone());
        let (rest, u) = (world.get::<RestPosition>(body).unwrap(), world.get::<Displacement>(body).unwrap());
        let pose = Pose::of_slots(&values[grasps.grasps[0].tool.signal..]);
        for (place, &row) in grasps.rows.iter().enumerate() {
            let row = row as usize;
            let at = grasps.numbers() * place;
            hold.set(at + 3, if place % 5 == 2 { 2.0 } else { 1.0 });
            let off = 2e-5 * (place % 3) as f64;
            hold.set_vector_at(at + 6, pose.inverse(rest.0[row] - grasps.reference + u.vector(row) - off));
        }
        *world.get_mut::<ToolHold>(body).unwrap() = hold;
    }
    simulation
}

/// Where a tool takes a node is rounded once more, as a place.
#[test]
fn what_is_held_pushes_with_the_same_forces() {
    for (friction, more) in LAWS {
        for (more, of_faces) in [(more.to_string(), false), (format!("{more}, points: Faces"), true)] {
            let what = format!("held, friction {friction}{more}");
            agree(&what, || held(friction, &more), (of_faces, 24.0, 41));
            let force = |mut simulation: Simulation| -> f64 {
                let registry = Registry::default();
                let mut system =
                    registry.get("surface_contact").unwrap().host.alone("surface_contact", simulation.world_mut());
                system.initialize(simulation.world_mut());
                system.run((), simulation.world_mut()).unwrap().unwrap();
                let world = simulation.world_mut();
                let body = entities::<ContactForce>(world)[0];
                world.get::<ContactForce>(body).unwrap().vectors().map(|force| force.length()).sum()
            };
            let [free, held] = [world((FACES, TWO), friction, &more), held(friction, &more)].map(force);
            println!("{what}: {free} and {held} N");
            assert!((held - free).abs() > 0.1 * free, "{what}: they hold: {free} and {held} N");
        }
    }
}

const LAWS: [(f64, &str); 4] =
    [(0.0, ""), (0.4, ""), (0.4, ", sweeps: 3"), (0.4, ", law: Penalty(share: 0.5, damping: 0.2)")];

#[test]
fn surfaces_push_the_same_nodes_with_the_same_forces() {
    for (friction, more) in LAWS {
        agree(&format!("friction {friction}{more}"), || world((FACES, TWO), friction, more), (false, 8.0, 41));
    }
}

#[test]
fn points_of_faces_push_the_same_nodes_with_the_same_forces() {
    for (friction, more) in LAWS {
        let more = format!("{more}, points: Faces");
        agree(&format!("friction {friction}{more}"), || world((FACES, TWO), friction, &more), (true, 16.0, 41));
    }
}

#[test]
#[ignore = "long"]
fn edges_push_the_same_nodes_with_the_same_forces() {
    for (friction, more) in LAWS {
        for points in ["", ", points: Faces"] {
            let more = format!("{more}{points}, edges: true");
            let of_faces = !points.is_empty();
            agree(&format!("friction {friction}{more}"), || world((RIDGES, TWO), friction, &more), (of_faces, 16.0, 4));
        }
    }
}

/// Lists that do not hold what is near are told from how far nodes have moved, and all is gone through.
#[test]
#[ignore = "long"]
fn old_lists_lose_no_contact_on_a_gpu() {
    lose_no_contact(&[((FACES, TWO), ", points: Faces", 41), ((RING, ITSELF), ", edges: true", 4)]);
}

#[test]
#[ignore = "long"]
fn old_lists_lose_no_contact_of_any_kind_on_a_gpu() {
    lose_no_contact(&[
        ((FACES, TWO), "", 41),
        ((RIDGES, TWO), ", edges: true", 4),
        ((RIDGES, TWO), ", edges: true, points: Faces", 4),
        ((RING, ITSELF), "", 4),
        ((RING, ITSELF), ", edges: true, points: Faces", 4),
    ]);
}

fn lose_no_contact(cases: &[((&str, &str), &str, usize)]) {
    for &(bodies, more, least) in cases {
        let Some(gpu) = gpu_or_reason() else { return };
        let [mut fresh, mut old] = [(); 2].map(|()| world(bodies, 0.3, more));
        // no list holds anything
        old.world_mut().resource_mut::<SurfaceContacts>().skin = -10.0;
        let registry = Registry::default();
        let system = registry.get("surface_contact").unwrap();
        run_kernels(gpu, fresh.world_mut(), |world, buffers| system.kernels(world, buffers), 1);
        let Some(gpu) = gpu_or_reason() else { return };
        run_kernels(gpu, old.world_mut(), |world, buffers| system.kernels(world, buffers), 1);
        let mut touched = 0;
        for body in entities::<ContactForce>(fresh.world_mut()) {
            let [a, b] = [&fresh, &old].map(|of| of.world().get::<ContactForce>(body).unwrap());
            assert_eq!(a.bytes(), b.bytes(), "{body}{more}");
            touched += a.vectors().filter(|force| force.length() > 0.0).count();
        }
        eprintln!("{more}: {touched}");
        assert!(touched >= least, "{more}: {touched}");
    }
}
