//! Whether what is called a result is one: checked anew, from positions and what the scene says.

use sinew::Simulation;
use sinew::components::{Alive, Authoring, Block, DisplacementIncrement, Label, Precision};
use sinew::elements::node_count;
use sinew::glam::{DMat3, DVec3};
use sinew::materials::FLATTEST;
use sinew::mesh::topology::tet10::POINTS;
use sinew::scene::schema::{ElementKind, Inversion};

/// What is wrong with a finished run, if anything.
pub fn check(simulation: &mut Simulation) -> Result<(), String> {
    let summary = simulation.summary("finished").map_err(|e| e.to_string())?;
    let untold = sinew::output::not_finite(&summary);
    if let Some((name, value)) = untold.first() {
        return Err(format!("status 0 with {value} as {name}"));
    }
    let bodies: Vec<String> = simulation.scene().bodies.keys().cloned().collect();
    for body in bodies {
        let (rest, moved) = (
            simulation.rest_positions(&body).map_err(|e| e.to_string())?,
            simulation.displacements(&body).map_err(|e| e.to_string())?,
        );
        if let Some(node) = moved.iter().position(|u| !u.is_finite()) {
            return Err(format!("status 0 with node {node} of {body} nowhere"));
        }
        if !simulation.scene().is_static() {
            // brings what steps carry on from a GPU
            simulation.snapshot().map_err(|e| e.to_string())?;
        }
        inside_out(simulation, &body, &rest, &moved)?;
    }
    Ok(())
}

/// Elements that are there although they are inside out and must not be. What is to be removed goes in the step that
/// begins with it flatter than [`FLATTEST`]: what has become so in the last step is still there.
fn inside_out(simulation: &mut Simulation, body: &str, rest: &[DVec3], moved: &[DVec3]) -> Result<(), String> {
    let entity = simulation.body(body).map_err(|e| e.to_string())?;
    let (world, scene) = (simulation.world(), simulation.scene());
    let Some(authoring) = world.get::<Authoring>(entity) else { return Ok(()) };
    let Some(last) = world.get::<DisplacementIncrement>(entity) else { return Ok(()) };
    let before: Vec<DVec3> =
        moved.iter().zip(&authoring.node_rows).map(|(u, &row)| *u - last.vector(row as usize)).collect();
    for (element, &(place, row)) in authoring.element_rows.iter().enumerate() {
        let entity = authoring.blocks[place as usize];
        let Some(block) = world.get::<Block>(entity) else { continue };
        let inversion = world.get::<Label>(block.material).map(|label| scene.materials[&label.0].inversion());
        let gone = world.get::<Alive>(entity).is_some_and(|alive| alive[row as usize] == 0);
        if gone || inversion == Some(Inversion::Recover) {
            continue;
        }
        let corners = authoring.cells.nodes(element);
        let of = |numbers: &[DVec3]| corners.iter().map(|&node| numbers[node as usize]).collect::<Vec<_>>();
        let after = moved;
        let (moved, least) = match inversion {
            Some(Inversion::Remove) => (&before[..], FLATTEST),
            _ => (moved, 0.0),
        };
        let lost = lost(&of(rest), &of(after), last.precision());
        for gradient in gradients(block.kind, &of(rest), &of(moved)) {
            let j = (DMat3::IDENTITY + gradient).determinant();
            // a volume that is nothing to what single precision leaves of it, or rounding of displacements, may have
            // either sign
            let (size, largest) = (size(&gradient, 0.0), size(&gradient, lost));
            if j < least - 1e-5 * size - (largest - size) || !j.is_finite() {
                return Err(format!("status 0 with element {element} of {body} inside out: J = {j:.3e}"));
            }
        }
    }
    Ok(())
}

/// What the last digits of an element's displacements may make of each component of ∇u.
fn lost(rest: &[DVec3], moved: &[DVec3], precision: Precision) -> f64 {
    let digit = if precision == Precision::F32 { f64::from(f32::EPSILON) } else { f64::EPSILON };
    let edge = rest[1..].iter().map(|x| (*x - rest[0]).length()).fold(f64::INFINITY, f64::min);
    4.0 * digit * moved.iter().map(|u| u.length()).fold(0.0, f64::max) / edge
}

/// What det(1 + ∇u) would be were all its products of one sign, and each component of ∇u larger by so much.
fn size(gradient: &DMat3, lost: f64) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|i| gradient.col(i).abs() + DMat3::IDENTITY.col(i) + lost);
    let minor = |a: usize, b: usize| y[a] * z[b] + y[b] * z[a];
    x[0] * minor(1, 2) + x[1] * minor(0, 2) + x[2] * minor(0, 1)
}

/// ∇u where an element of a kind looks at it: of tetrahedra the one there is, of hexahedra at eight Gauss points, or
/// the mean of those by volume; of wedges and of cells of second order at their points.
fn gradients(kind: ElementKind, rest: &[DVec3], moved: &[DVec3]) -> Vec<DMat3> {
    if rest.len() == 4 {
        let edges = |at: &[DVec3]| DMat3::from_cols(at[1] - at[0], at[2] - at[0], at[3] - at[0]);
        return vec![edges(moved) * edges(rest).inverse()];
    }
    if ![ElementKind::Hex8, ElementKind::Hex8MeanDilatation].contains(&kind) {
        let Some(solid) = kind.cell().topology().solid else { return Vec::new() };
        let at_point = |at: [f64; 3]| {
            let shape = (solid.shape)(at);
            let from_first: Vec<DVec3> = moved.iter().map(|u| *u - moved[0]).collect();
            shape.jacobian(&from_first) * shape.jacobian(rest).inverse()
        };
        return match kind {
            ElementKind::Tet10 => POINTS.map(at_point).to_vec(),
            _ => solid.quadrature.iter().map(|(at, _)| at_point(*at)).collect(),
        };
    }
    let signs = [(-1, -1), (1, -1), (1, 1), (-1, 1)];
    let corner = |a: usize| {
        let ((x, y), z) = (signs[a % 4], if a < 4 { -1 } else { 1 });
        DVec3::new(f64::from(x), f64::from(y), f64::from(z))
    };
    let at_point = |point: usize| {
        let at = corner(point) / 3_f64.sqrt();
        // ∂/∂(ξ, η, ζ) of Σ N_a v_a, N_a = (1 + ξξ_a)(1 + ηη_a)(1 + ζζ_a)/8
        let natural = |values: &[DVec3]| {
            let mut sum = DMat3::ZERO;
            for (a, value) in values.iter().enumerate() {
                let (s, f) = (corner(a), DVec3::ONE + corner(a) * at);
                let slope = DVec3::new(s.x * f.y * f.z, s.y * f.x * f.z, s.z * f.x * f.y) / 8.0;
                sum += DMat3::from_cols(*value * slope.x, *value * slope.y, *value * slope.z);
            }
            sum
        };
        let from_first: Vec<DVec3> = moved.iter().map(|u| *u - moved[0]).collect();
        let jacobian = natural(rest);
        (jacobian.determinant(), natural(&from_first) * jacobian.inverse())
    };
    let points: Vec<(f64, DMat3)> = (0..8).map(at_point).collect();
    if kind == ElementKind::Hex8MeanDilatation {
        return points.into_iter().map(|(_, gradient)| gradient).collect();
    }
    let volume: f64 = points.iter().map(|(volume, _)| volume).sum();
    vec![points.iter().fold(DMat3::ZERO, |sum, (share, gradient)| sum + *gradient * (share / volume))]
}

#[test]
fn the_check_knows_an_element_that_is_inside_out() {
    let cube: Vec<DVec3> = [(0., 0.), (1., 0.), (1., 1.), (0., 1.)]
        .iter()
        .flat_map(|&(x, y)| [DVec3::new(x, y, 0.0), DVec3::new(x, y, 1.0)])
        .collect();
    // bottom first, then top
    let cube: Vec<DVec3> = cube.iter().step_by(2).chain(cube.iter().skip(1).step_by(2)).copied().collect();
    let wanted = DMat3::from_cols_array(&[0.2, 0.3, 0.0, -0.1, 0.1, 0.4, 0.5, 0.0, -1.7]);
    for kind in ElementKind::ALL {
        let tet = [0, 1, 3, 4].map(|i| cube[i]);
        let middles = kind.cell().topology().edges.iter().map(|&[a, b]| 0.5 * (tet[a % 4] + tet[b % 4]));
        let rest: Vec<DVec3> = match node_count(kind) {
            4 => tet.to_vec(),
            6 => [0, 1, 3, 4, 5, 7].map(|i| cube[i]).to_vec(),
            10 => tet.into_iter().chain(middles).collect(),
            _ => cube.clone(),
        };
        let moved: Vec<DVec3> = rest.iter().map(|x| wanted * *x + DVec3::splat(3.0)).collect();
        for found in gradients(kind, &rest, &moved) {
            assert!((found - wanted).to_cols_array().iter().all(|x| x.abs() < 1e-12), "{kind:?}: {found}");
        }
    }
    assert!((DMat3::IDENTITY + wanted).determinant() < -1e-5 * size(&wanted, 0.0));
    assert_eq!(size(&DMat3::from_diagonal(DVec3::new(1.0, 2.0, -3.0)), 0.0), 2.0 * 3.0 * 4.0);
    assert_eq!(size(&DMat3::ZERO, 1.0), 8.0 + 4.0 + 4.0);
}
