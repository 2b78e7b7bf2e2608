//! What is left of polygons that reach too far.

use glam::Vec3;

/// The part of a convex polygon where `above` is not below 0; `mix` is the corner at a share of the way to another.
pub fn kept<C: Copy>(polygon: &[C], above: impl Fn(&C) -> f32, mix: impl Fn(&C, &C, f32) -> C) -> Vec<C> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (row, now) in polygon.iter().enumerate() {
        let next = &polygon[(row + 1) % polygon.len()];
        let (here, there) = (above(now), above(next));
        if here >= 0.0 {
            kept.push(*now);
        }
        if (here >= 0.0) != (there >= 0.0) {
            kept.push(mix(now, next, here / (here - there)));
        }
    }
    kept
}

/// A box with its edges along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// The least of all coordinates (m).
    pub low: Vec3,
    /// The largest (m).
    pub high: Vec3,
}

impl Extent {
    /// Holds nothing.
    pub const NOTHING: Extent = Extent { low: Vec3::MAX, high: Vec3::MIN };

    /// Makes room for a point; one that is not finite is left out.
    pub fn add(&mut self, point: Vec3) {
        if point.is_finite() {
            (self.low, self.high) = (self.low.min(point), self.high.max(point));
        }
    }

    /// Whether it holds nothing.
    pub fn is_nothing(&self) -> bool {
        !self.low.cmple(self.high).all()
    }

    /// From one corner to the opposite one (m).
    pub fn diagonal(&self) -> f32 {
        if self.is_nothing() { 0.0 } else { self.low.distance(self.high) }
    }

    /// Its middle.
    pub fn middle(&self) -> Vec3 {
        (self.low + self.high) / 2.0
    }

    /// Farther out on all sides by a share of its diagonal.
    pub fn grown(&self, share: f32) -> Extent {
        let by = share * self.diagonal();
        Extent { low: self.low - by, high: self.high + by }
    }

    /// Whether a point is in it.
    pub fn has(&self, point: Vec3) -> bool {
        point.cmpge(self.low).all() && point.cmple(self.high).all()
    }

    /// The part of a triangle that lies in it, as a polygon; none of one that is not finite.
    pub fn part_of(&self, triangle: [Vec3; 3]) -> Vec<Vec3> {
        let (low, high) =
            (triangle[0].min(triangle[1]).min(triangle[2]), triangle[0].max(triangle[1]).max(triangle[2]));
        if !(low.is_finite() && high.is_finite() && low.cmple(self.high).all() && high.cmpge(self.low).all()) {
            return Vec::new();
        }
        if self.has(low) && self.has(high) {
            return triangle.to_vec();
        }
        let mix = |from: &Vec3, to: &Vec3, share: f32| from.lerp(*to, share);
        (0..3).fold(triangle.to_vec(), |polygon, axis| {
            let above = kept(&polygon, |point| point[axis] - self.low[axis], mix);
            kept(&above, |point| self.high[axis] - point[axis], mix)
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    fn area(polygon: &[Vec3]) -> f32 {
        let fan = polygon.windows(2).map(|pair| (pair[0] - polygon[0]).cross(pair[1] - polygon[0]));
        fan.sum::<Vec3>().length() / 2.0
    }

    #[test]
    fn of_a_triangle_that_which_is_in_the_box_is_left() {
        let unit = Extent { low: Vec3::ZERO, high: Vec3::ONE };
        let triangle = |reach: f32| [(0.0, 0.0), (reach, 0.0), (0.0, reach)].map(|(x, y)| Vec3::new(x, y, 0.5));
        assert_eq!(unit.part_of(triangle(1.0)), triangle(1.0));
        // a corner is cut off, then all of the square is covered
        assert!((area(&unit.part_of(triangle(1.5))) - 0.875).abs() < 1e-6);
        assert!((area(&unit.part_of(triangle(50.0))) - 1.0).abs() < 1e-4);
        assert!(unit.part_of(triangle(1.0).map(|point| point + 2.0)).is_empty());
        assert!(unit.part_of([Vec3::NAN; 3]).is_empty());
        assert!(area(&Extent::NOTHING.part_of(triangle(1.0))) == 0.0 && Extent::NOTHING.is_nothing());
    }

    #[test]
    fn a_box_grows_on_all_sides() {
        let mut found = Extent::NOTHING;
        assert_eq!(found.diagonal(), 0.0);
        [Vec3::ZERO, Vec3::new(3.0, 4.0, 0.0), Vec3::NAN].into_iter().for_each(|point| found.add(point));
        let grown = found.grown(0.2);
        assert!(grown.low.distance(Vec3::splat(-1.0)) < 1e-6 && grown.high.distance(Vec3::new(4.0, 5.0, 1.0)) < 1e-6);
        assert!(grown.has(found.middle()) && !grown.has(Vec3::splat(2.0)));
    }
}
