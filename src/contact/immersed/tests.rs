#![allow(clippy::unwrap_used)]

use super::*;
use crate::mesh::{ElementKind, Mesh, generators};
use crate::tools::{Shape, Solid};
use glam::{DMat3, DVec3};

fn block() -> Mesh {
    generators::box_mesh(DVec3::splat(1.0), (4, 4, 4), ElementKind::Hex8).unwrap()
}

fn of(shape: Shape) -> Geometry {
    Geometry::Analytic(Solid::new(shape, 0.0).unwrap())
}

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose { rotation: DMat3::IDENTITY, at: DVec3::new(x, y, z) }
}

#[test]
fn a_bead_between_nodes_is_found_and_one_that_is_not_deep_is_not() {
    let bead = of(Shape::Sphere { radius: 0.05 });
    let (place, element) = immersed(&bead, &at(0.37, 0.37, 0.37), &block(), 0.125).unwrap();
    assert!(place.distance(DVec3::splat(0.37)) < 0.0501, "{place}");
    assert!(block().element(element).iter().all(|&node| block().points[node as usize].distance(place) < 0.5));
    // its lowest place is .12 below the surface
    assert!(immersed(&bead, &at(0.37, 0.37, 0.93), &block(), 0.125).is_none());
    assert!(immersed(&bead, &at(0.37, 0.37, 0.9), &block(), 0.125).is_some());
    assert!(immersed(&bead, &at(0.37, 0.37, 1.5), &block(), 0.125).is_none());
    assert!(immersed(&bead, &at(f64::NAN, 0.0, 0.0), &block(), 0.125).is_none());
}

#[test]
fn a_thin_rod_through_a_block_is_found_and_a_block_on_a_table_is_not() {
    let rod = of(Shape::Cylinder { radius: 1e-3, length: 3.0 });
    assert!(immersed(&rod, &at(0.37, 0.37, -1.0), &block(), 0.125).is_some());
    assert!(immersed(&rod, &at(1.1, 0.37, -1.0), &block(), 0.125).is_none());
    let table = of(Shape::Box { size: DVec3::new(4.0, 4.0, 1.0) });
    assert!(immersed(&table, &at(0.5, 0.5, -0.6), &block(), 0.125).is_none());
    assert!(immersed(&table, &at(0.5, 0.5, -0.3), &block(), 0.125).is_some());
    // all of the block is in the box: its nodes are, and they are what tells
    assert!(immersed(&of(Shape::Box { size: DVec3::splat(4.0) }), &at(0.5, 0.5, 0.5), &block(), 0.125).is_none());
}
