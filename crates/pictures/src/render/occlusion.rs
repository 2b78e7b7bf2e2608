//! Soft shadows: how much of a wide sky each point sees. The sky is some directions about up and the key light; along
//! each, a map says how far the nearest surface is.

use glam::{Vec2, Vec3};
use rayon::prelude::*;
use std::f32::consts::{PI, TAU};

/// A triangle that casts shadows: its corners (m), and how far they are beyond the plane that cuts (m).
pub type Caster = ([Vec3; 3], [f32; 3]);

/// Directions of the sky.
const DIRECTIONS: usize = 40;
/// Texels along each side of a map.
const TEXELS: usize = 320;
/// Points along each side of the grid on which the ground's shadow is found.
const GRID: usize = 160;
/// How far the ground reaches, in radii of what casts shadows.
const REACH: f32 = 3.2;

/// Maps of all directions.
pub struct Sky {
    maps: Vec<Map>,
    centre: Vec3,
    radius: f32,
}

/// What is nearest to the sky in one direction.
struct Map {
    /// Across, across, towards the sky, each of length 1.
    axes: [Vec3; 3],
    /// Along the direction, from the centre (m).
    height: Vec<f32>,
}

impl Sky {
    /// The sky over what casts shadows; nothing where that has no extent. `up` and `key`: of length 1.
    pub fn new(casters: &[Caster], up: Vec3, key: Vec3) -> Option<Sky> {
        let points = || casters.iter().flat_map(|caster| caster.0).filter(|point| point.is_finite());
        let (low, high) = points().fold((Vec3::MAX, Vec3::MIN), |(low, high), p| (low.min(p), high.max(p)));
        let (centre, radius) = ((low + high) / 2.0, low.distance(high) / 2.0 * 1.02);
        if !(radius > 0.0 && radius.is_finite()) {
            return None;
        }
        let middle = (up + 0.7 * key).normalize_or(up);
        let map = |number: usize| {
            let axes = axes(direction(number, middle));
            let mut map = Map { axes, height: vec![f32::MIN; TEXELS * TEXELS] };
            casters.iter().for_each(|caster| map.draw(caster, centre, radius));
            map
        };
        Some(Sky { maps: (0..DIRECTIONS).into_par_iter().map(map).collect(), centre, radius })
    }

    /// The share of the sky that a point with that normal sees, 0 to 1.
    pub fn seen(&self, point: Vec3, normal: Vec3) -> f32 {
        let texel = 2.0 * self.radius / TEXELS as f32;
        let place = (point + normal * (1.6 * texel) - self.centre) / texel;
        // what looks away from the sky is not dark for that alone
        let rest = 0.06 * DIRECTIONS as f32;
        let (mut open, mut all) = (rest, rest);
        for map in &self.maps {
            let weight = normal.dot(map.axes[2]);
            if weight > 0.0 {
                all += weight;
                open += weight * map.open(place, texel);
            }
        }
        open / all
    }

    /// The shadow on the ground: a plane with its normal, of length 1, and its height along that (m).
    pub fn ground(&self, (up, height): (Vec3, f32)) -> Ground {
        let [across, along, up] = axes(up);
        let foot = self.centre + up * (height - self.centre.dot(up));
        let reach = REACH * self.radius;
        let row = |row: usize| {
            (0..GRID).map(move |column| {
                let place = (Vec2::new(column as f32, row as f32) / (GRID - 1) as f32 * 2.0 - 1.0) * reach;
                self.seen(foot + across * place.x + along * place.y, up)
            })
        };
        let rows: Vec<Vec<f32>> = (0..GRID).into_par_iter().map(|number| row(number).collect()).collect();
        let mut seen = rows.concat();
        // far shadows are the sum of a few sharp ones: smoothed, they are as soft as those of a whole sky
        let soft = (0..3).fold(seen.clone(), |grid, _| smoothed(&grid));
        for (seen, soft) in seen.iter_mut().zip(soft) {
            let share = ((soft - 0.55) / 0.3).clamp(0.0, 1.0);
            *seen += (soft - *seen) * share;
        }
        Ground { foot, axes: [across, along, up], reach, seen }
    }
}

/// Each point of the ground's grid as the mean of those around it.
fn smoothed(grid: &[f32]) -> Vec<f32> {
    let across = mean_of_rows(grid);
    // turned, columns are rows
    let turn = |grid: &[f32]| -> Vec<f32> { (0..GRID * GRID).map(|at| grid[at % GRID * GRID + at / GRID]).collect() };
    turn(&mean_of_rows(&turn(&across)))
}

fn mean_of_rows(grid: &[f32]) -> Vec<f32> {
    const NEAR: usize = 4;
    let mean = |row: &[f32], at: usize| {
        let near = &row[at.saturating_sub(NEAR)..(at + NEAR + 1).min(GRID)];
        near.iter().sum::<f32>() / near.len() as f32
    };
    grid.chunks(GRID).flat_map(|row| (0..GRID).map(move |at| mean(row, at))).collect()
}

/// Directions evenly spread over a hemisphere (a Fibonacci spiral).
fn direction(number: usize, middle: Vec3) -> Vec3 {
    let height = 1.0 - 0.97 * (number as f32 + 0.5) / DIRECTIONS as f32;
    let turn = number as f32 * PI * (3.0 - 5f32.sqrt()) % TAU;
    let [x, y, z] = axes(middle);
    (1.0 - height * height).sqrt() * (x * turn.cos() + y * turn.sin()) + z * height
}

/// Two directions across one of length 1, and that.
fn axes(towards: Vec3) -> [Vec3; 3] {
    let (across, along) = towards.any_orthonormal_pair();
    [across, along, towards]
}

impl Map {
    fn draw(&mut self, (corners, beyond): &Caster, centre: Vec3, radius: f32) {
        let texel = 2.0 * radius / TEXELS as f32;
        let places = corners.map(|corner| self.place((corner - centre) / texel));
        let [a, b, c] = places.map(Vec3::truncate);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let doubled = (b - a).perp_dot(c - a);
        // as a negation, so that a triangle of unknown place (NaN) ends here too
        if !(doubled.abs() > 1e-9 && high.min_element() >= 0.0 && low.max_element() < TEXELS as f32) {
            return;
        }
        let last = TEXELS as f32 - 1.0;
        let (left, top) = ((low.x - 0.5).ceil().max(0.0) as usize, (low.y - 0.5).ceil().max(0.0) as usize);
        let (right, bottom) = ((high.x - 0.5).floor().min(last), (high.y - 0.5).floor().min(last));
        for row in (top..TEXELS).take_while(|row| *row as f32 <= bottom) {
            for column in (left..TEXELS).take_while(|column| *column as f32 <= right) {
                let at = Vec2::new(column as f32 + 0.5, row as f32 + 0.5);
                let (wb, wc) = ((at - a).perp_dot(c - a) / doubled, (b - a).perp_dot(at - a) / doubled);
                let share = Vec3::new(1.0 - wb - wc, wb, wc);
                if share.min_element() >= 0.0 && share.dot(Vec3::from_array(*beyond)) <= 0.0 {
                    let height = share.dot(Vec3::from_array(places.map(|place| place.z))) * texel;
                    let old = &mut self.height[row * TEXELS + column];
                    *old = old.max(height);
                }
            }
        }
    }

    /// Where a point is in the map, of one in texels about the centre.
    fn place(&self, point: Vec3) -> Vec3 {
        let middle = Vec3::new(TEXELS as f32, TEXELS as f32, 0.0) / 2.0;
        Vec3::from_array(self.axes.map(|axis| axis.dot(point))) + middle
    }

    /// How much of a point sees the sky, between four texels.
    fn open(&self, point: Vec3, texel: f32) -> f32 {
        let place = self.place(point);
        let height = (place.z + 1.2) * texel;
        let at = place.truncate() - 0.5;
        let (corner, share) = (at.floor(), at - at.floor());
        let lit = |dx: f32, dy: f32| {
            let (x, y) = (corner.x + dx, corner.y + dy);
            let inside = x >= 0.0 && y >= 0.0 && x < TEXELS as f32 && y < TEXELS as f32;
            if inside && self.height[y as usize * TEXELS + x as usize] > height { 0.0 } else { 1.0 }
        };
        let upper = lit(0.0, 0.0) * (1.0 - share.x) + lit(1.0, 0.0) * share.x;
        let lower = lit(0.0, 1.0) * (1.0 - share.x) + lit(1.0, 1.0) * share.x;
        upper * (1.0 - share.y) + lower * share.y
    }
}

/// The ground with its shadow.
pub struct Ground {
    foot: Vec3,
    axes: [Vec3; 3],
    reach: f32,
    seen: Vec<f32>,
}

impl Ground {
    /// The share of the sky that the ground sees where a ray from an eye meets it; 1 where it does not.
    pub fn seen(&self, eye: Vec3, ray: Vec3) -> f32 {
        let (above, down) = ((eye - self.foot).dot(self.axes[2]), -ray.dot(self.axes[2]));
        // from below there is no ground, and near the horizon only a thin line of it
        let slope = down / ray.length();
        if !(above > 0.0 && slope > 0.02) {
            return 1.0;
        }
        let met = eye + ray * (above / down) - self.foot;
        let place = Vec2::new(met.dot(self.axes[0]), met.dot(self.axes[1])) / self.reach;
        // the shadow ends softly at the border of what is known, and towards the horizon
        let fade = ((1.0 - place.length()) / 0.4).clamp(0.0, 1.0) * ((slope - 0.02) / 0.1).clamp(0.0, 1.0);
        if fade == 0.0 {
            return 1.0;
        }
        let at = (place + 1.0) / 2.0 * (GRID - 1) as f32;
        let (x, y) = ((at.x as usize).min(GRID - 2), (at.y as usize).min(GRID - 2));
        let share = at - Vec2::new(x as f32, y as f32);
        let mix = |row: usize| self.seen[row * GRID + x] * (1.0 - share.x) + self.seen[row * GRID + x + 1] * share.x;
        let seen = mix(y) * (1.0 - share.y) + mix(y + 1) * share.y;
        1.0 - (1.0 - seen) * fade * fade * (3.0 - 2.0 * fade)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    /// A square in z = `height`, of side 2.
    fn square(height: f32) -> [Caster; 2] {
        let corner = |x: f32, y: f32| Vec3::new(x, y, height);
        let (a, b, c, d) = (corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0));
        [([a, b, c], [0.0; 3]), ([a, c, d], [0.0; 3])]
    }

    #[test]
    fn a_roof_darkens_what_is_below_it_and_not_its_top() {
        let casters = [square(0.0), square(0.5)].concat();
        let sky = Sky::new(&casters, Vec3::Z, Vec3::Z).unwrap();
        let (below, top) = (sky.seen(Vec3::ZERO, Vec3::Z), sky.seen(Vec3::new(0.0, 0.0, 0.5), Vec3::Z));
        assert!(below < 0.3 && top > 0.97, "{below} {top}");
        assert!(Sky::new(&[], Vec3::Z, Vec3::Z).is_none());
    }

    #[test]
    fn the_ground_is_dark_below_a_body_and_bright_far_from_it() {
        let sky = Sky::new(&square(0.3), Vec3::Z, Vec3::Z).unwrap();
        let ground = sky.ground((Vec3::Z, 0.0));
        let eye = Vec3::new(0.0, -6.0, 6.0);
        let seen = |x: f32, y: f32| ground.seen(eye, Vec3::new(x, y, 0.0) - eye);
        assert!(seen(0.0, 0.0) < 0.4 && seen(9.0, 0.0) == 1.0 && seen(1.3, 0.0) > seen(0.5, 0.0));
        assert_eq!(ground.seen(-eye, eye), 1.0);
    }
}
