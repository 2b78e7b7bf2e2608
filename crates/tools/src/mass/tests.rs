#![allow(clippy::unwrap_used)]

use super::*;
use crate::Solid;
use std::f64::consts::PI;

fn of(shape: Shape, rounding: f64) -> (f64, DVec3, DMat3) {
    Geometry::Analytic(Solid::new(shape, rounding).unwrap()).volume_moments().unwrap()
}

fn near(what: &str, found: f64, expected: f64, bound: f64) {
    assert!((found / expected - 1.0).abs() < bound, "{what}: {found}, expected {expected}");
}

/// The square of a cell over a radius: cells are a 256th of 5 cm, radii 1 cm.
const OFF: f64 = 4e-4;

/// Closed forms: a ball of radius r and a cylinder of length l between the halves of a capsule; a cone whose centre
/// is a quarter of its height above its base.
#[test]
fn volumes_and_moments_are_those_of_closed_forms() {
    let (r, l) = (0.01_f64, 0.03);
    let (volume, center, moments) = of(Shape::Capsule { length: l + 2.0 * r, radius: r }, 0.0);
    let (ball, rod) = (4.0 / 3.0 * PI * r.powi(3), PI * r * r * l);
    near("volume of a capsule", volume, ball + rod, OFF);
    near("its centre", center.z, 0.5 * l + r, 1e-6);
    near("along its axis", moments.z_axis.z, 0.4 * ball * r * r + 0.5 * rod * r * r, OFF);
    let across = rod * (l * l / 12.0 + r * r / 4.0) + ball * (0.4 * r * r + l * l / 4.0 + 0.375 * l * r);
    near("across", moments.x_axis.x, across, OFF);
    let (volume, center, moments) = of(Shape::Cone { length: l, tip: 0.0, base: r }, 0.0);
    near("volume of a cone", volume, PI * r * r * l / 3.0, OFF);
    near("its centre", center.z, 0.75 * l, 1e-4);
    near("along its axis", moments.z_axis.z, 0.3 * volume * r * r, 2.0 * OFF);
    let (volume, _, moments) = of(Shape::Box { size: DVec3::new(1.0, 2.0, 3.0) }, 0.0);
    assert_eq!((volume, moments.x_axis.x, moments.z_axis.z), (6.0, 6.5, 2.5));
    let (rounded, ..) = of(Shape::Box { size: DVec3::new(1.0, 2.0, 3.0) }, 0.1);
    // what rounding takes from twelve edges and eight corners
    let taken = (4.0 - PI) * 0.01 * (0.8 + 1.8 + 2.8) + (8.0 - 4.0 / 3.0 * PI) * 1e-3;
    near("volume of a rounded box", rounded, 6.0 - taken, OFF);
    assert!(Geometry::Analytic(Solid::new(Shape::Plane {}, 0.0).unwrap()).volume_moments().is_none());
}

#[test]
fn a_grid_weighs_what_its_triangles_enclose() {
    let solid = Solid::new(Shape::Box { size: DVec3::new(0.02, 0.03, 0.04) }, 0.0).unwrap();
    let (points, triangles) = solid.surface(16, 1.0);
    let surface = sinew_mesh::Triangles { points, triangles, ..Default::default() };
    let grid = crate::DistanceGrid::new(&surface, 5e-4).unwrap();
    let (volume, center, moments) = Geometry::Grid(std::sync::Arc::new(grid)).volume_moments().unwrap();
    // edges are blunt by a fraction of a cell
    near("volume", volume, 2.4e-5, 2e-3);
    near("moment", moments.x_axis.x, 2.4e-5 * (9e-4 + 16e-4) / 12.0, 4e-3);
    assert!(center.length() < 1e-6, "{center}");
}
