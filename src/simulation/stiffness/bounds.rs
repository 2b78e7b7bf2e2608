//! What elements come to at rest: bounds of their frequencies, taken anew where mass is added or elements go.

use super::{Part, ROWS_A_PART, StiffnessTracker};
use crate::assembly::{square_frequencies, square_wave_frequencies};
use crate::components::*;
use crate::elements::node_count;
use crate::evaluation::rest_volume;
use crate::math::lane_place;
use crate::simulation::mass_scaling::scaled_mass;
use bevy_ecs::prelude::*;

/// Whether a node of an element can move by itself.
fn moves(world: &World, entity: Entity, row: usize) -> bool {
    let (Some(block), Some(connectivity)) = (world.get::<Block>(entity), world.get::<Connectivity>(entity)) else {
        return true;
    };
    let (corners, held) = (node_count(block.kind), world.get::<ConstrainedAxes>(block.body));
    let node = |corner: usize| connectivity[lane_place(row, corners, corner)] as usize;
    held.is_none_or(|held| (0..corners).any(|corner| held[node(corner)] & 7 != 7))
}

impl StiffnessTracker {
    /// Takes the bounds at rest anew, with the mass that was added by now.
    pub fn update_bounds(&mut self, world: &World) {
        let squares = square_frequencies(world, self.entity).into_iter().map(|(square, _)| square);
        let waves = square_wave_frequencies(world, self.entity);
        let mass_factor = |row: usize| scaled_mass(world, self.entity, row).map_or(1.0, |(_, mass_factor)| mass_factor);
        let of_row = |(row, (square, wave)): (usize, (f64, f64))| match moves(world, self.entity, row) {
            // no wave is quicker at rest than the bound of all that an element can do
            true => (square / mass_factor(row), wave.min(square) / mass_factor(row)),
            false => (0.0, 0.0),
        };
        (self.squares, self.waves) = squares.zip(waves).enumerate().map(of_row).unzip();
        self.sum_up(world);
    }

    /// What parts come to, of the elements that are there.
    pub(super) fn sum_up(&mut self, world: &World) {
        let (Some(block), Some(shape)) = (world.get::<Block>(self.entity), world.get::<RestShape>(self.entity)) else {
            return;
        };
        let is_there = |row: &usize| rest_volume(block, *row, shape) > 0.0;
        let count = self.squares.len();
        let of_part = |part: usize| {
            let rows = part * ROWS_A_PART..count.min((part + 1) * ROWS_A_PART);
            let rows = rows.filter(is_there).filter(|&row| self.squares[row] > 0.0);
            let nothing = Part { at_rest: 0.0, wave: 0.0, least_known: f64::INFINITY };
            rows.fold(nothing, |most, row| Part {
                at_rest: most.at_rest.max(self.squares[row]),
                wave: most.wave.max(self.waves[row]),
                least_known: most.least_known.min(f64::from(self.known_ratio[row])),
            })
        };
        self.parts = (0..count.div_ceil(ROWS_A_PART)).map(of_part).collect();
        self.counted = (0..count).filter(is_there).count();
    }
}
