//! An eye that turns about a point.

use glam::{Quat, Vec2, Vec3};
use sinew_pictures::render::{Camera, Extent, Fit, View};

/// Where the eye is, and what it looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// From the point to the eye, of length 1.
    from: Vec3,
    up: Vec3,
    point: Vec3,
    /// From the point to the eye (m).
    distance: f32,
}

/// Radians a point of the screen.
const TURN: f32 = 0.008;
/// The eye stays so far from where up is (cosine).
const POLE: f32 = 0.998;
/// What is nearer to the eye than this share of the distance is not drawn.
const NEAR: f32 = 0.02;

impl Orbit {
    /// From where a picture of the scene is seen.
    pub fn of(view: &View) -> Self {
        let up = view.up.normalize_or(Vec3::Z);
        Self { from: view.from.normalize_or(Vec3::NEG_Y), up, point: Vec3::ZERO, distance: 1.0 }
    }

    /// Looks from a direction.
    pub fn look_from(&mut self, from: Vec3) {
        // straight from above there is no upright
        let from = from.normalize_or(Vec3::NEG_Y);
        let level = self.up.any_orthonormal_vector();
        self.from = if from.dot(self.up).abs() > POLE { (from - 0.05 * level).normalize() } else { from };
    }

    /// Goes to where all of an extent is seen, in a picture of a size (pixels), as `sinew render` would.
    pub fn fit(&mut self, extent: &Extent, size: Vec2) {
        if extent.is_nothing() {
            return;
        }
        let (left_top, right_bottom) = stage(size);
        let mut fit = Fit::new(&self.view(), left_top, right_bottom);
        for bits in 0..8u32 {
            let high = glam::BVec3::new(bits & 1 != 0, bits & 2 != 0, bits & 4 != 0);
            fit.see(Vec3::select(high, extent.high, extent.low));
        }
        let Some(camera) = fit.camera() else { return };
        self.distance = (camera.eye() - extent.middle()).dot(self.from).max(1e-6);
        self.point = camera.eye() - self.from * self.distance;
    }

    /// Looks at a point from a distance (m).
    pub fn go_to(&mut self, point: Vec3, distance: f32) {
        if point.is_finite() && distance > 0.0 {
            (self.point, self.distance) = (point, distance);
        }
    }

    /// The camera for a picture of a size (pixels).
    pub fn camera(&self, size: Vec2) -> Camera {
        Camera::looking_at(&self.view(), (self.point, self.distance, NEAR * self.distance), stage(size))
    }

    /// Turns by a way of the mouse (points of the screen).
    pub fn turn(&mut self, by: Vec2) {
        let around = Quat::from_axis_angle(self.up, -TURN * by.x);
        let right = self.up.cross(self.from).normalize_or(Vec3::X);
        let tilted = Quat::from_axis_angle(right, -TURN * by.y) * self.from;
        let from = if tilted.dot(self.up).abs() < POLE { tilted } else { self.from };
        self.from = (around * from).normalize_or(self.from);
    }

    /// Moves what is seen by a way of the mouse (pixels).
    pub fn pan(&mut self, by: Vec2, size: Vec2) {
        let camera = self.camera(size);
        let each = self.distance / camera.focal();
        self.point += camera.turn_back(Vec3::new(-by.x, by.y, 0.0)) * each;
    }

    /// Goes nearer (above 1) or farther, by a factor.
    pub fn zoom(&mut self, factor: f32) {
        if factor.is_finite() && factor > 0.0 {
            self.distance = (self.distance / factor).clamp(1e-6, 1e6);
        }
    }

    fn view(&self) -> View {
        View { up: self.up, ..View::upright(self.from) }
    }
}

/// The part of a picture that bodies fill when they are fitted into it.
fn stage(size: Vec2) -> (Vec2, Vec2) {
    let margin = 0.06 * size.y;
    (Vec2::splat(margin), (size - margin).max(Vec2::splat(margin + 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_keeps_the_point_in_the_middle_and_panning_moves_it_with_the_mouse() {
        let size = Vec2::new(400.0, 300.0);
        let mut orbit = Orbit::of(&View::upright(Vec3::new(1.0, -2.0, 0.6)));
        orbit.fit(&Extent { low: Vec3::splat(-1.0), high: Vec3::splat(2.0) }, size);
        let point = orbit.point;
        let seen = |orbit: &Orbit| orbit.camera(size).project(point).truncate();
        assert!(seen(&orbit).distance(size / 2.0) < 1.0, "{}", seen(&orbit));
        orbit.turn(Vec2::new(77.0, -31.0));
        assert!(seen(&orbit).distance(size / 2.0) < 1.0);
        let before = seen(&orbit);
        orbit.pan(Vec2::new(20.0, -9.0), size);
        assert!((seen(&orbit) - before).distance(Vec2::new(20.0, -9.0)) < 0.1);
        // never over the pole
        (0..200).for_each(|_| orbit.turn(Vec2::new(0.0, 50.0)));
        assert!(orbit.from.is_finite() && orbit.from.dot(orbit.up).abs() <= POLE);
        let far = orbit.distance;
        orbit.zoom(2.0);
        orbit.zoom(f32::NAN);
        assert!((orbit.distance - far / 2.0).abs() < 1e-5);
    }
}
