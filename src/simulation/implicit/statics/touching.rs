//! How loads and motions grow where bodies may touch something: so slowly that what meets is seen, and as fast as rest
//! is found.

use crate::components::*;
use crate::systems::SurfaceContacts;
use bevy_ecs::prelude::*;

/// How far a tool may go against a body between two searches, and axes in an iteration, in edges of the surface: what
/// goes farther may be beyond the middle of what it meets.
const FARTHEST: f64 = 0.5;
/// Searches at most into which the way of a tool is cut; relaxation goes what is longer.
const MOST_SEARCHES: f64 = 50.0;
/// How often the share by which loads grow is halved.
const MOST_HALVINGS: i32 = 6;

/// Shares of loads and motions, one search after the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Growth {
    done: f64,
    by: f64,
    least: f64,
}

impl Growth {
    /// All in one search.
    pub fn at_once() -> Self {
        Self { done: 1.0, by: 0.0, least: 0.0 }
    }

    /// From a share on, in so many searches if all are found.
    fn from(share: f64, searches: f64) -> Self {
        let by = (1.0 - share) / searches;
        Self { done: share, by, least: by * 0.5_f64.powi(MOST_HALVINGS) }
    }

    /// Shares at the beginning and at the end of the next search.
    pub fn next(&self) -> [f64; 2] {
        // rounding leaves no search of its own
        let to = self.done + self.by;
        [self.done, if to > 1.0 - 1e-9 { 1.0 } else { to }]
    }

    /// That rest was found.
    pub fn succeeded(&mut self) {
        self.done = self.next()[1];
    }

    /// That it was not; whether to try half as far.
    pub fn failed(&mut self) -> bool {
        self.by *= 0.5;
        self.by > 0.0 && self.by >= self.least
    }
}

/// What bodies that may touch something ask of a search.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touching {
    /// How far axes may go in an iteration (m).
    pub farthest: f64,
    /// How loads grow; none where tools go too far for that.
    pub growth: Option<Growth>,
}

impl Touching {
    /// Of a world that has come so many pseudo-steps on its way to rest.
    pub fn of(world: &mut World, relaxation: &Relaxation, step: u64) -> Self {
        let begins = relaxation.share(step);
        let edge = world.get_resource::<SurfaceContacts>().map_or(f64::INFINITY, |contacts| contacts.edge);
        let mut all = world.query::<&ToolContacts>();
        let signals = world.resource::<Signals>();
        let [from, to] = [begins, 1.0].map(|share| signals.poses_at_share(relaxation.end, share));
        let pose = |poses: &[(usize, Pose)], signal: usize| {
            poses.iter().find(|(slot, _)| *slot == signal).map(|&(_, pose)| pose)
        };
        let (mut edge, mut searches) = (edge, 1.0_f64);
        for contacts in all.iter(world) {
            edge = edge.min(contacts.edge);
            for tool in &contacts.tools {
                let (Some(from), Some(to)) = (pose(&from, tool.signal), pose(&to, tool.signal)) else { continue };
                searches = searches.max(way(tool, from, to) / (FARTHEST * contacts.edge));
            }
        }
        let searches = searches.ceil();
        let growth = (searches <= MOST_SEARCHES).then(|| Growth::from(begins, searches));
        Self { farthest: FARTHEST * edge, growth }
    }
}

/// How far a point of a tool goes at most, from one pose to another (m); of a plane as far as its origin, and what that
/// turns by is not known.
fn way(tool: &ToolContact, from: Pose, to: Pose) -> f64 {
    let turn = (from.rotation.transpose() * to.rotation - glam::DMat3::IDENTITY).to_cols_array();
    // the largest of a turned vector's changes is no more than its Frobenius norm
    let turn = turn.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
    let reach = tool.geometry.bounding_sphere().map_or(0.0, |(center, radius)| center.length() + radius);
    from.at.distance(to.at) + reach * turn
}

#[cfg(test)]
mod tests;
