//! Where the eye stands.

use glam::{Mat3, Vec2, Vec3};

/// An eye with perspective that sees a whole box in a part of the picture. z is up.
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

/// Tangent of half the angle that the height of the view spans: a long lens, little distortion.
const HALF_ANGLE: f32 = 0.22;

impl Camera {
    /// Looks from a direction (of any length but zero) at the box from `low` to `high` (m), and fits it into the part of the
    /// picture from `left_top` to `right_bottom` (pixels).
    pub fn new(from: Vec3, (low, high): (Vec3, Vec3), left_top: Vec2, right_bottom: Vec2) -> Camera {
        let back = from.normalize_or(Vec3::NEG_Y);
        let up = if back.z.abs() > 0.999 { Vec3::Y } else { Vec3::Z };
        let right = up.cross(back).normalize();
        let axes = Mat3::from_cols(right, back.cross(right), back).transpose();
        let extent = (right_bottom - left_top).max(Vec2::ONE);
        let focal = extent.y / (2.0 * HALF_ANGLE);
        let middle = (left_top + right_bottom) / 2.0;
        let size = (high - low).length().max(1e-12);
        let mut target = axes * ((low + high) / 2.0);
        let corners: Vec<Vec3> = (0..8).map(|bits| axes * corner(low, high, bits)).collect();
        let mut distance = size;
        // each round centres what is seen and then goes as near as all corners allow; five rounds settle it below a pixel
        for _ in 0..5 {
            let reach = |point: &Vec3| {
                let point = *point - target;
                let sideways = (2.0 * focal * point.truncate().abs() / extent).max_element();
                point.z + sideways
            };
            distance = corners.iter().map(reach).fold(size * 0.01, f32::max);
            let seen = corners.iter().map(|point| (*point - target).truncate() / (distance - (*point - target).z));
            let (least, most) = seen.fold((Vec2::MAX, Vec2::MIN), |(a, b), point| (a.min(point), b.max(point)));
            target += ((least + most) / 2.0 * distance).extend(0.0);
        }
        let reach = |point: &Vec3| {
            let point = *point - target;
            point.z + (2.0 * focal * point.truncate().abs() / extent).max_element()
        };
        distance = corners.iter().map(reach).fold(distance, f32::max);
        let eye = axes.transpose() * (target + Vec3::Z * distance);
        Camera { eye, axes, focal, middle }
    }

    /// Where a point appears (pixels), and the inverse of its distance along the line of sight (1/m), negative behind the
    /// eye.
    pub fn project(&self, point: Vec3) -> Vec3 {
        let seen = self.axes * (point - self.eye);
        let inverse = -1.0 / seen.z;
        let place = self.middle + Vec2::new(seen.x, -seen.y) * inverse * self.focal;
        place.extend(inverse)
    }

    /// A direction as the eye sees it: to the right, up, towards the eye.
    pub fn turn(&self, direction: Vec3) -> Vec3 {
        self.axes * direction
    }

    /// Where the eye is (m).
    pub fn eye(&self) -> Vec3 {
        self.eye
    }
}

fn corner(low: Vec3, high: Vec3, bits: u32) -> Vec3 {
    Vec3::select(glam::BVec3::new(bits & 1 != 0, bits & 2 != 0, bits & 4 != 0), high, low)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    #[test]
    fn the_whole_box_is_seen_from_everywhere_and_fills_its_part() {
        let (left_top, right_bottom) = (Vec2::new(20.0, 10.0), Vec2::new(940.0, 600.0));
        let bounds = (Vec3::new(-1.0, 2.0, 0.0), Vec3::new(3.0, 2.5, 1.0));
        for from in [Vec3::X, Vec3::Z, Vec3::NEG_Z, Vec3::new(1.0, -2.0, 0.8), Vec3::new(-3.0, 0.1, -1.0)] {
            let camera = Camera::new(from, bounds, left_top, right_bottom);
            let seen: Vec<Vec3> = (0..8).map(|bits| camera.project(corner(bounds.0, bounds.1, bits))).collect();
            let low = seen.iter().fold(Vec3::MAX, |a, b| a.min(*b));
            let high = seen.iter().fold(Vec3::MIN, |a, b| a.max(*b));
            assert!(low.z > 0.0, "{from}: a corner lies behind the eye");
            assert!(low.truncate().cmpge(left_top - 1.0).all() && high.truncate().cmple(right_bottom + 1.0).all());
            let filled = ((high - low).truncate() / (right_bottom - left_top)).max_element();
            assert!(filled > 0.97, "{from}: {filled}");
        }
    }

    #[test]
    fn up_is_up_and_near_is_near() {
        let bounds = (Vec3::splat(-1.0), Vec3::splat(1.0));
        let camera = Camera::new(Vec3::NEG_Y, bounds, Vec2::ZERO, Vec2::splat(100.0));
        let middle = camera.project(Vec3::ZERO);
        assert!(middle.truncate().distance(Vec2::splat(50.0)) < 0.5);
        assert!(camera.project(Vec3::Z).y < middle.y && camera.project(Vec3::X).x > middle.x);
        assert!(camera.project(Vec3::NEG_Y).z > middle.z);
    }
}
