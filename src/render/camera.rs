//! Where the eye stands.

use glam::{Mat3, Vec2, Vec3};

/// An eye with perspective. z is up.
#[derive(Clone, Debug)]
pub struct Camera {
    /// Where the eye is (m).
    eye: Vec3,
    /// Rows: to the right, up, towards the eye.
    axes: Mat3,
    /// Pixels of one unit at distance one.
    focal: f32,
    /// Where what lies straight ahead appears (pixels).
    middle: Vec2,
}

/// Finds the place from which a camera sees all points of a series and fills its part of the picture with them.
#[derive(Clone, Debug)]
pub struct Fit {
    /// A camera in the origin.
    camera: Camera,
    /// Slopes of the planes that bound the view, to the sides and up and down.
    slope: Vec2,
    /// How far the points reach towards the planes to the right, above, to the left and below.
    reach: [Vec2; 2],
    /// The nearest and the farthest point, along the line of sight (m).
    depth: (f32, f32),
}

/// Tangent of half the angle that the height of the view spans: a long lens, little distortion.
const HALF_ANGLE: f32 = 0.22;

impl Fit {
    /// Looks from a direction (of any length but zero) into the part of the picture from `left_top` to `right_bottom`
    /// (pixels).
    pub fn new(from: Vec3, left_top: Vec2, right_bottom: Vec2) -> Fit {
        let back = from.normalize_or(Vec3::NEG_Y);
        let up = if back.z.abs() > 0.999 { Vec3::Y } else { Vec3::Z };
        let right = up.cross(back).normalize();
        let axes = Mat3::from_cols(right, back.cross(right), back).transpose();
        let extent = (right_bottom - left_top).max(Vec2::ONE);
        let focal = extent.y / (2.0 * HALF_ANGLE);
        let camera = Camera { eye: Vec3::ZERO, axes, focal, middle: (left_top + right_bottom) / 2.0 };
        Fit { camera, slope: 2.0 * focal / extent, reach: [Vec2::MIN; 2], depth: (f32::MIN, f32::MAX) }
    }

    /// Adds a point that is to be seen (m); one that is not finite is left out.
    pub fn see(&mut self, point: Vec3) {
        let point = self.camera.turn(point);
        if point.is_finite() {
            let aside = point.truncate() * self.slope;
            self.reach = [self.reach[0].max(aside + point.z), self.reach[1].max(point.z - aside)];
            self.depth = (self.depth.0.max(point.z), self.depth.1.min(point.z));
        }
    }

    /// The camera, or nothing when there is no point. The planes through the eye that bound the view touch the points; of
    /// the narrower direction both, and in the other one the points are in the middle.
    pub fn camera(&self) -> Option<Camera> {
        let (near, far) = self.depth;
        if near < far {
            return None;
        }
        let [ahead, behind] = self.reach;
        let target = (ahead - behind) / (2.0 * self.slope);
        // a thin line along the line of sight must not pass through the eye
        let least = near + (0.5 * (near - far)).max(1e-6);
        let distance = ((ahead + behind) / 2.0).max_element().max(least);
        Some(Camera { eye: self.camera.axes.transpose() * target.extend(distance), ..self.camera })
    }
}

impl Camera {
    /// Where a point appears (pixels), and the inverse of its distance along the line of sight (1/m), negative behind the
    /// eye.
    pub fn project(&self, point: Vec3) -> Vec3 {
        let seen = self.axes * (point - self.eye);
        let inverse = -1.0 / seen.z;
        let place = self.middle + Vec2::new(seen.x, -seen.y) * inverse * self.focal;
        place.extend(inverse)
    }

    /// Pixels of one unit at distance one.
    pub fn focal(&self) -> f32 {
        self.focal
    }

    /// A direction as the eye sees it: to the right, up, towards the eye.
    pub fn turn(&self, direction: Vec3) -> Vec3 {
        self.axes * direction
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    fn corners(low: Vec3, high: Vec3) -> impl Iterator<Item = Vec3> {
        let corner = |bits: u32| glam::BVec3::new(bits & 1 != 0, bits & 2 != 0, bits & 4 != 0);
        (0..8).map(move |bits| Vec3::select(corner(bits), high, low))
    }

    #[test]
    fn all_points_are_seen_from_everywhere_and_fill_their_part() {
        let (left_top, right_bottom) = (Vec2::new(20.0, 10.0), Vec2::new(940.0, 600.0));
        for from in [Vec3::X, Vec3::Z, Vec3::NEG_Z, Vec3::new(1.0, -2.0, 0.8), Vec3::new(-3.0, 0.1, -1.0)] {
            let mut fit = Fit::new(from, left_top, right_bottom);
            corners(Vec3::new(-1.0, 2.0, 0.0), Vec3::new(3.0, 2.5, 1.0)).for_each(|point| fit.see(point));
            fit.see(Vec3::NAN);
            let camera = fit.camera().unwrap();
            let seen = corners(Vec3::new(-1.0, 2.0, 0.0), Vec3::new(3.0, 2.5, 1.0)).map(|point| camera.project(point));
            let (low, high) = seen.fold((Vec3::MAX, Vec3::MIN), |(low, high), point| (low.min(point), high.max(point)));
            assert!(low.z > 0.0, "{from}: a corner lies behind the eye");
            assert!(low.truncate().cmpge(left_top - 0.1).all() && high.truncate().cmple(right_bottom + 0.1).all());
            let filled = ((high - low).truncate() / (right_bottom - left_top)).max_element();
            assert!(filled > 0.99, "{from}: {filled}");
        }
    }

    #[test]
    fn up_is_up_and_near_is_near() {
        let mut fit = Fit::new(Vec3::NEG_Y, Vec2::ZERO, Vec2::splat(100.0));
        corners(Vec3::splat(-1.0), Vec3::splat(1.0)).for_each(|point| fit.see(point));
        let camera = fit.camera().unwrap();
        let middle = camera.project(Vec3::ZERO);
        assert!(middle.truncate().distance(Vec2::splat(50.0)) < 0.5);
        assert!(camera.project(Vec3::Z).y < middle.y && camera.project(Vec3::X).x > middle.x);
        assert!(camera.project(Vec3::NEG_Y).z > middle.z);
    }

    #[test]
    fn a_line_along_the_line_of_sight_is_seen_and_nothing_is_not() {
        let mut fit = Fit::new(Vec3::X, Vec2::ZERO, Vec2::splat(100.0));
        assert!(fit.camera().is_none());
        fit.see(Vec3::ZERO);
        assert!(fit.camera().unwrap().project(Vec3::ZERO).z > 0.0);
        fit.see(Vec3::X);
        assert!(fit.camera().unwrap().project(Vec3::X).z > 0.0);
    }
}
