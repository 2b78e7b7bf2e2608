//! `element_removal`: takes elements away. `shaders/element_removal.wgsl` and `shaders/node_mass.wgsl` are its twins.

use super::registry::{Phase, System};
use crate::backend::cpu::{BlockLaw, Cpu, ROWS_A_TASK};
use crate::components::*;
use crate::elements::{Element, Hex8, Tet4};
use crate::evaluation::{ElementState, Material, lane_place, node_count, row_count, with_element};
use crate::scene::schema::ElementKind;
use bevy_ecs::prelude::*;

/// Criteria are looked at in every tenth step: a wave passes a tenth of an element's height in a step, and to look costs
/// as much as the forces.
pub const CRITERION_STEPS: u64 = 10;

/// At the end of a step, elements go whose time has come or that pass a limit. Their volume and hourglass stiffness
/// become zero, so that they exert nothing; what their nodes weigh is summed anew, and nodes without elements are parked;
/// faces of removed elements bear no load. The energy they held is booked.
pub fn system() -> System {
    System::built_in(
        "element_removal",
        Phase::Removal,
        "removes elements by time and by criterion",
        |world| super::registry::count::<Alive>(world, "block may lose elements").map(|s| s.replace("elementss", "elements")),
        element_removal,
    )
}

type BlockQuery<'a> = (
    Entity,
    &'a Block,
    &'a Connectivity,
    &'a mut RestShape,
    &'a BlockLaw<f64>,
    Option<&'a FibreDirection>,
    Option<&'a ViscousMemory>,
    &'a mut Alive,
    &'a RemovalStep,
    &'a mut RemovedEnergy,
);

fn element_removal(
    clock: Res<Clock>,
    cpu: Res<Cpu>,
    criteria: Query<&RemovalCriterion>,
    densities: Query<(&Density, Option<&Damping>)>,
    mut blocks: Query<BlockQuery>,
    mut bodies: Query<(&Authoring, &Displacement, &DisplacementStep, &mut Mass, Option<&mut DampingCoefficient>)>,
    mut pressures: Query<(&mut Pressure, &OfBody), Without<Traction>>,
    mut tractions: Query<(&mut Traction, &OfBody), Without<Pressure>>,
) {
    let look = clock.step % CRITERION_STEPS == 0;
    let mut touched: Vec<Entity> = Vec::new();
    for (entity, block, connectivity, mut shape, law, fibres, memory, mut alive, by_time, mut energies) in &mut blocks {
        let Ok((_, displacement, step, ..)) = bodies.get(block.body) else { continue };
        let material = Material { law, fibre_direction: fibres.map(|f| &f.0), memory: memory.map(|m| &m.0) };
        let of_block: Vec<&RemovalCriterion> = criteria.iter().filter(|c| look && c.block == entity).collect();
        let goes = |row: usize| {
            alive[row] == 1
                && (u64::from(by_time[row]) <= clock.step && by_time[row] != u32::MAX
                    || of_block.iter().any(|c| {
                        (c.rows.is_empty() || c.rows.binary_search(&(row as u32)).is_ok())
                            && measure(c.measure, row, block.kind, connectivity, &shape, displacement, &material) > c.limit
                    }))
        };
        let gone = rows_where(&cpu, block.count, goes);
        let density = densities.get(block.material).map_or(0.0, |(density, _)| density.0);
        for &row in &gone {
            let state = ElementState::of(block.kind, row, connectivity, &shape, displacement);
            let kinetic = kinetic_energy(&state, density, step, clock.time_step);
            let elastic = material.energy(row, &state.kinematics) * state.volume;
            energies.set(row, elastic + state.hourglass_energy(row, &shape) + kinetic);
            alive[row] = 0;
            extinguish(block.kind, row, &mut shape);
        }
        if !gone.is_empty() && !touched.contains(&block.body) {
            touched.push(block.body);
        }
    }
    for body in touched {
        let Ok((authoring, .., mut mass, mut damping)) = bodies.get_mut(body) else { continue };
        weigh(authoring, &blocks, &densities, &mut mass, damping.as_deref_mut());
        let alive = |(block, row): (u32, u32)| {
            authoring.blocks.get(block as usize).and_then(|&block| blocks.get(block).ok()).map_or(0, |b| b.7[row as usize])
        };
        let of_body = |of: &OfBody| of.0 == body;
        for (mut load, _) in pressures.iter_mut().filter(|(_, of)| of_body(of)) {
            update_faces(&mut load.faces, alive);
        }
        for (mut load, _) in tractions.iter_mut().filter(|(_, of)| of_body(of)) {
            update_faces(&mut load.faces, alive);
        }
    }
}

/// Rows for which something holds, ascending.
fn rows_where(cpu: &Cpu, count: usize, holds: impl Fn(usize) -> bool + Sync + Send) -> Vec<usize> {
    let rows = |task: usize| (task * ROWS_A_TASK..count.min((task + 1) * ROWS_A_TASK)).filter(|&row| holds(row));
    cpu.map(count.div_ceil(ROWS_A_TASK), |task| rows(task).collect::<Vec<usize>>()).concat()
}

fn measure(
    measure: Measure,
    row: usize,
    kind: ElementKind,
    connectivity: &[u32],
    shape: &Reals,
    displacement: &Reals,
    material: &Material<'_>,
) -> f64 {
    let state = ElementState::of(kind, row, connectivity, shape, displacement);
    match measure {
        Measure::Stretch => state.largest_stretch(),
        Measure::VolumeRatio => state.kinematics.true_j,
        Measure::NegativeVolumeRatio => -state.kinematics.true_j,
        Measure::EnergyDensity => material.energy(row, &state.kinematics),
    }
}

/// ½ m v² of the element's share of its nodes (J), v in the middle of the last step.
fn kinetic_energy(state: &ElementState, density: f64, step: &Reals, time_step: f64) -> f64 {
    let nodes = node_count(state.kind);
    let share = density * state.volume / nodes as f64;
    let squares = state.nodes[..nodes].iter().map(|&node| step.vector(node as usize).length_squared());
    0.5 * share * squares.sum::<f64>() / (time_step * time_step)
}

/// Makes an element exert nothing.
fn extinguish(kind: ElementKind, row: usize, shape: &mut Reals) {
    let numbers = row_count(kind);
    with_element!(kind, E => {
        shape.set(lane_place(row, numbers, E::VOLUME_ROW), 0.0);
        if let Some(hourglass) = E::HOURGLASS_ROW {
            shape.set(lane_place(row, numbers, hourglass), 0.0);
        }
    });
}

/// Sums the mass and damping of a body's nodes from the elements that are left.
fn weigh(
    authoring: &Authoring,
    blocks: &Query<BlockQuery>,
    materials: &Query<(&Density, Option<&Damping>)>,
    mass: &mut Mass,
    damping: Option<&mut DampingCoefficient>,
) {
    let count = mass.len();
    let (mut masses, mut coefficients) = (vec![0.0; count], vec![0.0; count]);
    for (_, block, connectivity, shape, ..) in authoring.blocks.iter().filter_map(|&block| blocks.get(block).ok()) {
        let Ok((density, rate)) = materials.get(block.material) else { continue };
        let nodes = node_count(block.kind);
        let volume = match block.kind {
            ElementKind::Tet4 => Tet4::VOLUME_ROW,
            ElementKind::Hex8 => Hex8::VOLUME_ROW,
        };
        for row in 0..block.count {
            let share = density.0 * shape.get(lane_place(row, row_count(block.kind), volume)) / nodes as f64;
            for corner in 0..nodes {
                let node = connectivity[lane_place(row, nodes, corner)] as usize;
                masses[node] += share;
                coefficients[node] += share * rate.map_or(0.0, |rate| rate.0);
            }
        }
    }
    (0..count).for_each(|node| mass.set(node, masses[node]));
    if let Some(damping) = damping {
        (0..count).for_each(|node| damping.set(node, coefficients[node]));
    }
}

fn update_faces(faces: &mut FaceCorners, alive: impl Fn((u32, u32)) -> u32) {
    for (mark, &element) in faces.alive.iter_mut().zip(&faces.elements) {
        *mark = alive(element);
    }
}
