//! Maps from squares and cubes to discs and balls.
//!
//! Every map is ρ·((1 − ρ)·c·q̂ + ρ·s(q̂)) with ρ = max |q|, q̂ = q/ρ: near the middle the square itself (times c), on
//! its rim the round shape s, in between a blend. Smooth maps with a formula of their own (the elliptical one, for
//! instance) flatten the corner cells of a fine grid; here only the angle at the corner point itself is nearly
//! straight.

use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_PI_4;

/// Size of the inner square: a balance between cells at the middle, at the sides and in the corners.
const INNER_SQUARE: f64 = 0.78;
/// Size of the inner cube.
const INNER_CUBE: f64 = 0.68;

/// An index of 0 to `cells` as a number of −1 to 1, exactly symmetric.
pub(super) fn centred(index: f64, cells: u32) -> f64 {
    (2.0 * index - f64::from(cells)) / f64::from(cells)
}

/// From the square [−1, 1]² to the unit disc; rims of equal cells get equal arcs.
pub(super) fn disc(q: DVec2) -> DVec2 {
    let rho = q.abs().max_element();
    if rho == 0.0 {
        return DVec2::ZERO;
    }
    let on_square = q / rho;
    rho * ((1.0 - rho) * INNER_SQUARE * on_square + rho * circle(on_square))
}

/// From the rim of the square to the unit circle.
fn circle(q: DVec2) -> DVec2 {
    if q.x.abs() >= q.y.abs() {
        let (sin, cos) = (FRAC_PI_4 * q.y).sin_cos();
        DVec2::new(cos * q.x.signum(), sin)
    } else {
        let (sin, cos) = (FRAC_PI_4 * q.x).sin_cos();
        DVec2::new(sin, cos * q.y.signum())
    }
}

/// From the cube [−1, 1]³ to the unit ball; edges of equal cells get equal angles.
pub(super) fn ball(q: DVec3) -> DVec3 {
    let sphere = |q: DVec3| DVec3::new((FRAC_PI_4 * q.x).tan(), (FRAC_PI_4 * q.y).tan(), (FRAC_PI_4 * q.z).tan());
    blend(q, DVec3::splat(INNER_CUBE), |q| sphere(q).normalize())
}

/// From the cube [−1, 1]³ to the solid inside `surface`, which maps the cube's surface; `inner` is the cuboid in the
/// middle (half edges).
pub(super) fn blend(q: DVec3, inner: DVec3, surface: impl Fn(DVec3) -> DVec3) -> DVec3 {
    let rho = q.abs().max_element();
    if rho == 0.0 {
        return DVec3::ZERO;
    }
    let on_cube = q / rho;
    rho * ((1.0 - rho) * inner * on_cube + rho * surface(on_cube))
}
