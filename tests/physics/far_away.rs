//! H23 of the hard cases: far from the origin nothing changes. A mesh that lies 10 km away swings as at the origin; a
//! body that flies 10 km keeps its strains in f64.
//!
//! Rest shapes are differences of f64 coordinates: 1e4 m leave 2e-12 m, a strain of 4e-10 in cells of 5 mm.
//! Displacements in f32 have 24 bits: after 1e4 m of flight they are known to 5e-4 m, which is why f64 is for such
//! flights, and f32 warns.

use crate::configurations::{Configuration, ELEMENTS, configurations, near};
use sinew::Simulation;
use sinew::components::Precision;
use sinew::glam::DVec3;

fn largest_difference(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).fold(0.0, |worst: f64, (a, b)| worst.max((*a - *b).length()))
}

fn swing(run: &Configuration, elements: &str, place: DVec3) -> Vec<DVec3> {
    let mut simulation = run.start(&format!(
        "(duration: 0.2, bodies: {{\"b\": (mesh: Box(size: (0.04, 0.01, 0.01), cells: (8, 2, 2), elements: {elements}), material: \"m\", translate: ({}, {}, {}))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))}},
        constraints: [Fixed(on: Set(\"x0\"))], loads: [Gravity(acceleration: (0, 0, -9.81))])",
        place.x, place.y, place.z
    ));
    simulation.finish().unwrap();
    simulation.displacements("b").unwrap()
}

#[test]
#[ignore = "long"]
fn a_mesh_far_away_swings_as_at_the_origin() {
    for run in configurations() {
        for elements in ELEMENTS {
            let (here, there) = (swing(&run, elements, DVec3::ZERO), swing(&run, elements, DVec3::new(1e4, -2e4, 7e3)));
            let largest = here.iter().fold(0.0, |largest: f64, u| largest.max(u.length()));
            assert!(largest > 5e-3, "it falls by {largest} m only");
            near(&format!("{}, {elements}", run.name), largest_difference(&here, &there) / largest, 0.0, 1.0, 1e-5);
        }
    }
}

fn ringing(run: &Configuration, elements: &str, velocity: f64) -> Simulation {
    let mut simulation = run.start(&format!(
        "(duration: 0.1, bodies: {{\"b\": (mesh: Box(size: (0.04, 0.01, 0.01), cells: (8, 2, 2), elements: {elements}), material: \"m\", velocity: ({velocity}, 0, 0))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))}},
        loads: [Traction(on: Set(\"x0\"), traction: (-200, 0, 0)), Traction(on: Set(\"x1\"), traction: (200, 0, 0))])"
    ));
    simulation.finish().unwrap();
    simulation
}

/// A free block that is suddenly pulled at both ends rings; seen from its middle it does so in flight as at rest.
fn ring(run: &Configuration, elements: &str, velocity: f64) -> Vec<DVec3> {
    let u = ringing(run, elements, velocity).displacements("b").unwrap();
    let middle = u.iter().sum::<DVec3>() / u.len() as f64;
    u.into_iter().map(|u| u - middle).collect()
}

#[test]
fn a_body_that_flies_far_keeps_its_strains_in_f64() {
    let all = configurations();
    let run = all.iter().find(|run| run.options.precision == Precision::F64).unwrap();
    for elements in ELEMENTS {
        let (here, there) = (ring(run, elements, 0.0), ring(run, elements, 1e5));
        let largest = here.iter().fold(0.0, |largest: f64, u| largest.max(u.length()));
        assert!(largest > 1e-4, "it rings by {largest} m only");
        near(elements, largest_difference(&here, &there) / largest, 0.0, 1.0, 1e-5);
    }
}

#[test]
fn a_body_that_flies_far_in_f32_is_warned_of() {
    for run in configurations() {
        for (velocity, far) in [(10.0, false), (1e5, true)] {
            let simulation = ringing(&run, "Tet4", velocity);
            let warned: Vec<_> =
                simulation.guards().warnings.into_iter().filter(|w| w.criterion == "rounding").collect();
            let wanted = usize::from(far && run.options.precision == Precision::F32);
            assert_eq!(warned.len(), wanted, "{}, {velocity} m/s: {warned:?}", run.name);
            for notice in warned {
                assert!(notice.part == "b" && notice.message.contains("--precision f64"), "{notice:?}");
                // u·2⁻²⁴/h passes 1e-4 at 8.4 m in cells of 5 mm; checks are up to 256 steps apart
                assert!(notice.value > 1e-4 && notice.time < 0.06, "{notice:?}");
            }
        }
    }
}
