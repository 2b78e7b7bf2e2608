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
mod tests;
