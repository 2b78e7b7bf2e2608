//! How large the terms are that make an element's forces: what rounding is in proportion to.

use bevy_ecs::prelude::*;
use sinew::components::*;
use sinew::evaluation::{ElementState, lane_place, node_count, row_count};

/// Σ|tᵢ| of the forces on an element's corners and of its stress. With ∇u = h, stresses are sums of moduli times strains
/// h + hᵀ + hᵀh, times C⁻¹ and powers of J; rounding of O(1) intermediate values (C, J) counts with the moduli times
/// |h|, that of strains likewise. A force is V P g, in the hexahedron plus k q.
pub struct Magnitude {
    pub stress: f64,
    pub force: f64,
}

pub fn magnitude(world: &World, block: Entity, row: usize) -> Magnitude {
    let data = world.get::<Block>(block).unwrap();
    let shape = world.get::<RestShape>(block).unwrap();
    let displacement = world.get::<Displacement>(data.body).unwrap();
    let law = world.get::<sinew::backend::cpu::BlockLaw<f64>>(block).unwrap();
    let state = ElementState::of(data.kind, row, world.get::<Connectivity>(block).unwrap(), shape, displacement);
    let h = state.gradient.0.iter().flatten().map(|x| x.abs()).fold(0.0, f64::max);
    let number = |k: usize| shape.get(lane_place(row, row_count(data.kind), k));
    let nodes = node_count(data.kind);
    let gradients: f64 = (0..3 * (nodes - 1)).map(|k| number(k).abs()).fold(0.0, f64::max);
    let spread = state.displacements[..nodes].iter().flatten().map(|x| x.abs()).fold(0.0, f64::max);
    // terms of h itself cancel: a gradient is a sum of seven products at most
    let h = h.max(spread * gradients);
    let eta = law.fibres.as_ref().map_or(0.0, |(fibres, _)| fibres.eta);
    let moduli = 2.0 * law.neo_hookean.shear + law.neo_hookean.bulk + 2.0 * eta;
    let compressed = state.kinematics.j.min(1.0);
    let memory = world.get::<ViscousMemory>(block).map_or(0.0, |_| 400.0);
    let stress = moduli * h * (1.0 + h).powi(4) / compressed.powi(3) + memory;
    let hourglass = if nodes == 8 {
        // q is a sum of eight displacements, and folded back along the element's arms with its gradients
        number(22) * 8.0 * spread * 8.0
    } else {
        0.0
    };
    Magnitude { stress, force: state.volume * stress * (1.0 + h) * gradients * nodes as f64 + hourglass }
}

/// The longest way from displacements to a corner's force: a gradient (8 roundings), strains and J (8), a cube root (10),
/// two laws (20), viscosity (8), F S (6), a force and the sum of all (16).
pub const ROUNDINGS: f64 = 76.0;
