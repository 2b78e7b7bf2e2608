//! Volume, centre and moments of what a tool is made of.

use super::shape::Shape;
use super::{Geometry, rigid::Inertia};
use glam::{DMat3, DVec3};

/// Halvings of a box around a tool: its surface is in cells of a 256th of its longest side.
const HALVINGS: u32 = 8;

/// Sums over a volume: itself (m³), and its first (m⁴) and second (m⁵) moments about the origin.
#[derive(Clone, Copy)]
struct Sums {
    volume: f64,
    first: DVec3,
    second: DMat3,
}

impl Sums {
    /// A part of a box about a place with half edges (m).
    fn add(&mut self, center: DVec3, half: DVec3, part: f64) {
        let volume = 8.0 * half.x * half.y * half.z * part;
        let outer = DMat3::from_cols(center * center.x, center * center.y, center * center.z);
        self.volume += volume;
        self.first += center * volume;
        self.second += (outer + DMat3::from_diagonal(half * half / 3.0)) * volume;
    }

    /// Adds what of a geometry is within a cube.
    fn add_inside(&mut self, geometry: &Geometry, center: DVec3, half: f64, halvings: u32) {
        let distance = geometry.distance(center).0;
        let to_corner = half * 3.0_f64.sqrt();
        if distance >= to_corner {
            return;
        }
        let edges = DVec3::splat(half);
        if distance <= -to_corner {
            return self.add(center, edges, 1.0);
        }
        if halvings == 0 {
            // a ramp as wide as the cube: it has the variance, half²/3, of the share of a cube that a plane cuts off,
            // whatever its normal
            return self.add(center, edges, (0.5 - 0.5 * distance / half).clamp(0.0, 1.0));
        }
        for corner in 0..8 {
            let sign = |bit: u32| if corner >> bit & 1 == 0 { -0.5 } else { 0.5 };
            let offset = DVec3::new(sign(0), sign(1), sign(2)) * half;
            self.add_inside(geometry, center + offset, 0.5 * half, halvings - 1);
        }
    }
}

impl Geometry {
    /// Volume (m³), centre (m) and, for a density of one, moments of inertia about it (m⁵): of balls and of boxes that
    /// are not rounded in closed form, of others to some 1e-4. `None` of a plane, which has no end.
    pub fn volume_moments(&self) -> Option<(f64, DVec3, DMat3)> {
        if let Self::Analytic(solid) = self {
            match *solid.shape() {
                Shape::Sphere { radius } => {
                    let volume = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
                    return Some((
                        volume,
                        DVec3::ZERO,
                        DMat3::from_diagonal(DVec3::splat(0.4 * volume * radius * radius)),
                    ));
                }
                Shape::Box { size } if solid.rounding() == 0.0 => {
                    let volume = size.x * size.y * size.z;
                    let square = size * size;
                    let moments = (DVec3::splat(square.element_sum()) - square) * (volume / 12.0);
                    return Some((volume, DVec3::ZERO, DMat3::from_diagonal(moments)));
                }
                _ => {}
            }
        }
        let (center, radius) = self.bounding_sphere()?;
        let mut sums = Sums { volume: 0.0, first: DVec3::ZERO, second: DMat3::ZERO };
        sums.add_inside(self, center, radius, HALVINGS);
        let Sums { volume, first, second } = sums;
        if volume <= 0.0 {
            return None;
        }
        let middle = first / volume;
        let about = |second: DMat3| {
            DMat3::from_diagonal(DVec3::splat(second.x_axis.x + second.y_axis.y + second.z_axis.z)) - second
        };
        let outer = DMat3::from_cols(middle * middle.x, middle * middle.y, middle * middle.z);
        Some((volume, middle, about(second - outer * volume)))
    }

    /// What resists its motion if it is filled evenly: a mass (kg), or a density (kg/m³) where there is none. `None` of
    /// a plane.
    pub fn filled(&self, mass: Option<f64>, density: f64) -> Option<Inertia> {
        let (volume, center, moments) = self.volume_moments()?;
        let mass = mass.unwrap_or(density * volume);
        Some(Inertia::new(mass, center, moments * (mass / volume)))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::tools::Solid;
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
        let surface = crate::tools::Triangles { points, triangles, ..Default::default() };
        let grid = crate::tools::DistanceGrid::new(&surface, 5e-4).unwrap();
        let (volume, center, moments) = Geometry::Grid(std::sync::Arc::new(grid)).volume_moments().unwrap();
        // edges are blunt by a fraction of a cell
        near("volume", volume, 2.4e-5, 2e-3);
        near("moment", moments.x_axis.x, 2.4e-5 * (9e-4 + 16e-4) / 12.0, 4e-3);
        assert!(center.length() < 1e-6, "{center}");
    }
}
