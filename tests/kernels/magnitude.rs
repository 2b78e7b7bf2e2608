//! How large the terms are that make an element's forces: what rounding is in proportion to.

use bevy_ecs::prelude::*;
use sinew::components::*;
use sinew::elements::{Element, Hex8, Hex8MeanDilatation, MOST_NODES, Parallelepiped, Tet10, Wedge6, node_count};
use sinew::evaluation::{ElementState, row_count};
use sinew::materials::Elastic;
use sinew::math::lane_place;
use sinew::mesh::ElementKind;

/// Σ|tᵢ| of the forces on an element's corners and of its stress. With ∇u = h, stresses are sums of moduli times
/// strains h + hᵀ + hᵀh, times C⁻¹ and powers of J; rounding of O(1) intermediate values (C, J) counts with the moduli
/// times
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
    let elastic = law.elastic_of(row);
    let state = ElementState::of(data, row, world.get::<Connectivity>(block).unwrap(), shape, displacement, elastic);
    let entries = state.points().iter().flat_map(|point| point.gradient.0).flatten();
    let h = entries.map(|x| x.abs()).fold(0.0, f64::max);
    let number = |k: usize| shape.get(lane_place(row, row_count(data), k));
    let nodes = node_count(data.kind);
    let gradients = match data.kind {
        ElementKind::Hex8MeanDilatation => natural_gradients::<Hex8MeanDilatation>(number),
        // in the triangle coordinates run from 0 to 1: what they multiply is a difference of two displacements
        ElementKind::Wedge6 => 2.0 * natural_gradients::<Wedge6>(number),
        // one difference and six deviations, whose slopes are below 8 together
        ElementKind::Tet10 => 9.0 * natural_gradients::<Tet10>(number),
        // a node's gradient is the sum of the slopes of all modes, each with either sign
        ElementKind::Hex8 => {
            let slopes = if data.simple { 3 } else { 6 };
            (0..3).map(|axis| (0..slopes).map(|mode| number(3 * mode + axis).abs()).sum::<f64>()).fold(0.0, f64::max)
        }
        ElementKind::Tet4 | ElementKind::Tet4NodalPressure => (0..9).map(|k| number(k).abs()).fold(0.0, f64::max),
    };
    let spread = state.displacements[..nodes].iter().flatten().map(|x| x.abs()).fold(0.0, f64::max);
    // terms of h itself cancel: a gradient is a sum of seven products at most
    let h = h.max(spread * gradients);
    let eta = law.fibres_of(row).map_or(0.0, |(fibres, _)| fibres.eta);
    let [shear, bulk] = elastic.small_strain_moduli();
    // a family's stress grows by exp(k₂Ē²), and its rounding by 2k₂Ē² times that
    let families = law.families_of(row).map(|(family, _)| {
        let strain = 2.0 * h * (1.0 + h);
        let exponent = family.k2 * strain * strain;
        4.0 * family.k1 * exponent.exp() * (1.0 + 2.0 * exponent)
    });
    // the stiffness by which the volume at points is held to their mean
    let held = if data.kind == ElementKind::Tet10 { number(Tet10::ROWS - 1) } else { 0.0 };
    let moduli = 2.0 * shear + bulk + 2.0 * eta + 2.0 * held + families.sum::<f64>();
    let compressed = state.points().iter().map(|point| point.kinematics.j).fold(1.0, f64::min);
    let memory = world.get::<ViscousMemory>(block).map_or(0.0, |_| 400.0);
    let nodal = world.get::<NodalVolumeChange>(block).map_or(0.0, |means| {
        bulk * state.nodes[..nodes].iter().map(|&node| means.get(node as usize).abs()).fold(0.0, f64::max)
    });
    let stress = (moduli * h + nodal) * (1.0 + h).powi(4) / compressed.powi(3) + memory;
    let hourglass = if data.kind == ElementKind::Hex8 {
        // q is a sum of eight displacements, and folded back along the element's arms with its gradients
        let row = if data.simple { Parallelepiped::FORCE_ROW } else { Hex8::FORCE_ROW };
        number(row.unwrap()) * 8.0 * spread * 8.0
    } else {
        0.0
    };
    Magnitude { stress, force: state.volume * stress * (1.0 + h) * gradients * nodes as f64 + hourglass }
}

/// The largest ∂ξ/∂X, which stands for gradients in natural coordinates.
fn natural_gradients<E: Element>(number: impl Fn(usize) -> f64) -> f64 {
    let still = E::prepare(&[[0.0; 3]; MOST_NODES]);
    let inverse = |point: usize| {
        let at = E::at_point(&still, point, &number);
        // the determinant of the adjugate is its square
        let [a, b, c] = at.adjugate.0.map(glam::DVec3::from_array);
        let determinant = a.cross(b).dot(c).sqrt();
        at.adjugate.0.into_iter().flatten().map(move |x| (x / determinant).abs())
    };
    (0..E::POINTS).flat_map(inverse).fold(0.0, f64::max)
}

/// The longest way from displacements to a corner's force: a gradient (8 roundings), strains and J (8), a cube root
/// (10), two laws (20), viscosity (8), F S (6), a force and the sum of all (16). Eight points with gradients in natural
/// coordinates (∂X/∂ξ 3, its adjugate and determinant 6, a division 3) and a sum over them (8) stay within what is
/// left.
pub const ROUNDINGS: f64 = 96.0;

/// What Ogden's law adds to it: twelve rotations (6 each), logarithms (12) and exponentials (16).
pub const OGDEN_ROUNDINGS: f64 = 100.0;
