//! Cholesky's factor of a dense symmetric matrix, inverted.

use crate::backend::cpu::Cpu;
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// What is left of a diagonal entry below this share of it is rounding: its unknown depends on those before.
const DEPENDENT: f64 = 1e-10;
/// Rows that threads share, and of which one thread takes so many side by side: what all need is read once for them.
const ROWS_OF_A_GROUP: usize = 32;
const SIDE_BY_SIDE: usize = 4;
/// Entries that make one task of a product.
const ENTRIES_OF_A_TASK: usize = 32_768;

/// G = L⁻¹ of a symmetric, positive semi-definite A = L Lᵀ, so that A⁻¹ = Gᵀ G: positive whatever rounds, and a product
/// goes through G once. What depends on the unknowns before it is left out (its solution is 0).
#[derive(Default)]
pub struct Cholesky {
    /// Rows of G up to the diagonal, one after the other.
    rows: Vec<f64>,
    size: usize,
    /// The rows of each task of a product, and what comes of them.
    tasks: Vec<Range<usize>>,
    parts: Vec<f64>,
}

/// Where a row begins.
fn start(row: usize) -> usize {
    row * (row + 1) / 2
}

impl Cholesky {
    /// Of a matrix given by its rows up to the diagonal, one after the other; the same for any number of threads.
    pub fn of(cpu: &Cpu, mut rows: Vec<f64>, size: usize) -> Self {
        // on the diagonal stands 1/Lᵢᵢ, or 0 of what is left out
        sweep(cpu, &mut rows, size, Sweep::Factor, |row, i| {
            let (others, diagonal) = row.split_at_mut(i);
            let left = diagonal[0] - dot(others, others);
            diagonal[0] = if left > DEPENDENT * diagonal[0] { 1.0 / left.sqrt() } else { 0.0 };
        });
        sweep(cpu, &mut rows, size, Sweep::Invert, |row, i| {
            let (others, diagonal) = row.split_at_mut(i);
            others.iter_mut().for_each(|entry| *entry *= -diagonal[0]);
        });
        let (mut tasks, mut first) = (Vec::new(), 0);
        for end in 1..=size {
            if end == size || start(end) - start(first) >= ENTRIES_OF_A_TASK {
                tasks.push(first..end);
                first = end;
            }
        }
        let parts = vec![0.0; tasks.len() * size];
        Self { rows, size, tasks, parts }
    }

    /// Its bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.rows[..]) + size_of_val(&self.parts[..])
    }

    /// A column of A⁻¹, which is a row of it.
    pub fn column(&self, unknown: usize) -> Vec<f64> {
        let mut column = vec![0.0; self.size];
        for row in unknown..self.size {
            let row = &self.rows[start(row)..start(row + 1)];
            add(&mut column, row[unknown], row);
        }
        column
    }

    /// x of A x = b, in the place of b; the same for any number of threads.
    pub fn solve(&mut self, cpu: &Cpu, b: &mut [f64]) {
        let (rows, given) = (&self.rows, &*b);
        let parts = self.parts.chunks_exact_mut(self.size.max(1)).zip(&self.tasks);
        cpu.for_each(parts, |(part, task)| {
            let of_task = &rows[start(task.start)..start(task.end)];
            cpu.dispatch(Product { rows: of_task, first: task.start, b: given, part });
        });
        b.fill(0.0);
        for (part, task) in self.parts.chunks_exact(self.size.max(1)).zip(&self.tasks) {
            b.iter_mut().zip(&part[..task.end]).for_each(|(b, part)| *b += part);
        }
    }
}

/// What becomes of rows by those before them.
#[derive(Clone, Copy)]
enum Sweep {
    /// Entries of A become those of L, from the left to the right.
    Factor,
    /// Entries of L before one become Σ Lᵢⱼ Gⱼ over the rows j before it.
    Invert,
}

/// Goes down all rows, and ends each when those before it are what they are to be. Of a group of rows all those before
/// the group are taken first, on all threads: what is done to a row is the same one after the other, whoever does it.
fn sweep(cpu: &Cpu, rows: &mut [f64], size: usize, what: Sweep, end: impl Fn(&mut [f64], usize)) {
    for first in (0..size).step_by(ROWS_OF_A_GROUP) {
        let last = size.min(first + ROWS_OF_A_GROUP);
        let (before, group) = rows.split_at_mut(start(first));
        let (mut parts, mut group) = (Vec::new(), &mut group[..start(last) - start(first)]);
        for row in (first..last).step_by(SIDE_BY_SIDE) {
            let part;
            (part, group) = group.split_at_mut(start(last.min(row + SIDE_BY_SIDE)) - start(row));
            parts.push((row, part));
        }
        let before = &*before;
        cpu.for_each(parts.into_iter(), |(row, part)| {
            cpu.dispatch(Step { rows: part, first: row, before, taken: 0..first, what })
        });
        for row in first..last {
            let (before, rest) = rows.split_at_mut(start(row));
            let part = &mut rest[..=row];
            cpu.dispatch(Step { rows: &mut *part, first: row, before, taken: first..row, what });
            end(part, row);
        }
    }
}

/// Rows from `first` on, which take those of a range before them.
struct Step<'a> {
    rows: &'a mut [f64],
    first: usize,
    before: &'a [f64],
    taken: Range<usize>,
    what: Sweep,
}

impl WithSimd for Step<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { rows, first, before, taken, what } = self;
        if rows.len() != start(first + SIDE_BY_SIDE) - start(first) {
            let (mut rest, mut row) = (rows, first);
            while !rest.is_empty() {
                let (one, others) = rest.split_at_mut(row + 1);
                for other in taken.start..taken.end {
                    take(what, [&mut *one], other, &before[start(other)..start(other + 1)]);
                }
                (rest, row) = (others, row + 1);
            }
            return;
        }
        let (a, rest) = rows.split_at_mut(first + 1);
        let (b, rest) = rest.split_at_mut(first + 2);
        let (c, d) = rest.split_at_mut(first + 3);
        for other in taken.start..taken.end {
            take(what, [&mut *a, &mut *b, &mut *c, &mut *d], other, &before[start(other)..start(other + 1)]);
        }
    }
}

/// Some rows take another one before them.
#[inline(always)]
fn take<const N: usize>(what: Sweep, rows: [&mut [f64]; N], number: usize, other: &[f64]) {
    match what {
        Sweep::Factor => {
            let sums = dots(&rows, &other[..number]);
            for (row, sum) in rows.into_iter().zip(sums) {
                row[number] = (row[number] - sum) * other[number];
            }
        }
        Sweep::Invert => {
            for row in rows {
                let factor = row[number];
                row[number] = 0.0;
                add(row, factor, other);
            }
        }
    }
}

/// Gᵀ G b of some rows of G.
struct Product<'a> {
    rows: &'a [f64],
    first: usize,
    b: &'a [f64],
    part: &'a mut [f64],
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { rows, first, b, part } = self;
        part.fill(0.0);
        let (mut rest, mut row) = (rows, first);
        while !rest.is_empty() {
            let (one, others) = rest.split_at(row + 1);
            add(part, dot(one, &b[..=row]), one);
            (rest, row) = (others, row + 1);
        }
    }
}

/// Adds so many times a row to the beginning of another.
#[inline(always)]
fn add(to: &mut [f64], times: f64, row: &[f64]) {
    for (to, entry) in to.iter_mut().zip(row) {
        *to += times * entry;
    }
}

#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    dots(&[a], b)[0]
}

/// Products of some rows, from their beginnings on, with another: of each eight sums side by side, which registers
/// hold, in a fixed order.
#[inline(always)]
fn dots<const N: usize, R: std::ops::Deref<Target = [f64]>>(rows: &[R; N], other: &[f64]) -> [f64; N] {
    let (chunks, rest) = other.as_chunks::<8>();
    let mut sums = [[0.0; 8]; N];
    for (place, other) in chunks.iter().enumerate() {
        for n in 0..N {
            let row = &rows[n][8 * place..8 * place + 8];
            for i in 0..8 {
                sums[n][i] += row[i] * other[i];
            }
        }
    }
    let mut all = [0.0; N];
    for n in 0..N {
        for i in 0..8 {
            all[n] += sums[n][i];
        }
        let mut last = 0.0;
        for i in 0..rest.len() {
            last += rows[n][8 * chunks.len() + i] * rest[i];
        }
        all[n] += last;
    }
    all
}

#[cfg(test)]
mod tests;
