//! `surface_contact`: the same points touch the same faces, and by the same forces.

use super::pair::{UNIT, entities, run_in, run_kernels, stir};
use sinew::backend::gpu::gpu_or_reason;
use sinew::components::*;
use sinew::systems::{Registry, SurfaceContacts};
use sinew::{BackendChoice, Options, SceneFile, Simulation};

/// Two turned blocks of 2 cm whose faces overlap by a little, with steps and forces at random, some of whose nodes
/// stuck.
fn world(friction: f64, more: &str) -> Simulation {
    let text = format!(
        "(duration: 1, bodies: {{
            \"low\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (5, 5, 5)), material: \"m\"),
            \"high\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4), elements: Tet4), material: \"m\", rotate: (0, 0, 17),
                translate: (0.003, -0.002, 0.01995))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 20)}},
        contacts: [Between(bodies: (\"low\", \"high\"), friction: {friction}{more})])"
    );
    let scene = SceneFile::from_text("surfaces.ron", &text, std::path::Path::new("."), &[])
        .unwrap_or_else(|wrong| panic!("{}", wrong.render(false)));
    let options = Options { backend: BackendChoice::Cpu, ..Options::default() };
    let mut simulation = Simulation::new(&scene, &options).unwrap();
    stir(&mut simulation);
    let world = simulation.world_mut();
    for body in entities::<ContactForce>(world) {
        let mut touch = world.get_mut::<SurfaceTouch>(body).unwrap();
        for row in 0..touch.len() / MEETING_NUMBERS {
            touch.set(MEETING_NUMBERS * row + 4, f64::from(row as u32 % 4));
            touch.set(MEETING_NUMBERS * row, 1e-6);
        }
    }
    simulation
}

/// A place is rounded some eight times on its way to a gap (a sum at rest, displacements, the nearest of a triangle,
/// and a difference), each to half a unit of 4 cm, and a force is a gap times what a metre comes to; sums and quotients
/// of forces themselves take some hundred roundings. Where a point just touches on one side and just does not on the
/// other, the shares of its nodes differ, and so do forces around it: of a random field that may be one in fifty.
#[test]
fn surfaces_push_the_same_nodes_with_the_same_forces() {
    for (friction, more) in
        [(0.0, ""), (0.4, ""), (0.4, ", sweeps: 3"), (0.4, ", law: Penalty(share: 0.5, damping: 0.2)")]
    {
        let Some(mut pair) = run_in("surface_contact", || world(friction, more)) else { return };
        let (mut touched, mut different) = (0, Vec::new());
        for body in entities::<ContactForce>(pair.host.world_mut()) {
            let of = |simulation: &Simulation, row: usize| {
                let world = simulation.world();
                let touch = world.get::<SurfaceTouch>(body).unwrap().get(MEETING_NUMBERS * row + 4);
                (world.get::<ContactForce>(body).unwrap().vector(row), touch)
            };
            let clock = *pair.before().resource::<Clock>();
            let masses = pair.before().get::<Mass>(body).unwrap();
            for row in 0..masses.len() {
                let [(host, state), (device, state_there)] = [of(&pair.host, row), of(&pair.device, row)];
                let to_force = masses.get(row) / (clock.time_step * clock.half_step_interval());
                let bound = 8.0 * 0.04 * UNIT * to_force + 100.0 * UNIT * host.length();
                touched += usize::from(host.length() > 0.0);
                if (host - device).length() > bound || state != state_there {
                    different.push((body, row, host, device, bound, state, state_there));
                }
            }
        }
        assert!(touched > 40, "only {touched} nodes are touched");
        assert!(50 * different.len() <= touched, "{} of {touched} nodes: {different:?}", different.len());
        eprintln!("friction {friction}{more}: {} of {touched} nodes beyond rounding", different.len());
    }
}

/// Lists that do not hold what is near are told from how far nodes have moved, and all triangles are gone through.
#[test]
fn old_lists_lose_no_contact_on_a_gpu() {
    let Some(gpu) = gpu_or_reason() else { return };
    let [mut fresh, mut old] = [(); 2].map(|()| world(0.3, ""));
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
        assert_eq!(a.bytes(), b.bytes(), "{body}");
        touched += a.vectors().filter(|force| force.length() > 0.0).count();
    }
    assert!(touched > 40, "{touched}");
}
