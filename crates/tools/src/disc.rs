//! How much of a face lies in a disc.

use glam::DVec2;
use std::f64::consts::PI;

/// The share of a polygon's area that lies in a disc about the origin, from 0 to 1; its corners go round to the left,
/// else it is 0. Exact: from side to side the triangle with the origin, of which a chord is within, and sectors beside
/// it.
pub fn share_in_disc(corners: &[DVec2], radius: f64) -> f64 {
    let sides = || corners.iter().zip(corners.iter().cycle().skip(1)).map(|(&from, &to)| [from, to]);
    let area: f64 = sides().map(|[p, q]| 0.5 * p.perp_dot(q)).sum();
    // false of what is no number
    let turns_left = area > 0.0;
    if !turns_left || corners.iter().all(|corner| corner.length() <= radius) {
        return if turns_left { 1.0 } else { 0.0 };
    }
    let square = radius * radius;
    let sector = |p: DVec2, q: DVec2| 0.5 * square * p.perp_dot(q).atan2(p.dot(q));
    let (mut inside, mut meets) = (0.0, false);
    for [p, q] in sides() {
        // |p + t d|² = r²
        let d = q - p;
        let (a, b, c) = (d.length_squared(), p.dot(d), p.length_squared() - square);
        let root = (b * b - a * c).max(0.0).sqrt();
        let [enters, leaves] = [-b - root, -b + root].map(|t| if a > 0.0 { (t / a).clamp(0.0, 1.0) } else { 0.0 });
        if enters >= leaves {
            inside += sector(p, q);
            continue;
        }
        meets = true;
        let [u, v] = [enters, leaves].map(|t| p + d * t);
        inside += 0.5 * u.perp_dot(v);
        inside += if enters > 0.0 { sector(p, u) } else { 0.0 };
        inside += if leaves < 1.0 { sector(v, q) } else { 0.0 };
    }
    // no side crosses the edge of the disc: all of that is within, or nothing, but for rounding
    if !meets {
        inside = if inside > 0.5 * PI * square { PI * square } else { 0.0 };
    }
    (inside / area).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests;
