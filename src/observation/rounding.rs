//! What rounding alone makes of energies: what the guards must not take for an imbalance.

use crate::backend::cpu::BlockLaw;
use crate::components::*;
use crate::elements::node_count;
use crate::evaluation::rest_volume;
use crate::materials::{Elastic, ElasticLaw};
use crate::math::lane_place;
use bevy_ecs::prelude::*;

/// Strains that f32 knows to a twentieth of their energy: volume changes cancel in it to eps/ε.
const KNOWN_STRAIN: f64 = 1e-6;

/// What rounding makes of the energies of a scene's bodies. A resource, made before the first step.
///
/// A displacement of the size u is known to u·eps/2, so a strain over an edge h to u·eps/h, and a stress to M u·eps/h,
/// M being the modulus of compression without lateral strain, κ + 4μ/3. Over a path along which displacement gradients
/// change by as much as one, work against that stress is M V u·eps/h: that much energy may be made or lost of nothing.
/// In f32 nothing is known, too, of strains below `KNOWN_STRAIN`.
#[derive(Resource, Clone, Debug, Default)]
pub struct Rounding {
    /// Of each body, energy a displacement (J/m).
    of_bodies: Vec<(Entity, f64)>,
    /// Energy at strains that are not known (J).
    least: f64,
}

impl Rounding {
    /// Of all bodies at rest.
    pub fn of(world: &mut World) -> Self {
        let mut rounding = Self::default();
        for (block, shape, law, connectivity) in
            world.query::<(&Block, &RestShape, &BlockLaw<f64>, &Connectivity)>().iter(world)
        {
            let Some(rest) = world.get::<RestPosition>(block.body) else { continue };
            let (digit, known) = match shape.0 {
                Reals::F32(_) => (f64::from(f32::EPSILON), KNOWN_STRAIN),
                Reals::F64(_) => (f64::EPSILON, 0.0),
            };
            let stiffness = |elastic: &ElasticLaw<f64>| {
                let [shear, bulk] = elastic.small_strain_moduli();
                bulk + 4.0 / 3.0 * shear
            };
            let of_copies = law.copies.iter().flat_map(|copies| &copies.of_copy).map(|of| stiffness(&of.elastic));
            let stiffest = of_copies.reduce(f64::max).unwrap_or_else(|| stiffness(&law.elastic));
            let volume = (0..block.count).map(|row| rest_volume(block, row, shape)).sum::<f64>();
            let energy = stiffest * volume;
            rounding.least += 0.5 * energy * known * known;
            let a_metre = energy * digit / shortest_edge(block, connectivity, rest);
            rounding.of_bodies.push((block.body, a_metre));
        }
        rounding
    }

    /// Energy (J) that rounding may have made or lost, where bodies are displaced by so much (m) at most.
    pub fn of_energy(&self, reach: &[(Entity, f64)]) -> f64 {
        let of_body = |(body, a_metre): &(Entity, f64)| {
            let reached = reach.iter().find(|(of, _)| of == body);
            reached.map_or(0.0, |(_, displacement)| a_metre * displacement)
        };
        self.least + self.of_bodies.iter().map(of_body).sum::<f64>()
    }
}

/// The shortest distance between two nodes of an element of a block at rest (m).
pub fn shortest_edge(block: &Block, connectivity: &Connectivity, rest: &RestPosition) -> f64 {
    let nodes = node_count(block.kind);
    let place = |row: usize, a: usize| rest.0[connectivity[lane_place(row, nodes, a)] as usize];
    let pairs = (1..nodes).flat_map(|a| (0..a).map(move |b| (a, b)));
    let of_element = |row: usize| {
        pairs.clone().fold(f64::INFINITY, |least, (a, b)| least.min(place(row, a).distance_squared(place(row, b))))
    };
    (0..block.count).map(of_element).fold(f64::INFINITY, f64::min).sqrt()
}
