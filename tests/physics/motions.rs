//! Prescribed motion: displacement + gradient·(X − center) + (R(rotation) − 1)(X − center), times its curve, by axis.
//!
//! Nodes are at the curve's value at the end of each step. Bounds: rounding of u, and of the sum of steps: 1e-12 of the
//! body's size in f64, 1e-6 in f32.

use crate::configurations::configurations;
use glam::{DMat3, DVec3};

#[test]
fn prescribed_nodes_are_where_the_formula_says_along_their_axes_only() {
    let gradient =
        DMat3::from_cols(DVec3::new(0.1, 0.02, 0.0), DVec3::new(0.0, -0.1, 0.03), DVec3::new(0.05, 0.0, 0.2));
    let (shift, center) = (DVec3::new(0.01, -0.02, 0.03), DVec3::new(0.05, 0.1, 0.0));
    for run in configurations() {
        for (axes, told) in [("X, Y, Z", [true; 3]), ("X, Z", [true, false, true]), ("Y", [false, true, false])] {
            let mut simulation = run.start(&format!(
                "(duration: 0.1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
                constraints: [Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), axes: [{axes}], displacement: (0.01, -0.02, 0.03),
                    gradient: {}, rotation: (10, -20, 50), center: (0.05, 0.1, 0), curve: Smooth(start: 0.01, end: 0.08))],
                integration: (step: 5e-4))",
                crate::random::rows(gradient)
            ));
            for steps in [10, 50, 60, 80] {
                simulation.advance(steps).unwrap();
                let s = ((simulation.time() - 0.01) / 0.07).clamp(0.0, 1.0);
                let factor = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
                let rotation = DVec3::new(10.0, -20.0, 50.0) * std::f64::consts::PI / 180.0;
                let turn = DMat3::from_axis_angle(rotation.normalize(), rotation.length() * factor);
                let (rest, u) = (simulation.rest_positions("b").unwrap(), simulation.displacements("b").unwrap());
                for (x, u) in rest.iter().zip(u).filter(|(x, _)| x.z > 0.0999) {
                    let arm = *x - center;
                    let expected = shift * factor + gradient * arm * factor + turn * arm - arm;
                    for axis in 0..3 {
                        let error = (u[axis] - expected[axis]).abs() / 0.1;
                        if told[axis] {
                            assert!(
                                error < run.bound(1e-12, 1e-6),
                                "{}: {u} instead of {expected}: {error:e}",
                                run.name
                            );
                        } else if factor == 1.0 {
                            assert!(error > 1e-4, "{}: axis {axis} is free and yet moves as told", run.name);
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn fixed_nodes_stay_along_their_axes_only() {
    for run in configurations() {
        let mut simulation = run.start(
            "(duration: 0.1, bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: \"m\", velocity: (0.1, 0.1, 0.1))},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0), axes: [X, Z])])",
        );
        simulation.advance_to(0.05).unwrap();
        let (rest, u) = (simulation.rest_positions("b").unwrap(), simulation.displacements("b").unwrap());
        for (_, u) in rest.iter().zip(u).filter(|(x, _)| x.z == 0.0) {
            assert!(u.x == 0.0 && u.z == 0.0 && u.y > 1e-3, "{}: {u}", run.name);
        }
    }
}
