//! What the nodes of a body weigh that has lost elements, and what they move with where mass is scaled. What is done
//! after each step needs no check of the stable step to be right.

use super::{BlockQuery, StayingBlock};
use crate::backend::Buffers;
use crate::backend::block_kernel::BlockKernels;
use crate::backend::kernel::{Fragment, Kernel, Uniform, uniform};
use crate::components::*;
use crate::elements::Element;
use crate::elements::{mass_shares, with_element_of};
use crate::error::{Error, missing};
use crate::evaluation::{add_nodal_masses, rest_volume};
use crate::math::{LANES, lane_place};
use crate::shader;
use bevy_ecs::prelude::*;

/// Sums the mass of a body's nodes from the elements that are left, and what there is further of it: damping, and what
/// resists acceleration.
pub(super) fn recompute(
    authoring: &Authoring,
    (blocks, others): (&Query<BlockQuery>, &Query<StayingBlock, Without<Alive>>),
    materials: &Query<(&Density, Option<&Damping>)>,
    mass: &mut Mass,
    (damping, inertia): (Option<&mut DampingCoefficient>, Option<&mut InertialMass>),
) -> Result<(), Error> {
    let count = mass.len();
    let (mut masses, mut coefficients) = (vec![0.0; count], vec![0.0; count]);
    // where mass is scaled
    let mut further: Option<Vec<f64>> = None;
    let parts = |&entity: &Entity| match blocks.get(entity) {
        Ok((_, block, connectivity, shape, .., added)) => Some((block, connectivity, shape, added)),
        // those that lose no elements weigh, too
        Err(_) => others.get(entity).ok(),
    };
    for (block, connectivity, shape, added) in authoring.blocks.iter().filter_map(parts) {
        let Ok((density, rate)) = materials.get(block.material) else {
            return Err(missing("a column of a body"));
        };
        let rate = rate.map_or(0.0, |rate| rate.0);
        // densities of copies do not differ where elements are removed
        let inertia = ElementInertia::of_all(density.0, rate);
        add_nodal_masses(block, connectivity, shape, inertia, &mut masses, &mut coefficients);
        if let Some(added) = added {
            add(block, connectivity, shape, added, further.get_or_insert_with(|| vec![0.0; count]));
        }
    }
    (0..count).for_each(|node| mass.set(node, masses[node]));
    if let Some(damping) = damping {
        (0..count).for_each(|node| damping.set(node, coefficients[node]));
    }
    if let Some((inertia, further)) = inertia.zip(further) {
        (0..count).for_each(|node| inertia.set(node, mass.get(node) + further[node]));
    }
    Ok(())
}

/// Adds what was added to those of a block's elements that are left (kg) to their nodes'.
fn add(block: &Block, connectivity: &[u32], shape: &Reals, added: &[f64], nodes: &mut [f64]) {
    let shares = mass_shares(block.kind);
    for row in (0..block.count).filter(|&row| added[row] > 0.0 && rest_volume(block, row, shape) > 0.0) {
        for (corner, share) in shares.iter().enumerate() {
            nodes[connectivity[lane_place(row, shares.len(), corner)] as usize] += added[row] * share;
        }
    }
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct NodeMass {
    count: u32,
    first: u32,
    density: f32,
    rate: f32,
}
uniform!(NodeMass { count, first, density, rate });

/// What sums the masses of a body's nodes from a block's elements that are left.
pub(super) fn mass_kernel(
    block: &BlockKernels,
    first: bool,
    world: &World,
    buffers: &mut dyn Buffers,
) -> Option<Kernel> {
    let body = block.block.body;
    let count = world.get::<Mass>(body)?.len();
    let (starts, volumes, shares) = volumes_at_nodes(&block.block, world.get::<Connectivity>(block.entity)?, count);
    let number = |value: Option<f64>| value.unwrap_or(0.0);
    let density = number(world.get::<Density>(block.block.material).map(|density| density.0));
    let rate = number(world.get::<Damping>(block.block.material).map(|damping| damping.0));
    let part = NodeMass { count: count as u32, first: u32::from(first), density: density as f32, rate: rate as f32 };
    let kernel = Kernel::new("node_mass", "node_mass")
        .fragment(shader!("node_mass"))
        .fragment(shader!("row"))
        .bind_uniform::<NodeMass>("part", buffers.uniform("node_mass".into(), &part.bytes()))
        .bind("starts", buffers.constants("starts of node_mass".into(), bytemuck::cast_slice(&starts)))
        .bind("volumes", buffers.constants("volumes of node_mass".into(), bytemuck::cast_slice(&volumes)))
        .bind("shares", buffers.constants("shares of node_mass".into(), bytemuck::cast_slice(&shares)))
        .bind(RestShape::NAME, buffers.column(block.entity, RestShape::NAME))
        .bind(Mass::NAME, buffers.column(body, Mass::NAME))
        .threads(count as u32);
    let kernel = if world.get::<DampingCoefficient>(body).is_some() {
        let damping = buffers.column(body, DampingCoefficient::NAME);
        kernel.fragment(shader!("node_damping")).bind(DampingCoefficient::NAME, damping)
    } else {
        kernel.fragment(Fragment::new("generated: no damping", "fn damp_node(node: u32, added: f32) {}\n"))
    };
    Some(with_inertia(kernel, block, world, buffers))
}

/// The same with what resists acceleration, where mass is scaled.
fn with_inertia(kernel: Kernel, block: &BlockKernels, world: &World, buffers: &mut dyn Buffers) -> Kernel {
    if world.get::<AddedMass>(block.entity).is_none() {
        let nothing = "fn move_node(node: u32, added: f32) {}\n";
        return kernel.fragment(Fragment::new("generated: no added mass", nothing));
    }
    let rows = with_element_of!(block.block, E => E::ROWS);
    let element = format!(
        "fn element_at(volume: u32) -> u32 {{\n    return volume / {}u * {LANES}u + volume % {LANES}u;\n}}\n",
        rows * LANES
    );
    kernel
        .fragment(shader!("node_inertia"))
        .fragment(shader!("added_mass"))
        .fragment(Fragment::new("generated: elements of volumes", element))
        .bind(InertialMass::NAME, buffers.column(block.block.body, InertialMass::NAME))
        .bind(AddedMass::NAME, buffers.column(block.entity, AddedMass::NAME))
}

/// For each of a body's nodes the places, in the rest shapes of a block, of the volumes of the elements that meet
/// there, and what share of their masses the node has.
fn volumes_at_nodes(block: &Block, connectivity: &[u32], count: usize) -> (Vec<u32>, Vec<u32>, Vec<f32>) {
    let shares = mass_shares(block.kind);
    let mut pairs: Vec<(u32, u32, u8)> = Vec::with_capacity(block.count * shares.len());
    for row in 0..block.count {
        let place = with_element_of!(block, E => lane_place(row, E::ROWS, E::VOLUME_ROW)) as u32;
        let node = |corner: usize| connectivity[lane_place(row, shares.len(), corner)];
        pairs.extend((0..shares.len()).map(|corner| (node(corner), place, corner as u8)));
    }
    pairs.sort_unstable();
    let start = |node: usize| pairs.partition_point(|&(of, ..)| (of as usize) < node) as u32;
    let starts = (0..=count).map(start).collect();
    let share = |&(.., corner): &(u32, u32, u8)| shares[usize::from(corner)] as f32;
    (starts, pairs.iter().map(|&(_, place, _)| place).collect(), pairs.iter().map(share).collect())
}
