//! Groups of neighbouring nodes that move rigidly together: the coarse level's unknowns.

use glam::DVec3;
use std::ops::Range;

/// Rigid motions of an aggregate.
pub const RIGID: usize = 6;

/// Which aggregate each of some nodes is in, and where.
#[derive(Default)]
pub struct Aggregates {
    /// Of each node, until they are sorted.
    pub of_node: Vec<u32>,
    /// From the middle of its aggregate to each node, over the aggregate's extent.
    pub arm: Vec<DVec3>,
    /// Aggregates of how many nodes each.
    pub sizes: Vec<usize>,
    /// Once they are [sorted](Self::sort), where the nodes of each are.
    pub ranges: Vec<Range<usize>>,
}

impl Aggregates {
    /// Halves at the median of the longest extent until no group has more than `most` nodes: the same for the same
    /// positions (m).
    pub fn within(positions: &[DVec3], most: usize) -> Self {
        let mut new =
            Self { of_node: vec![0; positions.len()], arm: vec![DVec3::ZERO; positions.len()], ..Self::default() };
        let mut waiting = vec![(0..positions.len()).collect::<Vec<usize>>()];
        while let Some(mut nodes) = waiting.pop() {
            let (least, greatest) =
                nodes.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(least, greatest), &node| {
                    (least.min(positions[node]), greatest.max(positions[node]))
                });
            let extent = greatest - least;
            if nodes.len() > most {
                let axis = extent.max_position();
                nodes.sort_by(|&a, &b| positions[a][axis].total_cmp(&positions[b][axis]).then(a.cmp(&b)));
                let upper = nodes.split_off(nodes.len() / 2);
                waiting.extend([upper, nodes]);
            } else if !nodes.is_empty() {
                let middle = nodes.iter().map(|&node| positions[node]).sum::<DVec3>() / nodes.len() as f64;
                let length = extent.max_element().max(f64::MIN_POSITIVE);
                for &node in &nodes {
                    (new.of_node[node], new.arm[node]) = (new.sizes.len() as u32, (positions[node] - middle) / length);
                }
                new.sizes.push(nodes.len());
            }
        }
        new
    }

    /// Sorts nodes by their aggregates, else as they were; gives where each was.
    pub fn sort(&mut self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.of_node.len()).collect();
        order.sort_by_key(|&node| self.of_node[node]);
        self.of_node = Vec::new();
        self.arm = order.iter().map(|&node| self.arm[node]).collect();
        let mut end = 0;
        let range = |size: &usize| {
            end += size;
            end - size..end
        };
        self.ranges = self.sizes.iter().map(range).collect();
        order
    }

    /// The aggregate of a node of those that are sorted.
    pub fn of(&self, own: usize) -> usize {
        self.ranges.partition_point(|range| range.end <= own)
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.sizes.len()
    }

    /// Their bytes.
    pub fn bytes(&self) -> usize {
        let of_aggregates = size_of_val(&self.sizes[..]) + size_of_val(&self.ranges[..]);
        size_of_val(&self.of_node[..]) + size_of_val(&self.arm[..]) + of_aggregates
    }
}

/// How far a node moves along an axis with each rigid motion of its aggregate: three translations, and e × arm.
pub fn motions(arm: DVec3, axis: usize) -> [f64; RIGID] {
    let mut motions = [0.0; RIGID];
    motions[axis] = 1.0;
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    (motions[3 + next], motions[3 + last]) = (arm[last], -arm[next]);
    motions
}

#[cfg(test)]
mod tests;
