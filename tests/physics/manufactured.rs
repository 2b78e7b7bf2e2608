//! Orders of convergence, by a manufactured solution with a body force (finite strain, neo-Hookean, μ = 1154, κ = 2500
//! Pa).
//!
//! u(X) = a sin(πX/L₁) sin(πY/L₂) sin(πZ/L₃) in a block whose surface is held; ∂u/∂X reaches a third. The body force
//! that makes it the equilibrium is b = −Div P(∇u), with P = μ J^(−2/3) (F − tr C/3 F⁻ᵀ) + κ (J − 1) J F⁻ᵀ written out
//! here once more, differentiated by differences in f64 (error 1e-8). A custom system applies ρ⁻¹ m b at the nodes.
//!
//! Errors are in the L2 norm weighted with the nodes' masses, relative to u. Doubling the cells in each direction must
//! divide them by four: order 2. Stored are the orders that were found in f64; f32 agrees to what rounding leaves.

use crate::configurations::{Configuration, configurations};
use sinew::bevy_ecs::prelude::*;
use sinew::components::{Clock, ExternalForce, Mass, RestPosition};
use sinew::glam::{DMat3, DVec3};
use sinew::systems::{Phase, Registry, System};
use sinew::{SceneFile, Simulation};
use std::f64::consts::PI;
use std::path::Path;

const SIZE: DVec3 = DVec3::new(0.1, 0.08, 0.12);
const AMPLITUDE: DVec3 = DVec3::new(0.006, -0.004, 0.008);
const SHEAR: f64 = 1153.846;
const BULK: f64 = 2500.0;
const DENSITY: f64 = 1000.0;

/// Elements, and the order from 6 to 12 cells along each edge as found in f64. (Loads gathered at the nodes, without
/// the smoothing of shape functions, make the errors of hexahedra larger than those of tetrahedra here; the order is
/// the same.)
const ORDERS: [(&str, f64); 4] =
    [("Tet4", 1.921), ("Tet4NodalPressure", 1.964), ("Hex8", 2.068), ("Hex8MeanDilatation", 2.072)];

fn displacement(at: DVec3) -> DVec3 {
    let s = at / SIZE * PI;
    AMPLITUDE * (s.x.sin() * s.y.sin() * s.z.sin())
}

fn first_stress(at: DVec3) -> DMat3 {
    let (s, k) = (at / SIZE * PI, PI / SIZE);
    let slope = DVec3::new(
        k.x * s.x.cos() * s.y.sin() * s.z.sin(),
        k.y * s.x.sin() * s.y.cos() * s.z.sin(),
        k.z * s.x.sin() * s.y.sin() * s.z.cos(),
    );
    let f = DMat3::IDENTITY + DMat3::from_cols(AMPLITUDE * slope.x, AMPLITUDE * slope.y, AMPLITUDE * slope.z);
    let (j, c) = (f.determinant(), f.transpose() * f);
    let inverse = f.inverse().transpose();
    let trace = c.x_axis.x + c.y_axis.y + c.z_axis.z;
    (f - inverse * (trace / 3.0)) * (SHEAR * j.powf(-2.0 / 3.0)) + inverse * (BULK * (j - 1.0) * j)
}

/// −Div P (N/m³).
fn body_force(at: DVec3) -> DVec3 {
    let step = 1e-5 * SIZE.x;
    let along = |axis: DVec3| (first_stress(at + axis * step) - first_stress(at - axis * step)) * (0.5 / step) * axis;
    -(along(DVec3::X) + along(DVec3::Y) + along(DVec3::Z))
}

/// Once made, the forces per mass (m/s²) are kept.
fn push(clock: Res<Clock>, mut made: Local<Vec<DVec3>>, mut bodies: Query<(&RestPosition, &Mass, &mut ExternalForce)>) {
    for (rest, mass, mut force) in &mut bodies {
        if made.is_empty() {
            made.extend(rest.0.iter().map(|&at| body_force(at) / DENSITY));
        }
        for (row, &acceleration) in made.iter().enumerate() {
            let sum = force.vector(row) + acceleration * (mass.get(row) * clock.time());
            force.set_vector(row, sum);
        }
    }
}

/// The relative L2 error with so many cells along each edge.
fn error(run: &Configuration, elements: &str, cells: usize) -> f64 {
    let scene = format!(
        "(duration: 1, analysis: Static(), bodies: {{\"b\": (mesh: Box(size: ({}, {}, {}), cells: ({cells}, {cells}, {cells}), elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: {DENSITY}, neo_hookean: Moduli(shear: {SHEAR}, bulk: {BULK}))}},
        constraints: [Fixed(on: Surface())],
        schedule: [\"boundary\", {}\"element_forces\", \"gather\", \"push\", \"integrate\", \"observe\"])",
        SIZE.x, SIZE.y, SIZE.z,
        if elements == "Tet4NodalPressure" { "\"nodal_volume\", " } else { "" }
    );
    let file = SceneFile::from_text("manufactured", &scene, Path::new("."), &[])
        .unwrap_or_else(|wrong| panic!("{}", wrong.render(false)));
    let registry = Registry::default().with(System::custom("push", Phase::Loads, "applies the body force", push));
    let mut simulation = Simulation::with_systems(&file, &run.options, &registry).unwrap();
    simulation.finish().unwrap_or_else(|error| panic!("{}, {elements}, {cells}: {error}", run.name));
    let (rest, masses) = (simulation.rest_positions("b").unwrap(), simulation.masses("b").unwrap());
    let found = simulation.displacements("b").unwrap();
    let (mut square, mut whole) = (0.0, 0.0);
    for node in 0..rest.len() {
        let exact = displacement(rest[node]);
        square += masses[node] * (found[node] - exact).length_squared();
        whole += masses[node] * exact.length_squared();
    }
    (square / whole).sqrt()
}

#[test]
#[ignore = "long"]
fn displacements_converge_with_the_square_of_the_cell_size() {
    let mut wrong = Vec::new();
    for run in configurations() {
        for (elements, stored) in ORDERS {
            let errors = [6, 12].map(|cells| error(&run, elements, cells));
            let order = (errors[0] / errors[1]).log2();
            println!("{}, {elements}: errors {:.3e}, {:.3e}, order {order:.3}", run.name, errors[0], errors[1]);
            if (order - stored).abs() > run.bound(2e-3, 5e-3) {
                wrong.push(format!("{}, {elements}: order {order:.3} instead of {stored}", run.name));
            }
        }
    }
    assert_eq!(wrong, Vec::<String>::new());
}
