#![allow(clippy::unwrap_used)]
use super::super::axes::Axes;
use super::super::formula::Formula;
use super::super::springs::Springs;
use super::*;
use crate::components::*;
use crate::math::lane_place;
use crate::scene::schema::ImplicitScheme;
use crate::{Options, SceneFile, Simulation};
use bevy_ecs::prelude::*;
use glam::{DMat3, DVec3};

const SHEAR: f64 = 3e3 / 2.9;
const BULK: f64 = 3e3 / 0.3;

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
fn closed_form(world: &World, body: Entity, u: &Reals, p: &Reals) -> Reals {
    let rest = &world.get::<RestPosition>(body).unwrap().0;
    let mut image = Reals::zeros(Precision::F64, p.len());
    for &entity in &world.get::<Authoring>(body).unwrap().blocks {
        let (block, connectivity) = (world.get::<Block>(entity).unwrap(), world.get::<Connectivity>(entity).unwrap());
        for row in 0..block.count {
            let nodes = [0, 1, 2, 3].map(|corner| connectivity[lane_place(row, 4, corner)] as usize);
            let of = |field: &Reals| nodes.map(|node| field.vector(node));
            let rest = nodes.map(|node| rest[node]);
            let (deformed, shapes, volume) = at(rest, of(u));
            let (along, ..) = at(rest, of(p));
            let change = neo_hookean_change(DMat3::IDENTITY + deformed, along);
            for (node, shape) in nodes.into_iter().zip(shapes) {
                let force = change * shape * volume;
                image.set_vector(node, image.vector(node) + force);
            }
        }
    }
    image
}

fn dot(a: &Reals, b: &Reals) -> f64 {
    (0..a.len()).map(|axis| a.get(axis) * b.get(axis)).sum()
}

/// Of a body that is bent, stretched and squeezed; q·Kp = p·Kq.
#[test]
fn products_are_those_of_the_closed_form_and_symmetric() {
    let scene = "(duration: 1, solver: Implicit(),
        bodies: {\"b\": (mesh: Box(size: (0.1, 0.04, 0.03), cells: (5, 3, 2), elements: Tet4), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))})";
    let scene = SceneFile::from_text("test", scene, std::path::Path::new("."), &[]).unwrap();
    let options = Options { precision: Precision::F64, threads: 1, ..Options::default() };
    let mut simulation = Simulation::new(&scene, &options).unwrap();
    let axes = Axes::of(&mut simulation.world);
    let (mut motion, formula) = (axes.motion(), Formula::of(ImplicitScheme::Euler));
    axes.read(&simulation.world, &mut motion);
    let body = axes.bodies[0];
    let bent = |x: &DVec3| DVec3::new(0.2 * x.x - 3.0 * x.x * x.z, 4.0 * x.x * x.x, -0.3 * x.z + 2.0 * x.x * x.y);
    let rest = simulation.world.get::<RestPosition>(body).unwrap().0.clone();
    let w = Reals::F64(rest.iter().flat_map(|x| bent(x).to_array()).collect());
    let place = Place { formula: &formula, h: 0.01, motion: &motion, correction: &w, beyond: None };
    let (mut net, mut springs) = (axes.zeros(), Springs::default());
    let vector = |seed: f64| Reals::F64((0..w.len()).map(|axis| (seed * (axis as f64 + 1.0)).sin()).collect());
    let (p, q) = (vector(0.37), vector(1.91));
    let mut trial = Trial {
        world: &mut simulation.world,
        passes: &mut simulation.entries,
        axes: &axes,
        springs: &mut springs,
        step: 0,
        count: 0,
        elsewhere: false,
    };
    assert!(trial.forces(&place, &mut net).unwrap());
    let [of_p, of_q] = [&p, &q].map(|p| {
        let mut image = axes.zeros();
        difference(&mut trial, &place, &net, p, &mut image).unwrap();
        image
    });
    let (one, other) = (dot(&q, &of_p), dot(&p, &of_q));
    let size = (dot(&p, &of_p) * dot(&q, &of_q)).sqrt();
    assert!((one - other).abs() < 1e-6 * size, "{one} and {other} of {size}");
    for (p, image) in [(&p, &of_p), (&q, &of_q)] {
        let expected = closed_form(&simulation.world, body, &w, p);
        let mut off = image.clone();
        combine(&mut off, &expected, |a, b| a - b);
        assert!(dot(&off, &off) < 1e-12 * dot(&expected, &expected), "{:e}", dot(&off, &off).sqrt());
    }
}
