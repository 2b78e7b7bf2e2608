//! Where the eye stands.

use super::clip::Extent;
use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};
use sinew::scene::schema::Picture;

/// How an eye looks at a scene.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Where the eye stands, seen from what it looks at; of any length but zero.
    pub from: Vec3,
    /// What points up in the picture; where that is along the line of sight y or x do instead.
    pub up: Vec3,
    /// The point in the middle (m); the middle of all that is seen when left out.
    pub look_at: Option<Vec3>,
    /// Magnification; at 1 all that is seen fits.
    pub zoom: f32,
}

/// An eye with perspective.
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
    /// What is nearer along the line of sight (m) is not drawn.
    near: f32,
}

/// Finds the place from which a camera sees all points of a series and fills its part of the picture with them.
#[derive(Clone, Debug)]
pub struct Fit {
    /// A camera in the origin.
    camera: Camera,
    /// Where it is to look, if that is said.
    look_at: Option<Vec3>,
    zoom: f32,
    /// Slopes of the planes that bound the view, to the sides and up and down.
    slope: Vec2,
    /// How far the points reach towards the planes to the right, above, to the left and below.
    reach: [Vec2; 2],
    /// The nearest and the farthest point, along the line of sight (m).
    depth: (f32, f32),
    /// The direction that is up in the world, of length 1, and the lowest point along it (m).
    ground: (Vec3, f32),
    /// What all points fill.
    extent: Extent,
}

/// What is nearer to the eye is not drawn, as a share of the distance of the nearest point that was to be seen.
const NEAR: f32 = 0.05;

/// Tangent of half the angle that the height of the view spans: a long lens, little distortion.
const HALF_ANGLE: f32 = 0.22;

impl View {
    /// Looks at the middle from a direction, z up.
    pub fn upright(from: Vec3) -> View {
        View { from, up: Vec3::Z, look_at: None, zoom: 1.0 }
    }
}

impl From<&Picture> for View {
    fn from(picture: &Picture) -> View {
        // lengths do not matter, and single precision may not know them
        let direction = |of: glam::DVec3| of.normalize_or_zero().as_vec3();
        View {
            from: direction(picture.from),
            up: direction(picture.up),
            look_at: picture.look_at.map(|point| point.as_vec3()),
            zoom: picture.zoom as f32,
        }
    }
}

impl Fit {
    /// Looks into the part of the picture from `left_top` to `right_bottom` (pixels).
    pub fn new(view: &View, left_top: Vec2, right_bottom: Vec2) -> Fit {
        let back = view.from.normalize_or(Vec3::NEG_Y);
        let wanted = view.up.normalize_or(Vec3::Z);
        let across = |up: &Vec3| up.dot(back).abs() < 0.999;
        let up = [wanted, Vec3::Y, Vec3::X].into_iter().find(across).unwrap_or(wanted);
        let right = up.cross(back).normalize();
        let axes = Mat3::from_cols(right, back.cross(right), back).transpose();
        let extent = (right_bottom - left_top).max(Vec2::ONE);
        let focal = extent.y / (2.0 * HALF_ANGLE);
        let camera = Camera { eye: Vec3::ZERO, axes, focal, middle: (left_top + right_bottom) / 2.0, near: 0.0 };
        Fit {
            camera,
            look_at: view.look_at,
            zoom: view.zoom,
            slope: 2.0 * focal / extent,
            reach: [Vec2::MIN; 2],
            depth: (f32::MIN, f32::MAX),
            ground: (wanted, f32::MAX),
            extent: Extent::NOTHING,
        }
    }

    /// Adds a point that is to be seen (m); one that is not finite is left out.
    pub fn see(&mut self, point: Vec3) {
        self.see_above_ground(point);
        if self.camera.turn(point).is_finite() {
            self.ground.1 = self.ground.1.min(point.dot(self.ground.0));
        }
    }

    /// As [`Fit::see`]; the ground stays where it is.
    pub fn see_above_ground(&mut self, point: Vec3) {
        let turned = self.camera.turn(point);
        if turned.is_finite() {
            let aside = turned.truncate() * self.slope;
            self.reach = [self.reach[0].max(aside + turned.z), self.reach[1].max(turned.z - aside)];
            self.depth = (self.depth.0.max(turned.z), self.depth.1.min(turned.z));
            self.extent.add(point);
        }
    }

    /// The direction that is up in the world, of length 1, and the lowest of all points along it (m).
    pub fn ground(&self) -> (Vec3, f32) {
        self.ground
    }

    /// What all points fill.
    pub fn extent(&self) -> Extent {
        self.extent
    }

    /// The camera, or nothing when there is no point. The planes through the eye that bound the view touch the points;
    /// of the narrower direction both, and in the other one the points are in the middle. With a point to look at, that
    /// is in the middle, and one plane touches. Zoom is a longer lens: the eye stays.
    pub fn camera(&self) -> Option<Camera> {
        let (near, far) = self.depth;
        if near < far {
            return None;
        }
        let [ahead, behind] = self.reach;
        // a thin line along the line of sight must not pass through the eye
        let least = near + (0.5 * (near - far)).max(1e-6);
        let (target, distance) = match self.look_at {
            None => ((ahead - behind) / (2.0 * self.slope), ((ahead + behind) / 2.0).max_element()),
            Some(point) => {
                let target = self.camera.turn(point).truncate();
                let aside = target * self.slope;
                (target, (ahead - aside).max(behind + aside).max_element())
            }
        };
        let distance = distance.max(least);
        let eye = self.camera.axes.transpose() * target.extend(distance);
        Some(Camera { eye, focal: self.camera.focal * self.zoom, near: NEAR * (distance - near), ..self.camera })
    }
}

impl Camera {
    /// Looks at a point (m) in the middle of the part of the picture from `left_top` to `right_bottom` (pixels), from a
    /// distance (m) in the direction of a view, whose `look_at` does not count; what is nearer than `near` (m) is not
    /// drawn.
    pub fn looking_at(
        view: &View,
        (point, distance, near): (Vec3, f32, f32),
        (left_top, right_bottom): (Vec2, Vec2),
    ) -> Camera {
        let Camera { axes, focal, middle, .. } = Fit::new(view, left_top, right_bottom).camera;
        let eye = point + axes.transpose() * Vec3::Z * distance;
        Camera { eye, axes, focal: focal * view.zoom, middle, near }
    }

    /// What takes a point (m) to where graphics devices clip, in a picture of a size (pixels): x and y from -1 to 1
    /// upwards, depth 1 at what is too near to be drawn and 0 infinitely far.
    pub fn clip_from_world(&self, size: Vec2) -> Mat4 {
        let (scale, shift) = (2.0 * self.focal / size, 2.0 * self.middle / size - 1.0);
        let row = |axis: usize| self.axes.row(axis);
        // right, up, and how far ahead; the eye in the origin
        let ahead = -row(2);
        let rows = [row(0) * scale.x + ahead * shift.x, row(1) * scale.y - ahead * shift.y, Vec3::ZERO, ahead];
        let moved = rows.map(|row| row.extend(-row.dot(self.eye)));
        Mat4::from_cols(moved[0], moved[1], Vec4::W * self.near, moved[3]).transpose()
    }

    /// Where a point appears (pixels), and the inverse of its distance along the line of sight (1/m), negative behind
    /// the eye.
    pub fn project(&self, point: Vec3) -> Vec3 {
        let seen = self.axes * (point - self.eye);
        let inverse = -1.0 / seen.z;
        let place = self.middle + Vec2::new(seen.x, -seen.y) * inverse * self.focal;
        place.extend(inverse)
    }

    /// How far a point is beyond what is too near to be drawn, along the line of sight (m).
    pub fn ahead(&self, point: Vec3) -> f32 {
        -self.turn(point - self.eye).z - self.near
    }

    /// Where the eye is (m).
    pub fn eye(&self) -> Vec3 {
        self.eye
    }

    /// What lies at a pixel: the eye and so many times this (m), with the distance along the line of sight as the
    /// number.
    pub fn ray(&self, pixel: Vec2) -> Vec3 {
        let aside = (pixel - self.middle) / self.focal;
        self.axes.transpose() * Vec3::new(aside.x, -aside.y, -1.0)
    }

    /// Pixels of one unit at distance one.
    pub fn focal(&self) -> f32 {
        self.focal
    }

    /// A direction as the eye sees it: to the right, up, towards the eye.
    pub fn turn(&self, direction: Vec3) -> Vec3 {
        self.axes * direction
    }

    /// A direction in the world, of one as the eye sees it.
    pub fn turn_back(&self, direction: Vec3) -> Vec3 {
        self.axes.transpose() * direction
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
            let mut fit = Fit::new(&View::upright(from), left_top, right_bottom);
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
        let mut fit = Fit::new(&View::upright(Vec3::NEG_Y), Vec2::ZERO, Vec2::splat(100.0));
        corners(Vec3::splat(-1.0), Vec3::splat(1.0)).for_each(|point| fit.see(point));
        let camera = fit.camera().unwrap();
        let middle = camera.project(Vec3::ZERO);
        assert!(middle.truncate().distance(Vec2::splat(50.0)) < 0.5);
        assert!(camera.project(Vec3::Z).y < middle.y && camera.project(Vec3::X).x > middle.x);
        assert!(camera.project(Vec3::NEG_Y).z > middle.z);
    }

    #[test]
    fn a_line_along_the_line_of_sight_is_seen_and_nothing_is_not() {
        let mut fit = Fit::new(&View::upright(Vec3::X), Vec2::ZERO, Vec2::splat(100.0));
        assert!(fit.camera().is_none());
        fit.see(Vec3::ZERO);
        assert!(fit.camera().unwrap().project(Vec3::ZERO).z > 0.0);
        fit.see(Vec3::X);
        assert!(fit.camera().unwrap().project(Vec3::X).z > 0.0);
    }

    #[test]
    fn the_point_looked_at_is_in_the_middle_and_zoom_enlarges_about_it() {
        let points: Vec<Vec3> = corners(Vec3::splat(-1.0), Vec3::splat(1.0)).collect();
        let camera = |look_at, zoom| {
            let view = View { look_at, zoom, ..View::upright(Vec3::new(1.0, -2.0, 0.8)) };
            let mut fit = Fit::new(&view, Vec2::ZERO, Vec2::new(400.0, 300.0));
            points.iter().for_each(|point| fit.see(*point));
            fit.camera().unwrap()
        };
        let (at, middle) = (Vec3::new(0.5, -1.0, 0.25), Vec2::new(200.0, 150.0));
        let (near, far) = (camera(Some(at), 3.0), camera(Some(at), 1.0));
        assert!(near.project(at).truncate().distance(middle) < 0.01);
        for point in points {
            let place = far.project(point).truncate();
            assert!(place.cmpge(Vec2::splat(-0.1)).all() && place.cmple(Vec2::new(400.1, 300.1)).all(), "{place}");
            let enlarged = middle + 3.0 * (place - middle);
            assert!(near.project(point).truncate().distance(enlarged) < 0.05);
        }
        let seen = near.project(at);
        let back = near.eye() + near.ray(seen.truncate()) / seen.z;
        assert!(back.distance(at) < 1e-5, "{back}");
    }

    #[test]
    fn graphics_devices_see_points_where_pictures_have_them() {
        let size = Vec2::new(300.0, 200.0);
        let view = View { zoom: 1.3, ..View::upright(Vec3::new(1.0, -2.0, 0.8)) };
        let at = Vec3::new(0.1, 0.2, -0.1);
        let camera = Camera::looking_at(&view, (at, 5.0, 0.5), (Vec2::new(20.0, 10.0), Vec2::new(280.0, 150.0)));
        assert!(camera.project(at).truncate().distance(Vec2::new(150.0, 80.0)) < 1e-3);
        assert!((camera.project(at).z - 0.2).abs() < 1e-6 && (camera.ahead(at) - 4.5).abs() < 1e-5);
        for point in corners(Vec3::splat(-1.0), Vec3::splat(1.0)) {
            let clip = camera.clip_from_world(size) * point.extend(1.0);
            let (seen, there) = (camera.project(point), clip.truncate() / clip.w);
            let pixel = (Vec2::new(there.x, -there.y) + 1.0) / 2.0 * size;
            assert!(pixel.distance(seen.truncate()) < 1e-2, "{point}: {pixel}, not {seen}");
            assert!((there.z - 0.5 * seen.z).abs() < 1e-6 && there.z > 0.0 && there.z < 1.0, "{there}");
        }
    }

    #[test]
    fn what_is_up_points_up_and_never_fails() {
        for (up, from) in [(Vec3::X, Vec3::NEG_Y), (Vec3::NEG_Z, Vec3::X), (Vec3::Y, Vec3::Z), (Vec3::Z, Vec3::Z)] {
            let mut fit = Fit::new(&View { up, ..View::upright(from) }, Vec2::ZERO, Vec2::splat(100.0));
            corners(Vec3::splat(-1.0), Vec3::splat(1.0)).for_each(|point| fit.see(point));
            let camera = fit.camera().unwrap();
            let above = camera.project(up);
            assert!(above.is_finite() && (above.y < 49.0 || up.cross(from) == Vec3::ZERO), "{up} {from}: {above}");
        }
    }
}
