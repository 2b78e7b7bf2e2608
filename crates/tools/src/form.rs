//! Signed distances to shapes of tools. `shaders/tool_shape.wgsl` is the twin.

use super::shape::Shape;
use glam::{DVec2, DVec3};

/// A shape in the numbers from which its signed distance is found: those of the shape that is smaller by the rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Form {
    kind: u32,
    sizes: [f64; 6],
    rounding: f64,
}

const PLANE: u32 = 0;
const SPHERE: u32 = 1;
const BOX: u32 = 2;
const CAPSULE: u32 = 3;
const CYLINDER: u32 = 4;
const CONE: u32 = 5;
const TUBE: u32 = 6;

/// From this far away (m) all places are as one on the way there: no square overflows, in f32 neither.
pub(super) const FAR: f64 = 1e15;

/// What is no longer than this (m) has no direction, for the same reason.
pub(super) const NEAR: f64 = 1e-18;

impl Form {
    /// Of a shape in whose numbers nothing is wrong. What is round already is not rounded.
    pub(super) fn new(shape: &Shape, rounding: f64) -> Self {
        let r = rounding;
        let (kind, sizes, rounding) = match *shape {
            Shape::Plane {} => (PLANE, [0.0; 6], 0.0),
            Shape::Sphere { radius } => (SPHERE, [radius, 0.0, 0.0, 0.0, 0.0, 0.0], 0.0),
            Shape::Box { size } => {
                let [x, y, z] = (size / 2.0 - r).to_array();
                (BOX, [x, y, z, 0.0, 0.0, 0.0], r)
            }
            Shape::Capsule { length, radius } => {
                (CAPSULE, [radius, radius, (length - radius).max(radius), 0.0, 0.0, 0.0], 0.0)
            }
            Shape::Cylinder { length, radius } => (CYLINDER, [radius - r, r, length - r, 0.0, 0.0, 0.0], r),
            Shape::Cone { length, tip, base } => (CONE, cone(length, tip, base, r), r),
            Shape::Tube { length, inner, outer, bevel } => {
                let (sin, cos) = bevel.to_radians().sin_cos();
                (TUBE, [inner + r, outer - r, r, length - r, sin, cos], r)
            }
        };
        Self { kind, sizes, rounding }
    }

    /// As the WGSL struct `ToolShape` has them: the kind as the bits of a `u32`, six sizes, the rounding (m). All sizes
    /// are those of the shape less its rounding all round (m):
    ///
    /// | kind | sizes |
    /// |---|---|
    /// | 0 plane | |
    /// | 1 sphere | radius |
    /// | 2 box | half edges along x, y, z |
    /// | 3 capsule | radius, z of the two ends of its axis |
    /// | 4 cylinder | radius, z of its two ends |
    /// | 5 cone | radii at its two ends, z of these, the mantle's normal: its parts across and along z |
    /// | 6 tube | inner and outer radius, z of its two ends, sine and cosine of the bevel |
    pub fn packed(&self) -> [f32; 8] {
        let [a, b, c, d, e, f] = self.sizes.map(|size| size as f32);
        [f32::from_bits(self.kind), a, b, c, d, e, f, self.rounding as f32]
    }

    /// The sizes of that table (m).
    pub(super) fn sizes(&self) -> [f64; 6] {
        self.sizes
    }

    /// φ (m) and its unit gradient: see [`Solid::distance`](super::Solid::distance).
    pub fn distance(&self, y: DVec3) -> (f64, DVec3) {
        let y = y.clamp(DVec3::splat(-FAR), DVec3::splat(FAR));
        let [a, b, c, d, e, f] = self.sizes;
        let (distance, gradient) = match self.kind {
            PLANE => (y.z, DVec3::Z),
            SPHERE => to_sphere(y, a),
            BOX => to_box(y, DVec3::new(a, b, c)),
            CAPSULE => to_sphere(DVec3::new(y.x, y.y, y.z - y.z.clamp(b, c)), a),
            CYLINDER => {
                let rho = y.truncate().length();
                turned(y, rho, to_rectangle([rho - a, 1.0], ends(y.z, b, c)))
            }
            CONE => {
                let rho = y.truncate().length();
                turned(y, rho, to_trapezium(DVec2::new(rho, y.z), [a, b], [c, d], DVec2::new(e, f)))
            }
            _ => {
                let rho = y.truncate().length();
                // the outside first
                let wall = if rho - b >= a - rho { [rho - b, 1.0] } else { [a - rho, -1.0] };
                let tube = turned(y, rho, to_rectangle(wall, ends(y.z, c, d)));
                // through the foremost point of the tube as it is before it is rounded
                let off = self.rounding - e * (y.x - (b + self.rounding)) - f * y.z;
                if e > 0.0 && off > tube.0 { (off, DVec3::new(-e, 0.0, -f)) } else { tube }
            }
        };
        (distance - self.rounding, gradient)
    }
}

/// Of a cone smaller by r all round: radii at its two ends, their z, the mantle's normal. Where the mantle meets itself
/// before the end, the cone ends in a point.
fn cone(length: f64, tip: f64, base: f64, r: f64) -> [f64; 6] {
    let mantle = length.hypot(base - tip);
    let (across, along) = (length / mantle, (tip - base) / mantle);
    let radius = |z: f64| tip - (r + along * z) / across;
    let (mut low, mut high) = (r, length - r);
    let point = (tip * across - r) / along;
    if radius(low) < 0.0 {
        low = point;
    }
    if radius(high) < 0.0 {
        high = point;
    }
    [radius(low).max(0.0), radius(high).max(0.0), low, high, across, along]
}

/// How far beyond the nearer of two ends, and the direction there; the first end first.
fn ends(z: f64, low: f64, high: f64) -> [f64; 2] {
    if low - z >= z - high { [low - z, -1.0] } else { [z - high, 1.0] }
}

/// A distance with a gradient across and along the axis, turned to where the place is. On the axis, across is x.
fn turned(y: DVec3, rho: f64, (distance, gradient): (f64, DVec2)) -> (f64, DVec3) {
    let across = if rho > NEAR { y.truncate() / rho } else { DVec2::X };
    (distance, (across * gradient.x).extend(gradient.y))
}

/// At the centre the direction is x.
fn to_sphere(y: DVec3, radius: f64) -> (f64, DVec3) {
    let length = y.length();
    (length - radius, if length > NEAR { y / length } else { DVec3::X })
}

/// Outside the nearest point counts, inside the nearest face: x before y before z, positive before negative.
fn to_box(y: DVec3, half: DVec3) -> (f64, DVec3) {
    let sign = DVec3::select(y.cmplt(DVec3::ZERO), DVec3::NEG_ONE, DVec3::ONE);
    let q = y.abs() - half;
    let beyond = q.max(DVec3::ZERO);
    let length = beyond.length();
    if length > NEAR {
        (length, sign * (beyond / length))
    } else if q.x >= q.y && q.x >= q.z {
        (q.x, DVec3::new(sign.x, 0.0, 0.0))
    } else if q.y >= q.z {
        (q.y, DVec3::new(0.0, sign.y, 0.0))
    } else {
        (q.z, DVec3::new(0.0, 0.0, sign.z))
    }
}

/// The same in two dimensions: beyond the nearer of two sides by how much, and the direction there; the first side
/// first.
fn to_rectangle([x, x_sign]: [f64; 2], [z, z_sign]: [f64; 2]) -> (f64, DVec2) {
    let beyond = DVec2::new(x, z).max(DVec2::ZERO);
    let length = beyond.length();
    if length > NEAR {
        (length, DVec2::new(x_sign, z_sign) * (beyond / length))
    } else if x >= z {
        (x, DVec2::new(x_sign, 0.0))
    } else {
        (z, DVec2::new(0.0, z_sign))
    }
}

/// The half section of a cone: mantle before the low end before the high one.
fn to_trapezium(p: DVec2, radii: [f64; 2], [low, high]: [f64; 2], normal: DVec2) -> (f64, DVec2) {
    let from_low = p - DVec2::new(radii[0], low);
    let from_high = p - DVec2::new(radii[1], high);
    // along the mantle from the low end on
    let along = DVec2::new(-normal.y, normal.x);
    // the same from either end, but for rounding
    let off = normal.dot(if from_low.length_squared() <= from_high.length_squared() { from_low } else { from_high });
    let inside = off.max((low - p.y).max(p.y - high));
    let (past_low, past_high) = (along.dot(from_low) >= 0.0, along.dot(from_high) <= 0.0);
    if inside <= 0.0 {
        if off >= inside {
            (off, normal)
        } else if low - p.y >= inside {
            (low - p.y, DVec2::NEG_Y)
        } else {
            (p.y - high, DVec2::Y)
        }
    } else if off > 0.0 && past_low && past_high {
        (off, normal)
    } else if p.y < low && from_low.x <= 0.0 {
        (low - p.y, DVec2::NEG_Y)
    } else if p.y > high && from_high.x <= 0.0 {
        (p.y - high, DVec2::Y)
    } else {
        let corner = if past_low { from_high } else { from_low };
        let length = corner.length();
        (length, if length > NEAR { corner / length } else { normal })
    }
}
