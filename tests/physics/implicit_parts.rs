//! Parts of an implicit step by themselves: products with the tangent stiffness, and the preconditioner of two levels.

use crate::configurations::scene_of;
use crate::implicit::options;
use glam::{DMat3, DQuat, DVec3};
use sinew::components::{Authoring, Block, Connectivity, Precision, RestPosition};
use sinew::math::lane_place;
use sinew::{Simulation, TwoLevelParts};
use std::path::Path;

const SHEAR: f64 = 3e3 / 2.9;
const BULK: f64 = 3e3 / 0.3;

fn start(scene: &str) -> Simulation {
    Simulation::new(&scene_of(scene, Path::new(".")), &options(Precision::F64, 1)).unwrap()
}

fn contract(a: DMat3, b: DMat3) -> f64 {
    a.x_axis.dot(b.x_axis) + a.y_axis.dot(b.y_axis) + a.z_axis.dot(b.z_axis)
}

/// δP of P = μ J^(−2/3) (F − I₁/3 F⁻ᵀ) + κ (J − 1) J F⁻ᵀ.
fn neo_hookean_change(f: DMat3, along: DMat3) -> DMat3 {
    let (j, inverse, squares) = (f.determinant(), f.inverse().transpose(), contract(f, f));
    let (growth, turned) = (contract(inverse, along), inverse * along.transpose() * inverse);
    let isochoric = along - inverse * (2.0 / 3.0 * contract(f, along)) + turned * (squares / 3.0)
        - (f - inverse * (squares / 3.0)) * (2.0 / 3.0 * growth);
    let volumetric = inverse * ((2.0 * j - 1.0) * j * growth) - turned * ((j - 1.0) * j);
    isochoric * (SHEAR * j.powf(-2.0 / 3.0)) + volumetric * BULK
}

/// Gradient of a field over a tetrahedron, and of its shape functions (1/m), with its volume (m³).
fn at(rest: [DVec3; 4], field: [DVec3; 4]) -> (DMat3, [DVec3; 4], f64) {
    let edges = DMat3::from_cols(rest[1] - rest[0], rest[2] - rest[0], rest[3] - rest[0]);
    let rows = edges.inverse().transpose();
    let shapes = [-(rows.x_axis + rows.y_axis + rows.z_axis), rows.x_axis, rows.y_axis, rows.z_axis];
    let gradient = (0..4).fold(DMat3::ZERO, |sum, a| {
        sum + DMat3::from_cols(field[a] * shapes[a].x, field[a] * shapes[a].y, field[a] * shapes[a].z)
    });
    (gradient, shapes, edges.determinant() / 6.0)
}

/// K p of all tetrahedra of a body by their closed form.
fn closed_form(simulation: &mut Simulation, u: &[f64], p: &[f64]) -> Vec<f64> {
    let body = simulation.body("b").unwrap();
    let world = simulation.world();
    let rest = &world.get::<RestPosition>(body).unwrap().0;
    let mut image = vec![0.0; p.len()];
    for &entity in &world.get::<Authoring>(body).unwrap().blocks {
        let (block, connectivity) = (world.get::<Block>(entity).unwrap(), world.get::<Connectivity>(entity).unwrap());
        for row in 0..block.count {
            let nodes = [0, 1, 2, 3].map(|corner| connectivity[lane_place(row, 4, corner)] as usize);
            let of = |field: &[f64]| nodes.map(|node| DVec3::from_slice(&field[3 * node..]));
            let rest = nodes.map(|node| rest[node]);
            let (deformed, shapes, volume) = at(rest, of(u));
            let (along, ..) = at(rest, of(p));
            let change = neo_hookean_change(DMat3::IDENTITY + deformed, along);
            for (node, shape) in nodes.into_iter().zip(shapes) {
                let force = change * shape * volume;
                (0..3).for_each(|i| image[3 * node + i] += force[i]);
            }
        }
    }
    image
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Of a body that is bent, stretched and squeezed; q·Kp = p·Kq.
#[test]
fn products_are_those_of_the_closed_form_and_symmetric() {
    let mut simulation = start(
        "(duration: 1, solver: Implicit(),
        bodies: {\"b\": (mesh: Box(size: (0.1, 0.04, 0.03), cells: (5, 3, 2), elements: Tet4), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))})",
    );
    let body = simulation.body("b").unwrap();
    let bent = |x: &DVec3| DVec3::new(0.2 * x.x - 3.0 * x.x * x.z, 4.0 * x.x * x.x, -0.3 * x.z + 2.0 * x.x * x.y);
    let rest = simulation.world().get::<RestPosition>(body).unwrap().0.clone();
    let w: Vec<f64> = rest.iter().flat_map(|x| bent(x).to_array()).collect();
    let vector = |seed: f64| -> Vec<f64> { (0..w.len()).map(|axis| (seed * (axis as f64 + 1.0)).sin()).collect() };
    let motions = [vector(0.37), vector(1.91)];
    let images = simulation.stiffness_by_differences(&w, &motions).unwrap();
    let ([p, q], [of_p, of_q]) = (&motions, &images[..]) else { panic!("an element is turned inside out") };
    let (one, other) = (dot(q, of_p), dot(p, of_q));
    let size = (dot(p, of_p) * dot(q, of_q)).sqrt();
    assert!((one - other).abs() < 1e-6 * size, "{one} and {other} of {size}");
    for (p, image) in motions.iter().zip(&images) {
        let expected = closed_form(&mut simulation, &w, p);
        let off: Vec<f64> = image.iter().zip(&expected).map(|(a, b)| a - b).collect();
        assert!(dot(&off, &off) < 1e-12 * dot(&expected, &expected), "{:e}", dot(&off, &off).sqrt());
    }
}

/// A block that may slide on the plane z = 0, and one that nothing holds; what preconditions them where a step is
/// 0.01 s.
fn two_blocks() -> (Simulation, TwoLevelParts) {
    let mut simulation = start(
        "(duration: 1, solver: Implicit(),
        bodies: {
            \"sliding\": (mesh: Box(size: (0.1, 0.04, 0.03), cells: (8, 4, 3), elements: Tet4), material: \"m\"),
            \"free\": (mesh: Box(size: (0.04, 0.03, 0.05), cells: (4, 3, 5), elements: Hex8MeanDilatation), material: \"m\"),
        },
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
        constraints: [Fixed(body: \"sliding\", on: Plane(normal: (0, 0, 1), at: 0), axes: [Z])])",
    );
    let parts = TwoLevelParts::of(&mut simulation, 0.01);
    (simulation, parts)
}

fn vector(parts: &TwoLevelParts, seed: f64) -> Vec<f64> {
    let number = |(axis, free): (usize, &bool)| if *free { (seed * (axis as f64 + 1.0)).sin() } else { 0.0 };
    parts.free().iter().enumerate().map(number).collect()
}

/// Turns all nodes about the z axis, and bends them.
fn turn(simulation: &mut Simulation, parts: &TwoLevelParts, angle: f64, bend: f64) {
    let rotation = DQuat::from_rotation_z(angle);
    let mut places = Vec::new();
    for (body, _) in parts.bodies() {
        let rest = &simulation.world().get::<RestPosition>(body).unwrap().0;
        places.extend(rest.iter().flat_map(|x| {
            let bent = *x + DVec3::new(0.0, bend * x.x * x.x, 0.0);
            (rotation * bent - *x).to_array()
        }));
    }
    parts.displace(simulation, &places);
}

#[test]
fn two_levels_are_symmetric_and_positive_at_rest_and_turned_where_nodes_slide_and_where_they_are_free() {
    let (mut simulation, mut parts) = two_blocks();
    let axes = parts.free().len();
    // on one node, between two of a body, and between bodies, far stiffer than elements
    let slope = DMat3::from_diagonal(DVec3::new(1e4, 1e3, 3e4));
    let ends = [vec![(3, 1.0)], vec![(60, 1.0), (240, -0.3), (243, -0.7)], vec![(90, 1.0), (axes - 3, -1.0)]];
    let springs = ends.map(|parts| (parts, slope));
    for (angle, bend, springs) in [(0.0, 0.0, &[][..]), (1.2, 3.0, &[]), (0.0, 0.0, &springs), (1.2, 3.0, &springs)] {
        turn(&mut simulation, &parts, angle, bend);
        assert_eq!(parts.follow(&simulation, springs), angle > 0.0);
        let (p, q) = (vector(&parts, 0.37), vector(&parts, 0.91));
        let [of_p, of_q] = [&p, &q].map(|vector| parts.apply(&simulation, vector));
        let (one, other) = (dot(&q, &of_p), dot(&p, &of_q));
        let size = (dot(&p, &of_p) * dot(&q, &of_q)).sqrt();
        assert!((one - other).abs() < 1e-12 * size, "{angle}: {one} and {other} of {size}");
        for seed in [0.37, 0.91, 1.7, 0.01] {
            let r = vector(&parts, seed);
            let z = parts.apply(&simulation, &r);
            assert!(dot(&r, &z) > 0.0, "{angle}, {seed}");
            assert!((0..r.len()).all(|axis| parts.free()[axis] || z[axis] == 0.0));
        }
        // gone again, it is as if there had been none
        parts.follow(&simulation, &[]);
        let mut without = TwoLevelParts::of(&mut simulation, 0.01);
        without.follow(&simulation, &[]);
        assert_eq!(parts.apply(&simulation, &p), without.apply(&simulation, &p));
    }
}

/// B of a body that is turned is that of the body, turned: B'(R r) = R B r to rounding, where it is at rest and where
/// each aggregate is turned. Those that bending turns by less than 2° are as they were at rest: 2 sin 1° of it at most.
#[test]
fn two_levels_turn_with_a_body() {
    let mut simulation = start(
        "(duration: 1, solver: Implicit(),
        bodies: {\"b\": (mesh: Box(size: (0.1, 0.03, 0.04), cells: (10, 3, 4), elements: Tet4), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))})",
    );
    let mut parts = TwoLevelParts::of(&mut simulation, 0.01);
    let body = simulation.body("b").unwrap();
    let rest = simulation.world().get::<RestPosition>(body).unwrap().0.clone();
    let about = |axis: DVec3, angle: f64| DQuat::from_axis_angle(axis.normalize(), angle);
    let [none, one, other] =
        [DQuat::IDENTITY, about(DVec3::new(1.0, -2.0, 0.7), 2.1), about(DVec3::new(0.3, 1.0, 2.0), -0.9)];
    let turned = |of: &[f64], by: DQuat| -> Vec<f64> {
        of.chunks(3).flat_map(|of| (by * DVec3::from_slice(of)).to_array()).collect()
    };
    let most = 2.0 * 1_f64.to_radians().sin();
    for (bend, turns, bound) in [(0.0, [none, one], 1e-12), (4.0, [other, one], 1e-12), (4.0, [none, one], most)] {
        let r = vector(&parts, 0.37);
        let [before, after] = turns.map(|by| {
            let place = |x: &DVec3| by * (*x + DVec3::new(0.0, bend * x.x * x.x, -0.5 * bend * x.x * x.z)) - *x;
            let places: Vec<f64> = rest.iter().flat_map(|x| place(x).to_array()).collect();
            parts.displace(&mut simulation, &places);
            assert_eq!(parts.follow(&simulation, &[]), bend > 0.0 || by != none, "{bend}");
            turned(&parts.apply(&simulation, &turned(&r, by)), by.inverse())
        });
        let off: Vec<f64> = before.iter().zip(&after).map(|(a, b)| a - b).collect();
        let off = (dot(&off, &off) / dot(&before, &before)).sqrt();
        println!("bent by {bend}: {off:e} apart, {bound:e} are allowed");
        assert!(off < bound, "bent by {bend}: {off:e}");
    }
}

/// Pᵀ K P of elements' columns against products of the tangent with the motions.
#[test]
fn the_coarse_matrix_is_that_of_the_tangent() {
    let (mut simulation, mut parts) = two_blocks();
    parts.follow(&simulation, &[]);
    let at_rest = vec![0.0; parts.free().len()];
    let pieces = parts.coarse();
    assert_eq!(pieces.len(), 2);
    for (motions, stiffness) in pieces {
        let images = simulation.stiffness_by_differences(&at_rest, &motions).unwrap();
        let size = motions.len();
        let start = |column: usize| column * size - column * column.saturating_sub(1) / 2;
        let diagonal = |column: usize| stiffness[start(column)];
        let mut largest = 0.0_f64;
        for (row, column) in (0..size).flat_map(|column| (column..size).map(move |row| (row, column))) {
            let expected = dot(&images[column], &motions[row]);
            let found = stiffness[start(column) + row - column];
            // differences of forces of one side have the curvature of the law in them
            let scale = (diagonal(row) * diagonal(column)).sqrt();
            assert!((found - expected).abs() < 1e-5 * scale, "{row}, {column}: {found}, not {expected}");
            largest = largest.max(found);
        }
        assert!(size > 6 && largest > 0.0);
    }
}

/// However a residual is: tᵀ D B r = tᵀ r of the translations t that nothing holds.
#[test]
fn what_moves_a_piece_as_a_whole_is_solved_exactly() {
    let (mut simulation, mut parts) = two_blocks();
    turn(&mut simulation, &parts, 0.8, 1.0);
    parts.follow(&simulation, &[]);
    let r = vector(&parts, 0.77);
    let z = parts.apply(&simulation, &r);
    let ranges: Vec<_> = parts.bodies().into_iter().map(|(_, range)| range).collect();
    for (range, axis, is_free) in [(0, 0, true), (0, 2, false), (1, 0, true), (1, 2, true)] {
        let own = || ranges[range].clone().skip(axis).step_by(3);
        let force: f64 = own().map(|i| r[i]).sum();
        let momentum: f64 = own().map(|i| parts.inertia(i / 3) * z[i]).sum();
        let size: f64 = own().map(|i| r[i].abs()).sum();
        assert_eq!((force - momentum).abs() < 1e-12 * size, is_free, "{range}, {axis}: {force}, {momentum}");
    }
}
