//! Displacements of single points as a reference: the `nodes.csv` of an earlier run.

use super::solver::Field;
use glam::DVec3;
use std::collections::{BTreeMap, HashMap};

/// How far apart two points may lie and still be one, in sizes of the body.
const SAME: f64 = 1e-6;

/// More cells of that size than a body is long.
const FAR: DVec3 = DVec3::splat(1e12);

/// Rest positions and displacements at the end of points, by body.
#[derive(Clone, Debug, Default)]
pub struct PointReference {
    /// The points of each body: at rest (m) and their displacements (m). The only body may have an empty name.
    pub bodies: BTreeMap<String, Vec<(DVec3, DVec3)>>,
}

impl PointReference {
    /// Relative distance of a field from the points at the end, over the nodes that lie where a point lies:
    /// mass-weighted root mean square, and the largest. `None` where no node does, or where nothing moves.
    pub fn error_of(&self, field: &Field) -> Option<[f64; 2]> {
        let (mut away, mut length, mut worst, mut top) = (0.0, 0.0, 0.0f64, 0.0f64);
        for (name, body) in &field.bodies {
            let only = || self.bodies.values().next().filter(|_| field.bodies.len() == 1 && self.bodies.len() == 1);
            let Some(points) = self.bodies.get(name).or_else(only) else { continue };
            let low = body.mesh.points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
            let high = body.mesh.points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
            let cell = SAME * (high - low).length().max(1e-300);
            // points far outside of the body are all the same to it
            let key = |x: DVec3| ((x - low) / cell).round().clamp(-FAR, FAR).as_i64vec3().to_array();
            let known: HashMap<[i64; 3], DVec3> = points.iter().map(|(x, u)| (key(*x), *u)).collect();
            for (node, x) in body.mesh.points.iter().enumerate() {
                let (at, own) = (key(*x), body.displacements.last()?[node]);
                // a coordinate may have been rounded to either side
                let near = (0..27).map(|n: i64| [at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1]);
                let Some(u) = near.into_iter().find_map(|at| known.get(&at)) else { continue };
                let mass = body.masses[node];
                away += mass * own.distance_squared(*u);
                length += mass * u.length_squared();
                if mass > 0.0 {
                    (worst, top) = (worst.max(own.distance(*u)), top.max(u.length()));
                }
            }
        }
        (length > 0.0 && top > 0.0).then(|| [(away / length).sqrt(), worst / top])
    }
}
