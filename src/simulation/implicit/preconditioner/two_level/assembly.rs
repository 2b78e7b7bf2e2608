//! Pᵀ K P of all pieces, of columns of the stiffness of elements.

use super::super::columns::Columns;
use super::aggregates::{RIGID, motions};
use super::coarse::{Coarse, start};
use crate::backend::cpu::Cpu;
use crate::elements::MOST_NODES;
use glam::DVec3;

/// Aggregates whose columns of a matrix are one task.
const AGGREGATES_OF_A_TASK: usize = 8;
/// The aggregate of a node that does not move.
const NONE: usize = usize::MAX;

/// Where a node of all bodies stands.
#[derive(Clone, Copy)]
struct Standing {
    /// Its aggregate among those of its piece, and its arm there.
    aggregate: usize,
    arm: DVec3,
    /// The task that its column belongs to.
    task: usize,
    free: [bool; 3],
}

/// What fills in the matrices of pieces.
pub struct Assembly {
    standings: Vec<Standing>,
    /// Of each task the elements whose displaced corner is its own.
    rows: Vec<Vec<u32>>,
}

/// Some columns of a matrix: those of aggregates from `first` on.
struct Task<'a> {
    first: usize,
    size: usize,
    columns: &'a mut [f64],
}

impl Assembly {
    /// Of some pieces, whose nodes are among those of all bodies.
    pub fn of<'a>(pieces: impl Iterator<Item = &'a Coarse>, free: &[bool]) -> Self {
        let fixed = Standing { aggregate: NONE, arm: DVec3::ZERO, task: 0, free: [false; 3] };
        let (mut standings, mut tasks) = (vec![fixed; free.len() / 3], 0);
        for piece in pieces {
            for (node, aggregate, arm) in piece.members() {
                let task = tasks + aggregate / AGGREGATES_OF_A_TASK;
                let free = [0, 1, 2].map(|axis| free[3 * node + axis]);
                standings[node] = Standing { aggregate, arm, task, free };
            }
            tasks += piece.aggregates.count().div_ceil(AGGREGATES_OF_A_TASK);
        }
        Self { standings, rows: vec![Vec::new(); tasks] }
    }

    /// Adds a column of all elements of a block: a task each for some columns of the matrices, whatever the number of
    /// threads.
    pub fn add<'a>(&mut self, cpu: &Cpu, columns: &Columns<'_>, pieces: impl Iterator<Item = &'a mut Coarse>) {
        if columns.axis == 0 {
            self.sort(columns);
        }
        let standings = &self.standings[..];
        let tasks = pieces.flat_map(tasks_of).zip(&self.rows).filter(|(_, rows)| !rows.is_empty());
        cpu.for_each(tasks.collect::<Vec<_>>().into_iter(), |(mut task, rows)| {
            rows.iter().for_each(|&row| task.add(columns, row as usize, standings));
        });
    }

    /// Deals the elements to tasks, by the corner that is displaced. What is in one aggregate as a whole is left out:
    /// no rigid motion of its corners makes a force.
    fn sort(&mut self, columns: &Columns<'_>) {
        self.rows.iter_mut().for_each(Vec::clear);
        for row in columns.rows() {
            let standing = |corner: usize| &self.standings[columns.node(row, corner)];
            let own = standing(columns.corner);
            let is_inside = |other: &Standing| other.aggregate == own.aggregate && other.free == [true; 3];
            if own.aggregate != NONE && !(0..columns.corners).all(|corner| is_inside(standing(corner))) {
                self.rows[own.task].push(row as u32);
            }
        }
    }
}

/// The columns of a piece's matrix, dealt to tasks.
fn tasks_of(piece: &mut Coarse) -> Vec<Task<'_>> {
    let (size, count) = (piece.size(), piece.aggregates.count());
    let (mut rest, mut tasks) = (&mut piece.stiffness[..], Vec::new());
    for first in (0..count).step_by(AGGREGATES_OF_A_TASK) {
        let end = count.min(first + AGGREGATES_OF_A_TASK);
        let columns;
        (columns, rest) = rest.split_at_mut(start(RIGID * end, size) - start(RIGID * first, size));
        tasks.push(Task { first, size, columns });
    }
    tasks
}

impl Task<'_> {
    /// Adds what a column of an element is to the rigid motions of its corners. Each pair of aggregates comes by twice;
    /// it is taken where the displaced corner is in the first of them.
    fn add(&mut self, columns: &Columns<'_>, row: usize, standings: &[Standing]) {
        let own = &standings[columns.node(row, columns.corner)];
        if !own.free[columns.axis] {
            return;
        }
        // forces on the aggregates of its corners
        let (mut forces, mut count) = ([(0, [0.0; RIGID]); MOST_NODES], 0);
        for corner in 0..columns.corners {
            let other = &standings[columns.node(row, corner)];
            if other.aggregate == NONE || other.aggregate < own.aggregate {
                continue;
            }
            let mut force = columns.force(row, corner);
            (0..3).filter(|&axis| !other.free[axis]).for_each(|axis| force[axis] = 0.0);
            let turn = other.arm.cross(force);
            let known = forces[..count].iter().position(|&(aggregate, _)| aggregate == other.aggregate);
            let place = known.unwrap_or(count);
            count = count.max(place + 1);
            forces[place].0 = other.aggregate;
            let sums = &mut forces[place].1;
            for i in 0..3 {
                sums[i] += force[i];
                sums[3 + i] += turn[i];
            }
        }
        let motion = motions(own.arm, columns.axis);
        for (aggregate, force) in &forces[..count] {
            for (j, way) in motion.iter().enumerate().filter(|(_, way)| **way != 0.0) {
                if *aggregate > own.aggregate {
                    let place = self.place(RIGID * own.aggregate + j, RIGID * aggregate);
                    let column = &mut self.columns[place..place + RIGID];
                    column.iter_mut().zip(force).for_each(|(entry, force)| *entry += force * way);
                    continue;
                }
                for (i, force) in force.iter().enumerate() {
                    // of one aggregate both halves of the matrix come by
                    let share = if i == j { 1.0 } else { 0.5 };
                    let first = RIGID * own.aggregate;
                    let place = self.place(first + i.min(j), first + i.max(j));
                    self.columns[place] += share * force * way;
                }
            }
        }
    }

    /// Where an entry of a column is.
    fn place(&self, column: usize, row: usize) -> usize {
        start(column, self.size) - start(RIGID * self.first, self.size) + row - column
    }
}
