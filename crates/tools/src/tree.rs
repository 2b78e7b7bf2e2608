//! The nearest triangle of many, by a tree of boxes.

use glam::DVec3;
use sinew_mesh::OnTriangle;

/// Triangles in a leaf.
const LEAF: usize = 4;

struct Branch {
    low: DVec3,
    high: DVec3,
    /// Of a leaf its first triangle, else the second of the two branches, of which the first follows this one.
    next: u32,
    /// Triangles of a leaf; 0 of what is none.
    count: u32,
}

/// How much farther than the nearest may be (relative) what is taken for it where that need not be exact.
pub const SLACK: f64 = 2e-3;

/// A tree over triangles.
pub struct Tree {
    branches: Vec<Branch>,
    /// In the order of leaves.
    corners: Vec<[DVec3; 3]>,
    /// Their numbers.
    numbers: Vec<u32>,
}

/// What is nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The square of the distance (m²).
    pub square: f64,
    /// The place of the triangle in the tree.
    place: u32,
    /// Which part of it: see [`OnTriangle::part`].
    pub part: usize,
    /// The place (m).
    pub at: DVec3,
}

impl Tree {
    /// Of the triangles in the list, by their numbers.
    pub fn new(corners: impl Fn(u32) -> [DVec3; 3], mut triangles: Vec<u32>) -> Self {
        let mut tree = Self { branches: Vec::new(), corners: Vec::new(), numbers: Vec::new() };
        tree.grow(&corners, &mut triangles);
        tree
    }

    fn grow(&mut self, corners: &impl Fn(u32) -> [DVec3; 3], triangles: &mut [u32]) {
        // the sum of a triangle's corners stands for its middle
        let middle_of = |triangle: u32| corners(triangle).into_iter().sum::<DVec3>();
        let [low, high] = bounds(triangles.iter().flat_map(|&triangle| corners(triangle)));
        let own = self.branches.len();
        let first = self.numbers.len() as u32;
        if triangles.len() <= LEAF {
            self.branches.push(Branch { low, high, next: first, count: triangles.len() as u32 });
            self.corners.extend(triangles.iter().map(|&triangle| corners(triangle)));
            self.numbers.extend_from_slice(triangles);
            return;
        }
        self.branches.push(Branch { low, high, next: 0, count: 0 });
        let [least, most] = bounds(triangles.iter().map(|&triangle| middle_of(triangle)));
        let axis = (most - least).max_position();
        let place = |triangle: u32| middle_of(triangle)[axis];
        let middle = triangles.len() / 2;
        triangles.select_nth_unstable_by(middle, |&a, &b| place(a).total_cmp(&place(b)).then(a.cmp(&b)));
        let (less, more) = triangles.split_at_mut(middle);
        self.grow(corners, less);
        self.branches[own].next = self.branches.len() as u32;
        self.grow(corners, more);
    }

    /// What is nearest to a place; a triangle that may be near (what was nearest to a place beside this one) saves
    /// time. Of those farther than `exact` (m) one that is no more than [`SLACK`] of its distance farther is as good.
    /// None of no triangles.
    pub fn nearest(&self, y: DVec3, near: Option<Nearest>, exact: f64) -> Option<Nearest> {
        let found = |place: u32| {
            let OnTriangle { at, part, .. } = OnTriangle::nearest(y, self.corners[place as usize]);
            Nearest { square: y.distance_squared(at), place, part, at }
        };
        let mut best = found(near.map_or(0, |near| near.place).min(self.numbers.len().checked_sub(1)? as u32));
        let beyond = |branch: u32| {
            let branch = &self.branches[branch as usize];
            (y - y.clamp(branch.low, branch.high)).length_squared()
        };
        let enough =
            |best: Nearest| best.square * if best.square > exact * exact { (1.0 - SLACK).powi(2) } else { 1.0 };
        let mut bound = enough(best);
        // twice the depth of a tree of 2³² triangles, and more
        let mut waiting = [(0u32, 0.0f64); 80];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (row, square) = waiting[count];
            if square > bound {
                continue;
            }
            let branch = &self.branches[row as usize];
            if branch.count == 0 {
                let children = [row + 1, branch.next].map(|child| (child, beyond(child)));
                // the nearer one comes off first
                let [near, far] = if children[0].1 <= children[1].1 { children } else { [children[1], children[0]] };
                waiting[count] = far;
                waiting[count + 1] = near;
                count += 2;
                continue;
            }
            for place in branch.next..branch.next + branch.count {
                let found = found(place);
                if (found.square, place) < (best.square, best.place) {
                    best = found;
                    bound = enough(best);
                }
            }
        }
        Some(best)
    }

    /// The number of a triangle that was found.
    pub fn number(&self, found: Nearest) -> usize {
        self.numbers[found.place as usize] as usize
    }
}

fn bounds(places: impl Iterator<Item = DVec3>) -> [DVec3; 2] {
    places.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
}
