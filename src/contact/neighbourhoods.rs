//! How far surfaces have moved where points are, in place of how far all of them have: shortlists serve on there that
//! little changes about.

use super::lists::Lists;
use super::surfaces::{Point, Surfaces};
use glam::DVec3;
use std::ops::Range;

/// Points of a neighbourhood: such as follow each other in lists, most of which lie side by side.
const POINTS: usize = 64;

/// A neighbourhood begins anew when it is looked at and less than this is left of how far it may move.
const LEFT: f64 = 0.25;

/// One also begins anew that may move so many times as far as is asked for: the farther nodes may move, the more is in
/// a point's way.
const WIDE: f64 = 8.0;

/// What rounding takes of a difference at most, and more.
const ROUNDING: f64 = 1e-6;

/// Neighbourhoods of points in lists.
#[derive(Clone, Debug, Default)]
pub struct Neighbourhoods {
    /// Where the nodes of each begin, and where the last one's end.
    starts: Vec<u32>,
    /// The nodes that what its points face depends on.
    nodes: Vec<u32>,
    /// Where they were when it was begun (m).
    before: Vec<DVec3>,
    motions: Vec<Motion>,
    /// The farthest that nodes may move anywhere (m).
    widest: f64,
}

/// How far any two nodes of a neighbourhood have moved against each other when it was looked at, and how far they may
/// (m).
#[derive(Clone, Copy, Debug)]
struct Motion {
    moved: f64,
    allowed: f64,
}

impl Neighbourhoods {
    /// Of the points in lists, not begun yet.
    pub fn list(&mut self, surfaces: &Surfaces, points: &[Point], lists: &Lists) {
        let Self { starts, nodes, before, motions, widest } = self;
        *widest = 0.0;
        starts.clear();
        starts.push(0);
        nodes.clear();
        let mut seen = vec![usize::MAX; surfaces.nodes()];
        for (number, of_points) in lists.points.chunks(POINTS).enumerate() {
            let first = nodes.len();
            let mut see = |node: u32, nodes: &mut Vec<u32>| {
                if std::mem::replace(&mut seen[node as usize], number) != number {
                    nodes.push(node);
                }
            };
            for (place, &point) in (POINTS * number..).zip(of_points) {
                points[point as usize].parts().for_each(|(node, _)| see(node, nodes));
                let corners = lists.triangles(place).iter().flat_map(|&triangle| surfaces.triangles[triangle as usize]);
                corners.for_each(|node| see(node, nodes));
            }
            // which way the surfaces go on beside these, and where
            for place in first..nodes.len() {
                let around = surfaces.around(nodes[place]).iter();
                around.flat_map(|&triangle| surfaces.triangles[triangle as usize]).for_each(|node| see(node, nodes));
            }
            starts.push(nodes.len() as u32);
        }
        before.clear();
        before.resize(nodes.len(), DVec3::ZERO);
        motions.clear();
        motions.resize(starts.len() - 1, Motion { moved: f64::INFINITY, allowed: 0.0 });
    }

    /// Bytes that they take.
    pub fn bytes(&self) -> usize {
        let Self { starts, nodes, before, motions, .. } = self;
        size_of_val(&starts[..]) + size_of_val(&nodes[..]) + size_of_val(&before[..]) + size_of_val(&motions[..])
    }

    /// Whether nodes may move somewhere much farther than they need to (m).
    pub fn is_too_wide(&self, allowed: f64) -> bool {
        self.widest > WIDE * allowed
    }

    /// Looks at all of them, with nodes where they are (m). Those of which little is left, and those that are too wide,
    /// begin anew, and nodes may move so far there (m) from then on: `renew` is told of which places in the lists these
    /// are. Gives how far any two nodes may move until it has to be looked again (m).
    pub fn follow(&mut self, places: &[DVec3], allowed: f64, mut renew: impl FnMut(Range<usize>)) -> f64 {
        let Self { starts, nodes, before, motions, widest } = self;
        let mut left = f64::INFINITY;
        *widest = 0.0;
        for (number, motion) in motions.iter_mut().enumerate() {
            let range = starts[number] as usize..starts[number + 1] as usize;
            let (nodes, before) = (&nodes[range.clone()], &mut before[range]);
            motion.moved = apart(places, nodes, before);
            // of what is no number nothing is left
            let may_move = motion.allowed - motion.moved > LEFT * motion.allowed;
            if !may_move || motion.allowed > WIDE * allowed {
                *motion = Motion { moved: 0.0, allowed };
                nodes.iter().zip(before).for_each(|(&node, before)| *before = places[node as usize]);
                renew(POINTS * number..POINTS * (number + 1));
            }
            left = left.min(motion.allowed - motion.moved);
            *widest = widest.max(motion.allowed);
        }
        left
    }

    /// How far nodes may move from where they were when it was looked last (m), so that from there all that is allowed
    /// is within reach: what has moved so far may move back, too.
    pub fn stays(&self, place: usize) -> f64 {
        self.motions.get(place / POINTS).map_or(f64::INFINITY, |motion| motion.allowed + motion.moved)
    }
}

/// How far any two nodes have moved against each other (m), and a little more.
fn apart(places: &[DVec3], nodes: &[u32], before: &[DVec3]) -> f64 {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (&node, before) in nodes.iter().zip(before) {
        let moved = places[node as usize] - before;
        (low, high) = (low.min(moved), high.max(moved));
    }
    (high - low).length() * (1.0 + ROUNDING)
}

#[cfg(test)]
mod tests;
