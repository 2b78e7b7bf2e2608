//! How far what is around points has moved against itself, so that shortlists hold while bodies move as a whole.

use super::lists::Lists;
use super::surfaces::{Point, Surfaces};
use glam::DVec3;
use std::ops::Range;

/// Points of a neighbourhood, one after the other in the lists.
const POINTS: usize = 64;

/// What rounding takes of a distance at most, and more.
const ROUNDING: f64 = 1e-6;

/// Points that are beside each other in the lists, with all nodes that their shortlists depend on, where these were
/// when the shortlists were begun, and how far they may move against each other before they are begun anew.
#[derive(Clone, Debug, Default)]
pub struct Neighbourhoods {
    /// How many points there are.
    points: usize,
    /// Where each one's nodes begin, and where the last one's end.
    starts: Vec<u32>,
    nodes: Vec<u32>,
    /// Where these were (m).
    marks: Vec<DVec3>,
    /// How far any two of a neighbourhood had moved against each other when it was looked last, and may (m).
    moved: Vec<[f64; 2]>,
}

impl Neighbourhoods {
    /// Of points with lists: the nodes of points, of triangles in their lists, and of all triangles around these.
    pub fn of(surfaces: &Surfaces, points: &[Point], lists: &Lists) -> Self {
        let count = lists.points.len();
        let mut all = Self { points: count, starts: vec![0], ..Self::default() };
        // who has seen a node last
        let mut seen = vec![0; surfaces.nodes()];
        let mut ring = Vec::new();
        for (number, first) in (1..).step_by(2).zip((0..count).step_by(POINTS)) {
            ring.clear();
            let mut see = |node: u32, number: u32, to: &mut Vec<u32>| {
                if std::mem::replace(&mut seen[node as usize], number) != number {
                    to.push(node);
                }
            };
            for place in first..count.min(first + POINTS) {
                points[lists.points[place] as usize].parts().for_each(|(node, _)| see(node, number, &mut ring));
                let triangles = lists.triangles(place).iter();
                let corners = triangles.flat_map(|&triangle| surfaces.triangles[triangle as usize]);
                corners.for_each(|node| see(node, number, &mut ring));
            }
            let around = ring.iter().flat_map(|&node| surfaces.around(node));
            let corners = around.flat_map(|&triangle| surfaces.triangles[triangle as usize]);
            corners.for_each(|node| see(node, number + 1, &mut all.nodes));
            all.starts.push(all.nodes.len() as u32);
        }
        all.marks = vec![DVec3::NAN; all.nodes.len()];
        all.moved = vec![[f64::INFINITY; 2]; all.starts.len() - 1];
        all
    }

    /// Bytes that they take.
    pub fn bytes(&self) -> usize {
        let of_nodes = size_of_val(&self.nodes[..]) + size_of_val(&self.marks[..]);
        of_nodes + size_of_val(&self.starts[..]) + size_of_val(&self.moved[..])
    }

    /// Looks how far nodes have moved that are at such places (m) now. Where they may come too far before it is looked
    /// again, by which they may move another `next` (m), shortlists are begun anew for as much as `most` (m): the
    /// ranges of their points in the lists are handed out.
    pub fn look(&mut self, places: &[DVec3], [next, most]: [f64; 2], mut anew: impl FnMut(Range<usize>)) {
        for (number, moved) in self.moved.iter_mut().enumerate() {
            let nodes = self.starts[number] as usize..self.starts[number + 1] as usize;
            let (nodes, marks) = (&self.nodes[nodes.clone()], &mut self.marks[nodes]);
            let (mut low, mut high, mut all) = (DVec3::INFINITY, DVec3::NEG_INFINITY, DVec3::ZERO);
            for (&node, mark) in nodes.iter().zip(&*marks) {
                let by = places[node as usize] - *mark;
                (low, high, all) = (low.min(by), high.max(by), all + by);
            }
            moved[0] = (high - low).length() * (1.0 + ROUNDING);
            // what is no number is too far: it is in no least and no largest
            if moved[0] + next <= moved[1] && all.is_finite() {
                continue;
            }
            nodes.iter().zip(marks).for_each(|(&node, mark)| *mark = places[node as usize]);
            *moved = [0.0, most];
            let first = POINTS * number;
            anew(first..self.points.min(first + POINTS));
        }
    }

    /// Of the point of a place in the lists: how far nodes around it had moved against each other when it was looked
    /// last, and may (m).
    pub fn moved(&self, place: usize) -> [f64; 2] {
        self.moved[place / POINTS]
    }
}

#[cfg(test)]
mod tests;
