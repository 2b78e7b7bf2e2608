//! The author's nodes in systems of one's own: who is named is who moves, whatever the engine's order is.

use crate::configurations::{configurations, scene_of};
use sinew::prelude::*;
use std::path::Path;

#[derive(Resource)]
struct Grip(NodeSet);

fn pull(grip: Res<Grip>, mut bodies: Query<&mut ExternalForce>) -> Result<(), Error> {
    grip.0.add_forces(&mut bodies, |place| DVec3::new(0.0, 0.0, 1e-3 * (place + 1) as f64))
}

/// A mesh whose file names its nodes as it likes, beside a body that must stay at rest.
fn scene() -> String {
    r#"(
        duration: 1,
        bodies: {
            "lens": (mesh: File(path: "scenes/meshes/lens_814.msh"), material: "m"),
            "other": (mesh: Box(size: (1, 1, 1), cells: (3, 3, 3)), material: "m"),
        },
        materials: {"m": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))},
        schedule: ["element_forces", "gather", "pull", "integrate", "observe"],
    )"#
    .into()
}

fn simulation(options: &Options) -> Simulation {
    let system = System::custom("pull", Phase::Loads, "pulls nodes", pull);
    let scene = scene_of(&scene(), Path::new(env!("CARGO_MANIFEST_DIR")));
    Simulation::with_systems(&scene, options, &Registry::default().with(system)).unwrap()
}

#[test]
fn who_is_named_is_who_is_pulled() {
    for run in configurations() {
        let mut simulation = simulation(&run.options);
        let numbers = simulation.node_numbers("lens").unwrap();
        let chosen: Vec<u64> = numbers.iter().copied().step_by(37).take(5).collect();
        let set = simulation.nodes_numbered("lens", &chosen).unwrap();
        // the test means something: the three orders differ
        let places: Vec<usize> = chosen.iter().map(|n| numbers.iter().position(|other| other == n).unwrap()).collect();
        assert_ne!(set.rows(), places, "the engine's order is the author's");
        assert_ne!(chosen, places.iter().map(|&place| place as u64).collect::<Vec<u64>>(), "numbers are places");
        assert_eq!(set, simulation.nodes_at("lens", &places).unwrap());
        simulation.world_mut().insert_resource(Grip(set.clone()));
        simulation.advance(1).unwrap();
        let moved = simulation.displacements("lens").unwrap();
        for (place, u) in moved.iter().enumerate() {
            let pulled = places.contains(&place);
            assert_eq!(*u != DVec3::ZERO, pulled, "{}: node {} moved by {u}", run.name, numbers[place]);
        }
        // u = f Δt²/(2m), a force for each
        let (states, step) = (simulation.node_state(&set).unwrap(), simulation.time_step());
        let (rest, masses) = (simulation.rest_positions("lens").unwrap(), simulation.masses("lens").unwrap());
        for (number, (state, &place)) in states.iter().zip(&places).enumerate() {
            let u = 1e-3 * (number + 1) as f64 * step * step / (2.0 * masses[place]);
            assert!(
                (state.displacement.z - u).abs() <= 1e-5 * u,
                "{}: {} instead of {u}",
                run.name,
                state.displacement.z
            );
            assert_eq!((state.rest, state.displacement, state.mass), (rest[place], moved[place], masses[place]));
        }
        assert!(simulation.displacements("other").unwrap().iter().all(|u| *u == DVec3::ZERO), "{}", run.name);
    }
}

#[test]
fn nodes_that_are_not_there_are_an_error() {
    let options = Options { backend: BackendChoice::Cpu, ..Options::default() };
    let mut simulation = simulation(&options);
    let numbers = simulation.node_numbers("lens").unwrap();
    let (least, most) = (*numbers.iter().min().unwrap(), *numbers.iter().max().unwrap());
    let told = simulation.nodes_numbered("lens", &[least, most + 1]).unwrap_err().to_string();
    assert_eq!(told, format!("lens has no node {}; it has {} between {least} and {most}", most + 1, numbers.len()));
    let told = simulation.nodes_at("lens", &[numbers.len()]).unwrap_err().to_string();
    assert!(told.contains(&format!("{} nodes, counted from 0", numbers.len())), "{told}");
    assert!(simulation.nodes_numbered("lense", &[1]).unwrap_err().to_string().contains("no body named"));
    // of another simulation, whose entities may bear the same numbers
    let scene = scene().replace("lens_814", "lens_7880");
    let scene = scene_of(&scene, Path::new(env!("CARGO_MANIFEST_DIR")));
    let system = System::custom("pull", Phase::Loads, "pulls nodes", pull);
    let mut other = Simulation::with_systems(&scene, &options, &Registry::default().with(system)).unwrap();
    let foreign = other.nodes_at("lens", &[0]).unwrap();
    assert!(simulation.node_state(&foreign).unwrap_err().to_string().contains("make the set anew"));
    simulation.world_mut().insert_resource(Grip(foreign));
    assert!(simulation.advance(1).unwrap_err().to_string().contains("make the set anew"));
}

#[test]
fn a_column_is_seen_without_a_copy_and_says_when_it_is_another() {
    for run in configurations() {
        let mut simulation = simulation(&run.options);
        let set = simulation.nodes_at("lens", &[3]).unwrap();
        simulation.world_mut().insert_resource(Grip(set));
        simulation.advance(3).unwrap();
        let before = simulation.snapshot().unwrap();
        let wanted = simulation.displacements("lens").unwrap();
        let mut vertices = vec![0.0_f32; 3 * wanted.len()];
        let column = simulation.column::<Displacement>("lens").unwrap();
        assert_eq!((column.rows(), column.numbers()), (wanted.len(), 3));
        column.copy_in_authors_order(&mut vertices).unwrap();
        let rounded: Vec<f32> = wanted.iter().flat_map(|u| u.as_vec3().to_array()).collect();
        assert!(vertices == rounded && rounded.iter().any(|u| *u != 0.0), "{}", run.name);
        let rows = column.node_rows().iter().map(|&row| column.values().vector(row as usize));
        assert!(rows.eq(wanted.iter().copied()), "{}", run.name);
        assert!(column.copy_in_authors_order(&mut [0.0; 4]).is_err());
        // looking changes nothing; steps, snapshots and who writes do
        let mut seen = vec![column.generation()];
        let mut generation = |simulation: &mut Simulation, is_another: bool| {
            let now = simulation.column::<Displacement>("lens").unwrap().generation();
            assert_eq!(!seen.contains(&now), is_another, "{}: {now} after {seen:?}", run.name);
            seen.push(now);
        };
        generation(&mut simulation, false);
        simulation.advance(1).unwrap();
        generation(&mut simulation, true);
        generation(&mut simulation, false);
        for _ in 0..2 {
            simulation.restore(&before).unwrap();
            generation(&mut simulation, true);
        }
        let body = simulation.body("lens").unwrap();
        for _ in 0..2 {
            simulation.world_mut().get_mut::<Displacement>(body).unwrap().set(0, 1.0);
            generation(&mut simulation, true);
        }
        // what has no row a node, and what the scene does not call for
        assert!(simulation.column::<sinew::components::ElementForce>("lens").is_err());
        assert!(simulation.column::<sinew::components::DampingCoefficient>("lens").is_err());
    }
}
