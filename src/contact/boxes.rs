//! A tree of boxes over triangles that deform: its shape is made once, its boxes follow.

use glam::DVec3;
use std::ops::Range;

/// Triangles in a leaf.
const LEAF: usize = 4;

/// Bits of a Morton number along each axis.
const BITS: u32 = 21;

#[derive(Clone, Copy, Debug)]
struct Box3 {
    low: DVec3,
    high: DVec3,
}

impl Box3 {
    const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    fn join(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }
}

/// Triangles in the order of their Morton numbers, and a binary tree over leaves of some of them: box i has the boxes
/// 2i and 2i + 1, the first is number 1.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    /// Their numbers.
    order: Vec<u32>,
    boxes: Vec<Box3>,
}

impl Tree {
    /// Of triangles of these numbers, whose corners are at these places now.
    pub fn new(numbers: Range<u32>, corners: impl Fn(u32) -> [DVec3; 3]) -> Self {
        let count = numbers.len();
        let middle = |triangle: u32| corners(triangle).into_iter().sum::<DVec3>() / 3.0;
        let all = numbers.clone().map(middle).fold(Box3::EMPTY, |all, at| all.join(Box3 { low: at, high: at }));
        let size = (all.high - all.low).max_element().max(f64::MIN_POSITIVE);
        let number = |triangle: u32| {
            let at = (middle(triangle) - all.low) / size * f64::from((1_u32 << BITS) - 1);
            at.to_array().iter().enumerate().fold(0_u64, |sum, (axis, &place)| sum | spread(place as u64) << axis)
        };
        let mut keyed: Vec<(u64, u32)> = numbers.map(|triangle| (number(triangle), triangle)).collect();
        keyed.sort_unstable();
        let order = keyed.into_iter().map(|(_, triangle)| triangle).collect();
        let leaves = count.div_ceil(LEAF).next_power_of_two();
        let mut tree = Self { order, boxes: vec![Box3::EMPTY; 2 * leaves] };
        tree.refit(corners);
        tree
    }

    /// Puts the boxes around where the corners are now.
    pub fn refit(&mut self, corners: impl Fn(u32) -> [DVec3; 3]) {
        let leaves = self.boxes.len() / 2;
        for (leaf, triangles) in self.order.chunks(LEAF).enumerate() {
            let places = triangles.iter().flat_map(|&triangle| corners(triangle));
            self.boxes[leaves + leaf] =
                places.fold(Box3::EMPTY, |all, at| Box3 { low: all.low.min(at), high: all.high.max(at) });
        }
        for place in (1..leaves).rev() {
            self.boxes[place] = self.boxes[2 * place].join(self.boxes[2 * place + 1]);
        }
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.order[..]) + size_of_val(&self.boxes[..])
    }

    /// How far its box is from that of another (m).
    pub fn distance(&self, other: &Self) -> f64 {
        match (self.boxes.get(1), other.boxes.get(1)) {
            (Some(a), Some(b)) => (a.low - b.high).max(b.low - a.high).max(DVec3::ZERO).length(),
            _ => f64::INFINITY,
        }
    }

    /// Sees the triangles of all leaves whose boxes are no farther from a place than `radius` (m).
    pub fn near(&self, at: DVec3, radius: f64, mut see: impl FnMut(u32)) {
        let leaves = self.boxes.len() / 2;
        let is_near = |place: usize| {
            let Box3 { low, high } = &self.boxes[place];
            // an empty box is nowhere; `clamp` would have it the wrong way round
            (*low - at).max(at - *high).max(DVec3::ZERO).length_squared() <= radius * radius
        };
        // twice the depth of a tree of 2³² triangles
        let mut waiting = [0_usize; 64];
        let mut count = 0;
        if leaves > 0 {
            (waiting[0], count) = (1, 1);
        }
        while count > 0 {
            count -= 1;
            let place = waiting[count];
            if !is_near(place) {
                continue;
            }
            if place >= leaves {
                // the last leaves may be empty, and are no farther than what is infinite
                let own = self.order.chunks(LEAF).nth(place - leaves);
                own.into_iter().flatten().for_each(|&triangle| see(triangle));
                continue;
            }
            waiting[count] = 2 * place + 1;
            waiting[count + 1] = 2 * place;
            count += 2;
        }
    }
}

/// The bits of a number, two places between each.
fn spread(number: u64) -> u64 {
    let mut bits = number & 0x1f_ffff;
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        bits = (bits | bits << shift) & mask;
    }
    bits
}

#[cfg(test)]
mod tests;
