//! Columns filled with noise.

use bevy_ecs::prelude::*;
use sinew::components::*;

/// A small generator of numbers between −1 and 1, the same everywhere.
pub struct Noise(pub u64);

impl Noise {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn fill(&mut self, column: &mut Reals, amplitude: f64) {
        (0..column.len()).for_each(|i| column.set(i, amplitude * self.next()));
    }
}

/// Numbers of a body's element forces in the scheme of two passes.
fn two_pass_length(world: &World, body: Entity) -> usize {
    let blocks = world.get::<Authoring>(body).unwrap().blocks.iter().map(|&block| world.get::<Block>(block).unwrap());
    blocks.map(|block| block.count.div_ceil(16) * 16 * 3 * sinew::elements::node_count(block.kind)).sum()
}

/// Fills every column that changes with noise: displacements of a tenth of an element, plausible forces and histories.
pub fn randomize(world: &mut World, seed: u64) {
    let mut noise = Noise(seed);
    // a common order of entities, whatever order the query has
    let mut entities: Vec<Entity> = world.query::<EntityRef>().iter(world).map(|e| e.id()).collect();
    entities.sort();
    const SPACING: f64 = 0.1 / 6.0;
    for entity in entities {
        macro_rules! fill {
            ($($column:ty: $amplitude:expr),*) => {$(
                if let Some(mut column) = world.get_mut::<$column>(entity) {
                    noise.fill(&mut column.0, $amplitude);
                }
            )*};
        }
        fill!(
            Displacement: 0.1 * SPACING, DisplacementIncrement: 1e-5, DisplacementCompensation: 1e-11,
            InternalForce: 0.01, ExternalForce: 0.01
        );
        // whose length depends on the scheme: all else is the same in both
        if let Some(mut column) = world.get_mut::<ElementForce>(entity) {
            Noise(noise.0).fill(&mut column.0, 0.01);
            (0..two_pass_length(world, entity)).for_each(|_| _ = noise.next());
        }
        fill!(ViscousMemory: 200.0, Work: 1e-6, ElementVolume: 1e-6, NodalVolumeChange: 0.05);
        // inactive nodes, and axes held without a load
        if let Some(mut mass) = world.get_mut::<Mass>(entity) {
            mass.set(3, 0.0);
        }
        if let Some(mut mass) = world.get_mut::<InertialMass>(entity) {
            mass.set(3, 0.0);
        }
        if let Some(mut axes) = world.get_mut::<ConstrainedAxes>(entity) {
            axes[5] |= 2;
        }
    }
}

/// A thousandth of the displacements that noise has made: strains of about 1e-4.
pub fn small_strains(world: &mut World) {
    scale_strains(world, 1e-3);
}

/// So many times the displacements that noise has made.
pub fn scale_strains(world: &mut World, factor: f64) {
    let mut entities = world.query::<Entity>();
    for entity in entities.iter(world).collect::<Vec<_>>() {
        macro_rules! scale {
            ($($column:ty),*) => {$(
                if let Some(mut column) = world.get_mut::<$column>(entity) {
                    (0..column.len()).for_each(|i| {
                        let value = column.get(i);
                        column.set(i, factor * value);
                    });
                }
            )*};
        }
        scale!(Displacement, NodalVolumeChange);
    }
}
