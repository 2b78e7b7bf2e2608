//! Pairs of a point and a triangle: where triangles are nearest, several found side by side in registers.

use crate::backend::cpu::Cpu;
use crate::math::{Nearest, OnTriangle, SimdScalar};
use glam::DVec3;
use pulp::{Simd, WithSimd};

/// Pairs whose numbers are kept side by side; registers divide it.
const SIDE_BY_SIDE: usize = 8;

/// The numbers of some pairs.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
struct Numbers([f64; SIDE_BY_SIDE]);

/// Some pairs.
#[derive(Clone, Debug, Default)]
struct Block {
    /// Along each axis, of the point and of the corners (m).
    places: [[Numbers; 3]; 4],
    /// Where they are nearest ([`Nearest`]).
    at: [Numbers; 3],
    weights: [Numbers; 3],
    normal: [Numbers; 3],
    part: Numbers,
    distance: Numbers,
    gap: Numbers,
}

/// Pairs, and where they are nearest; what has been is written over.
#[derive(Clone, Debug, Default)]
pub struct Pairs {
    blocks: Vec<Block>,
    count: usize,
}

impl Pairs {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds a place and the corners of a triangle (m).
    #[inline]
    pub fn add(&mut self, place: DVec3, [a, b, c]: [DVec3; 3]) {
        let (block, lane) = (self.count / SIDE_BY_SIDE, self.count % SIDE_BY_SIDE);
        if block == self.blocks.len() {
            self.blocks.push(Block::default());
        }
        let [of_place, of_a, of_b, of_c] = &mut self.blocks[block].places;
        put(of_place, lane, place);
        put(of_a, lane, a);
        put(of_b, lane, b);
        put(of_c, lane, c);
        self.count += 1;
    }

    /// Finds where all are nearest.
    pub fn find(&mut self, cpu: &Cpu) {
        cpu.dispatch_widest(Find { blocks: &mut self.blocks[..self.count.div_ceil(SIDE_BY_SIDE)] });
    }

    /// Where the point is (m).
    #[inline]
    pub(super) fn place(&self, pair: usize) -> DVec3 {
        let ([x, y, z], lane) = (&self.blocks[pair / SIDE_BY_SIDE].places[0], pair % SIDE_BY_SIDE);
        DVec3::new(x.0[lane], y.0[lane], z.0[lane])
    }

    /// How far a point is from its triangle (m), and the part on which it is nearest.
    #[inline]
    pub(super) fn distance(&self, pair: usize) -> (f64, f64) {
        let (block, lane) = (&self.blocks[pair / SIDE_BY_SIDE], pair % SIDE_BY_SIDE);
        (block.distance.0[lane], block.part.0[lane])
    }

    /// Where its triangle is nearest, the unit normal of that (no number of one without area), and how far the point is
    /// along it (m).
    #[inline]
    pub(super) fn nearest(&self, pair: usize) -> (OnTriangle, DVec3, f64) {
        let (block, lane) = (&self.blocks[pair / SIDE_BY_SIDE], pair % SIDE_BY_SIDE);
        let vector = |[x, y, z]: &[Numbers; 3]| [x.0[lane], y.0[lane], z.0[lane]];
        let (at, weights, part) = (vector(&block.at).into(), vector(&block.weights), block.part.0[lane] as usize);
        (OnTriangle { at, weights, part }, vector(&block.normal).into(), block.gap.0[lane])
    }
}

#[inline]
fn put([x, y, z]: &mut [Numbers; 3], lane: usize, at: DVec3) {
    (x.0[lane], y.0[lane], z.0[lane]) = (at.x, at.y, at.z);
}

/// The task of finding where pairs are nearest.
struct Find<'a> {
    blocks: &'a mut [Block],
}

impl WithSimd for Find<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for block in self.blocks {
            let mut first = 0;
            while first < SIDE_BY_SIDE {
                find_some(simd, block, first);
                first += f64::width::<S>();
            }
        }
    }
}

/// Finds where a register full of pairs is nearest, from one on.
#[inline(always)]
fn find_some<S: Simd>(simd: S, block: &mut Block, first: usize) {
    let [y, a, b, c] = &block.places;
    let y = [load(simd, &y[0], first), load(simd, &y[1], first), load(simd, &y[2], first)];
    let a = [load(simd, &a[0], first), load(simd, &a[1], first), load(simd, &a[2], first)];
    let b = [load(simd, &b[0], first), load(simd, &b[1], first), load(simd, &b[2], first)];
    let c = [load(simd, &c[0], first), load(simd, &c[1], first), load(simd, &c[2], first)];
    let found = Nearest::of(y, [a, b, c]);
    for axis in 0..3 {
        f64::store(found.at[axis], &mut block.at[axis].0[first..]);
        f64::store(found.weights[axis], &mut block.weights[axis].0[first..]);
        f64::store(found.normal[axis], &mut block.normal[axis].0[first..]);
    }
    f64::store(found.part, &mut block.part.0[first..]);
    f64::store(found.distance, &mut block.distance.0[first..]);
    f64::store(found.gap, &mut block.gap.0[first..]);
}

#[inline(always)]
fn load<S: Simd>(simd: S, numbers: &Numbers, first: usize) -> <f64 as SimdScalar>::Vector<S> {
    f64::load(simd, &numbers.0[first..])
}
