//! What is left of a tube, its ends rounded, above a plane.

use super::gauss::Rule;
use super::{Moments, Sums};
use crate::Solid;
use glam::{DMat3, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Halvings of an angle until a root is known.
const HALVINGS: usize = 60;

/// The tube (m), and how steep the plane is: it is `slope` (outer − x) high.
struct Tube {
    outer: f64,
    rounding: f64,
    length: f64,
    slope: f64,
    rule: Rule,
}

/// Of a bevelled tube: integrals over columns along z in closed form, over these by Gauss' rule, in pieces in which
/// what bounds them is smooth.
pub(super) fn moments(solid: &Solid) -> Moments {
    let r = solid.rounding();
    let [inner, outer, _, end, sin, cos] = solid.form().sizes();
    let tube = Tube { outer: outer + r, rounding: r, length: end + r, slope: sin / cos, rule: Rule::new() };
    let mut sums = Sums::none();
    for (rho, weight) in tube.rule.between(inner, outer) {
        tube.add_ring(rho, 0.0, weight, &mut sums);
    }
    if r > 0.0 {
        tube.add_rim(outer, r, &mut sums);
        tube.add_rim(inner, -r, &mut sums);
    }
    sums.about(DVec3::new(0.0, 0.0, tube.length / 2.0))
}

impl Tube {
    /// Where a rim is rounded, from a radius on (m), outwards or inwards: by the angle of its arcs. Between those
    /// angles at which the plane leaves the rounded edge and at which it is below all of it, how far around it is
    /// below has the slope of a root: in sines of another angle it is smooth.
    fn add_rim(&self, from: f64, radius: f64, sums: &mut Sums) {
        let at = |angle: f64| (from + radius * angle.sin(), self.rounding * (1.0 - angle.cos()));
        let above = |side: f64| {
            move |angle: f64| {
                let (rho, rise) = at(angle);
                rise / self.slope - (self.outer + side * rho)
            }
        };
        let ends = [0.0, root(above(-1.0)), root(above(1.0)), FRAC_PI_2];
        for pair in ends.windows(2) {
            let width = pair[1] - pair[0];
            for (u, weight) in self.rule.between(0.0, FRAC_PI_2) {
                let angle = pair[0] + width * u.sin().powi(2);
                let (rho, rise) = at(angle);
                let weight = weight * width * (2.0 * u).sin() * self.rounding * angle.cos();
                self.add_ring(rho, rise, weight, sums);
            }
        }
    }

    /// A ring of a radius and a width (m) whose ends are so much (m) within those of the tube.
    fn add_ring(&self, rho: f64, rise: f64, width: f64, sums: &mut Sums) {
        // up to this angle from x on the plane is below the tube
        let below = ((self.outer - rise / self.slope) / rho).clamp(-1.0, 1.0).acos();
        for (from, to, is_below) in [(0.0, below, true), (below, PI, false)] {
            for (angle, weight) in self.rule.between(from, to) {
                let (sin, cos) = angle.sin_cos();
                let plane = self.slope * (self.outer - rho * cos);
                let low = if is_below { rise } else { plane };
                let ends = [low, self.length - rise].map(|z| z - self.length / 2.0);
                // those at y and at -y
                add_columns([rho * cos, rho * sin], ends, 2.0 * rho * width * weight, sums);
            }
        }
    }
}

/// Two columns at x and ±y from one z to another (m), of so large a section together (m²).
fn add_columns([x, y]: [f64; 2], [low, high]: [f64; 2], section: f64, sums: &mut Sums) {
    let length = high - low;
    let volume = section * length;
    let z = (low + high) / 2.0;
    sums.volume += volume;
    sums.first += DVec3::new(x, 0.0, z) * volume;
    let square = DVec3::new(x * x, y * y, z * z + length * length / 12.0);
    let mut second = DMat3::from_diagonal(square);
    second.x_axis.z = x * z;
    second.z_axis.x = x * z;
    sums.second += second * volume;
}

/// Where a function that is negative at 0 is 0, up to a right angle; this where it is nowhere.
fn root(of: impl Fn(f64) -> f64) -> f64 {
    let (mut less, mut more) = (0.0, FRAC_PI_2);
    if of(more) <= 0.0 {
        return more;
    }
    for _ in 0..HALVINGS {
        let middle = (less + more) / 2.0;
        *(if of(middle) > 0.0 { &mut more } else { &mut less }) = middle;
    }
    more
}
