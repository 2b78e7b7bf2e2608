//! Volume, centre and moments of what a tool is made of.

mod bevelled;
mod gauss;

use super::shape::Shape;
use super::surface::Arc;
use super::{Geometry, Solid, rigid::Inertia};
use glam::{DMat3, DVec2, DVec3};
use sinew_mesh::Triangles;
use std::f64::consts::PI;

/// Volume (m³), centre (m) and, for a density of one, moments of inertia about it (m⁵).
pub(super) type Moments = (f64, DVec3, DMat3);

/// Sums over a volume: itself (m³), and its first (m⁴) and second (m⁵) moments about a place.
#[derive(Clone, Copy)]
struct Sums {
    volume: f64,
    first: DVec3,
    second: DMat3,
}

impl Sums {
    fn none() -> Self {
        Self { volume: 0.0, first: DVec3::ZERO, second: DMat3::ZERO }
    }

    /// What they say of the volume where they are sums about a place (m).
    fn about(self, place: DVec3) -> Moments {
        let from_place = self.first / self.volume;
        let second = self.second - outer(from_place) * self.volume;
        // the trace less each would lose digits of what is slender
        let [x, y, z] = [second.x_axis.x, second.y_axis.y, second.z_axis.z];
        let mut moments = -second;
        (moments.x_axis.x, moments.y_axis.y, moments.z_axis.z) = (y + z, x + z, x + y);
        (self.volume, place + from_place, moments)
    }
}

fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// Of what a closed surface encloses, by the divergence theorem: tetrahedra between its triangles and a place, those
/// behind it with their sign (Mirtich 1996). The place is in the middle, so that far from the origin digits are kept.
pub(super) fn enclosed(surface: &Triangles) -> Moments {
    let [low, high] = surface.bounds();
    let place = (low + high) / 2.0;
    let mut sums = Sums::none();
    for triangle in 0..surface.triangles.len() {
        let [a, b, c] = surface.corners(triangle).map(|corner| corner - place);
        let (volume, all) = (a.dot(b.cross(c)) / 6.0, a + b + c);
        sums.volume += volume;
        sums.first += all * (volume / 4.0);
        sums.second += (outer(a) + outer(b) + outer(c) + outer(all)) * (volume / 20.0);
    }
    sums.about(place)
}

/// A box with half edges (m) and all within a radius (m) of it: itself, and what lies beyond it along one, two or three
/// axes, parts of slabs, cylinders and a ball.
fn rounded_box(half: DVec3, radius: f64) -> Moments {
    // of the line, the disc and the ball of radius one, by how many axes they have: volume, means of |u| and u²
    let round = [[1.0, 0.0, 0.0], [2.0, 0.5, 1.0 / 3.0], [PI, 4.0 / (3.0 * PI), 0.25], [4.0 / 3.0 * PI, 0.375, 0.2]];
    let mut sums = Sums::none();
    for axes in 0..8_u32 {
        let is_beyond = [0, 1, 2].map(|axis| axes >> axis & 1 == 1);
        let [size, mean, square] = round[axes.count_ones() as usize];
        let along = |axis: usize| if is_beyond[axis] { radius } else { 2.0 * half[axis] };
        let volume = size * along(0) * along(1) * along(2);
        let square = DVec3::from_array([0, 1, 2].map(|axis| {
            let half = half[axis];
            if is_beyond[axis] {
                half * half + radius * (2.0 * half * mean + radius * square)
            } else {
                half * half / 3.0
            }
        }));
        sums.volume += volume;
        sums.second += DMat3::from_diagonal(square * volume);
    }
    sums.about(DVec3::ZERO)
}

/// What a half section goes round when it is turned about the axis: by Green's theorem integrals along its bounds, the
/// arcs of a radius and what is straight between them. `middle` (m) is a radius and a height within it: what is thin
/// and far from the axis keeps its digits. Its radius is 0 where the section reaches to the axis.
fn revolved(arcs: &[Arc], radius: f64, middle: DVec2) -> Moments {
    let rule = gauss::Rule::new();
    let (mut volume, mut first) = (0.0, 0.0);
    let [mut along, mut across] = [0.0; 2];
    // from the middle, and the way along the axis
    let mut add = |from: DVec2, way: f64| {
        let square = from.x * (from.x + 2.0 * middle.x) * PI * way;
        volume += square;
        first += square * from.y;
        along += square * from.y * from.y;
        across += square * ((middle.x + from.x).powi(2) + middle.x * middle.x) / 2.0;
    };
    let mut last = arcs.last().filter(|_| middle.x > 0.0).map(|arc| arc.ends(radius)[1] - middle);
    for arc in arcs {
        let center = arc.0 - middle;
        let [from, to] = arc.ends(radius).map(|end| end - middle);
        if let Some(last) = last {
            rule.between(0.0, 1.0).for_each(|(t, weight)| add(last.lerp(from, t), weight * (from.y - last.y)));
        }
        for (angle, weight) in rule.between(arc.1.to_radians(), arc.2.to_radians()) {
            let (sin, cos) = angle.sin_cos();
            add(center + radius * DVec2::new(cos, sin), weight * radius * cos);
        }
        last = Some(to);
    }
    let second = DMat3::from_diagonal(DVec3::new(across / 2.0, across / 2.0, along));
    Sums { volume, first: DVec3::new(0.0, 0.0, first), second }.about(DVec3::new(0.0, 0.0, middle.y))
}

fn of_solid(solid: &Solid) -> Option<Moments> {
    let height = |length: f64| DVec2::new(0.0, length / 2.0);
    let middle = match *solid.shape() {
        Shape::Plane {} => return None,
        Shape::Sphere { radius } => {
            let volume = 4.0 / 3.0 * PI * radius.powi(3);
            return Some((volume, DVec3::ZERO, DMat3::from_diagonal(DVec3::splat(0.4 * volume * radius * radius))));
        }
        Shape::Box { size } => return Some(rounded_box(size / 2.0 - solid.rounding(), solid.rounding())),
        Shape::Tube { bevel, .. } if bevel > 0.0 => return Some(bevelled::moments(solid)),
        Shape::Tube { length, inner, outer, .. } => height(length).with_x((inner + outer) / 2.0),
        Shape::Capsule { length, .. } | Shape::Cylinder { length, .. } | Shape::Cone { length, .. } => height(length),
    };
    solid.section().map(|(arcs, radius)| revolved(&arcs, radius, middle))
}

impl Geometry {
    /// Volume (m³), centre (m) and, for a density of one, moments of inertia about it (m⁵): of shapes, rounded ones
    /// too, to 1e-12 and better, of surfaces of triangles those of what they enclose, whatever the grid is, to
    /// rounding. `None` of a plane, which has no end.
    pub fn volume_moments(&self) -> Option<(f64, DVec3, DMat3)> {
        match self {
            Self::Analytic(solid) => of_solid(solid),
            Self::Grid(grid) => Some(grid.volume_moments()),
        }
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
