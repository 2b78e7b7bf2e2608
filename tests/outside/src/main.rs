//! A hook that pulls one node of a cube, with parameters from the scene, in a crate that depends on sinew alone.

use sinew::prelude::*;

/// What the scene says under `parameters`.
#[derive(Resource, serde::Deserialize)]
#[serde(crate = "sinew::serde", deny_unknown_fields)]
struct Hook {
    force: DVec3,
}

/// What it is hooked into.
#[derive(Resource)]
struct Grip(NodeSet);

fn hook(hook: Res<Hook>, grip: Res<Grip>, mut bodies: Query<&mut ExternalForce>) -> Result<(), Error> {
    grip.0.add_force(&mut bodies, hook.force)
}

const SCENE: &str = r#"(
    duration: 0.02,
    bodies: {"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (5, 5, 5)), material: "soft")},
    materials: {"soft": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))},
    constraints: [Fixed(on: Set("z0"))],
    parameters: {"hook": (force: (0, 0, 0.05))},
)"#;

fn main() -> Result<(), Error> {
    // the mesh's own number of the corner (0.1, 0.1, 0.1)
    const CORNER: u64 = 215;
    let scene = SceneFile::from_text("hook", SCENE, ".".as_ref(), &[])?;
    let system = System::custom("hook", Phase::Loads, "pulls a node", hook).with_parameters::<Hook>();
    let options = Options { backend: BackendChoice::Cpu, ..Options::default() };
    let mut simulation = Simulation::with_systems(&scene, &options, &Registry::default().with(system))?;
    let corner = simulation.nodes_numbered("cube", &[CORNER])?;
    simulation.world_mut().insert_resource(Grip(corner.clone()));
    let started = std::time::Instant::now();
    simulation.finish()?;
    let took = started.elapsed();

    let moved = simulation.displacements("cube")?;
    let farthest = (0..moved.len()).max_by(|&a, &b| moved[a].z.total_cmp(&moved[b].z)).unwrap_or_default();
    let number = simulation.node_numbers("cube")?[farthest];
    let state = simulation.node_state(&corner)?[0];
    println!(
        "node {number} is {:.3} mm up; {} steps took {took:.2?}",
        1e3 * state.displacement.z,
        simulation.step_count()
    );
    if number != CORNER || state.rest != DVec3::splat(0.1) || moved[farthest] != state.displacement {
        return Err(Error::Options(format!("node {CORNER} at {} was pulled, and node {number} moved", state.rest)));
    }
    match simulation.nodes_numbered("cube", &[216]) {
        Err(error) if error.to_string().contains("no node 216") => Ok(()),
        found => Err(Error::Options(format!("a node that is not there: {found:?}"))),
    }
}
