//! Picking: rays meet surfaces where they are.

use crate::configurations::{configurations, near};
use sinew::glam::DVec3;
use sinew::{Pick, Simulation};

fn scene(elements: &str, acts: &str) -> String {
    let body = |origin: &str| {
        format!(
            "(mesh: Box(size: (0.1, 0.2, 0.1), cells: (3, 4, 3), elements: {elements}), translate: {origin}, material: \"m\")"
        )
    };
    format!(
        "(duration: 1, bodies: {{\"a\": {}, \"b\": {}}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}}, {acts})",
        body("(0, 0, 0)"),
        body("(0, 0, -1)")
    )
}

/// The point that the weights give, from where the nodes are now.
fn weighted(simulation: &mut Simulation, pick: &Pick) -> DVec3 {
    let (rest, u) = (simulation.rest_positions(&pick.body).unwrap(), simulation.displacements(&pick.body).unwrap());
    (0..3).map(|i| pick.weights[i] * (rest[pick.nodes[i] as usize] + u[pick.nodes[i] as usize])).sum()
}

#[test]
fn a_ray_meets_the_nearest_body_where_it_is() {
    for run in configurations() {
        for elements in ["Hex8", "Tet4"] {
            let mut simulation = run.start(&scene(elements, ""));
            let (from, down) = (DVec3::new(0.031, 0.157, 0.6), DVec3::new(0.0, 0.0, -3.0));
            let pick = simulation.pick(from, down).unwrap().unwrap();
            assert_eq!(pick.body, "a");
            near("distance", pick.distance, 0.5, 0.5, 1e-9);
            assert!((pick.point - DVec3::new(0.031, 0.157, 0.1)).length() < 1e-9, "{:?}", pick.point);
            assert!((pick.normal - DVec3::Z).length() < 1e-9);
            assert!((weighted(&mut simulation, &pick) - pick.point).length() < 1e-12);
            near("weights", pick.weights.iter().sum(), 1.0, 1.0, 1e-12);
            assert!(pick.nodes.iter().all(|node| pick.face.contains(node)), "{pick:?}");
            // from below the other one is nearer; from beside, neither
            let up = simulation.pick(DVec3::new(0.05, 0.05, -2.0), DVec3::Z).unwrap().unwrap();
            assert_eq!(up.body, "b");
            near("from below", up.distance, 1.0, 1.0, 1e-9);
            assert_eq!(simulation.pick(DVec3::new(0.11, 0.05, 1.0), -DVec3::Z).unwrap(), None);
            assert_eq!(simulation.pick(from, DVec3::Z).unwrap(), None);
            // along a slanted ray, to a point that is known
            let goal = DVec3::new(0.1, 0.13, 0.04);
            let from = goal + DVec3::new(0.3, 0.1, 0.2);
            let pick = simulation.pick(from, goal - from).unwrap().unwrap();
            assert!((pick.point - goal).length() < 1e-9 && (pick.normal - DVec3::X).length() < 1e-9, "{pick:?}");
            assert!(simulation.pick(from, DVec3::ZERO).is_err() && simulation.pick(from, DVec3::NAN).is_err());
        }
    }
}

#[test]
fn a_ray_meets_a_deformed_body_where_it_has_gone() {
    // u = (0.2 x + 0.1 z + 0.01, 0, -0.1 z): the top is at 0.09, its corner (0.1, ·) at 0.14
    let moves = "constraints: [Prescribed(body: \"a\", on: All, displacement: (0.01, 0, 0),
        gradient: ((0.2, 0, 0.1), (0, 0, 0), (0, 0, -0.1)), curve: Smooth(end: 0.1))]";
    for run in configurations() {
        let mut simulation = run.start(&scene("Hex8", moves));
        simulation.advance_to(0.12).unwrap();
        let pick = simulation.pick(DVec3::new(0.135, 0.1, 1.0), -DVec3::Z).unwrap().unwrap();
        near("the top", pick.point.z, 0.09, 0.1, run.bound(1e-9, 1e-6));
        assert!(simulation.pick(DVec3::new(0.145, 0.1, 1.0), -DVec3::Z).unwrap().is_none_or(|pick| pick.body == "b"));
        // the slanted side x = 0.13 + 0.1 Z, half way up
        let pick = simulation.pick(DVec3::new(1.0, 0.1, 0.045), -DVec3::X).unwrap().unwrap();
        near("the side", pick.point.x, 0.135, 0.1, run.bound(1e-9, 1e-6));
        let normal = DVec3::new(0.09, 0.0, -0.01).normalize();
        assert!((pick.normal - normal).length() < 1e-4, "{:?}", pick.normal);
    }
}

#[test]
fn a_ray_meets_what_removal_lays_bare() {
    let cut = "removal: [(body: \"a\", on: Box(min: (0, 0, 0.07), max: (0.1, 0.2, 0.1)), when: At(0.01))],
        constraints: [Fixed(body: \"a\", on: All)]";
    for run in configurations() {
        let mut simulation = run.start(&scene("Hex8", cut));
        let (from, down) = (DVec3::new(0.03, 0.1, 1.0), -DVec3::Z);
        let whole = simulation.pick(from, down).unwrap().unwrap();
        simulation.advance_to(0.03).unwrap();
        let cut = simulation.pick(from, down).unwrap().unwrap();
        near("a layer less", cut.distance - whole.distance, 0.1 / 3.0, 0.1, 1e-6);
        assert_ne!(whole.element, cut.element);
    }
}
