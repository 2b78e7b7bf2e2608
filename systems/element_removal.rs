//! `element_removal`: takes elements away. `shaders/element_removal.wgsl` and `shaders/node_mass.wgsl` are its twins.

mod masses;

use super::system::{Phase, System};
use crate::backend::Buffers;
use crate::backend::block_kernel::BlockKernels;
use crate::backend::cpu::{BlockLaw, Cpu, ROWS_A_TASK};
use crate::backend::kernel::{Fragment, Kernel, Uniform, uniform};
use crate::backend::step::with_step;
use crate::components::*;
use crate::elements::Element;
use crate::elements::{mass_shares, with_element_of};
use crate::error::{Error, missing};
use crate::evaluation::{BlockView, ElementState, deactivate};
use crate::math::lane_place;
use crate::shader;
use bevy_ecs::prelude::*;
use glam::DVec3;
use masses::{mass_kernel, recompute};
use std::borrow::Cow;
use std::sync::{Mutex, PoisonError};

/// Criteria are looked at in every tenth explicit step: a wave passes a tenth of an element's height in a step, and to
/// look costs as much as the forces.
pub const CRITERION_STEPS: u64 = 10;

/// How many steps there are from one look at criteria to the next. Implicit steps may be as long as the motion itself,
/// and each takes forces many times: there it is looked in all of them.
pub fn criterion_steps(clock: &Clock) -> u64 {
    if clock.velocities_at_ends { 1 } else { CRITERION_STEPS }
}

/// At the end of a step, elements go whose time has come or that pass a limit. Their volume and hourglass stiffness
/// become zero, so that they exert nothing; what their nodes weigh is summed anew, and what they move with where mass
/// is scaled, and nodes without elements are inactive; faces of removed elements bear no load. The energy and momentum
/// they had are counted, kinetic energy with that of mass that was added to them, and what of the energy constraints
/// had given.
pub fn system() -> System {
    System::built_in(
        "element_removal",
        Phase::Removal,
        "removes elements by time and by criterion",
        "an entry under `removal`",
        |world| super::registry::count::<Alive>(world, "block that may lose elements", "blocks that may lose elements"),
        element_removal,
    )
    .on_device(kernels)
}

type BlockQuery<'a> = (
    Entity,
    &'a Block,
    &'a Connectivity,
    &'a mut RestShape,
    &'a BlockLaw<f64>,
    Option<&'a FibreDirection>,
    (Option<&'a MemoryBefore>, Option<&'a ViscousMemory>),
    Option<&'a NodalVolumeChange>,
    &'a mut Alive,
    &'a RemovalStep,
    &'a mut RemovedEnergy,
    &'a mut RemovedWork,
    &'a mut RemovedMomentum,
    Option<&'a AddedMass>,
);

type BodyQuery<'a> = (
    &'a Authoring,
    &'a Displacement,
    &'a DisplacementIncrement,
    &'a ConstrainedAxes,
    &'a mut Mass,
    Option<&'a mut DampingCoefficient>,
    Option<&'a mut InertialMass>,
);

/// Of a block that loses no elements, what it weighs by.
type StayingBlock<'a> = (&'a Block, &'a Connectivity, &'a RestShape, Option<&'a AddedMass>);

fn element_removal(
    clock: Res<Clock>,
    cpu: Res<Cpu>,
    criteria: Query<&RemovalCriterion>,
    densities: Query<(&Density, Option<&Damping>)>,
    mut blocks: Query<BlockQuery>,
    others: Query<StayingBlock, Without<Alive>>,
    mut bodies: Query<BodyQuery>,
    loads: Query<(&SceneLoad, &OfBody)>,
) -> Result<(), Error> {
    let is_due = clock.step.is_multiple_of(criterion_steps(&clock));
    let mut touched: Vec<Entity> = Vec::new();
    for (
        entity,
        block,
        connectivity,
        mut shape,
        law,
        fibres,
        memory,
        means,
        mut alive,
        by_time,
        mut energies,
        mut given,
        mut momenta,
        added,
    ) in &mut blocks
    {
        let Ok((_, displacement, step, axes, ..)) = bodies.get(block.body) else {
            return Err(missing("a column of a body"));
        };
        let view = BlockView {
            block,
            connectivity,
            shape: &shape,
            displacement,
            law,
            fibre_direction: fibres.map(|f| &f.0),
            memory: memory.0.map(|m| &m.0).or(memory.1.map(|m| &m.0)),
            nodal_volume_change: means.map(|means| Cow::Borrowed(&means.0)),
        };
        let of_block: Vec<&RemovalCriterion> = criteria.iter().filter(|c| is_due && c.block == entity).collect();
        let due = |row: usize| alive[row] == 1 && u64::from(by_time[row]) <= clock.step && by_time[row] != u32::MAX;
        let passes = |row: usize, c: &RemovalCriterion| {
            (c.rows.is_empty() || c.rows.binary_search(&(row as u32)).is_ok())
                && measure(c.measure, row, &view) > c.limit
        };
        // to look at the time alone is too little work to share
        let gone: Vec<usize> = match of_block.is_empty() {
            true => (0..block.count).filter(|&row| due(row)).collect(),
            false => rows_where(&cpu, block.count, |row| {
                due(row) || alive[row] == 1 && of_block.iter().any(|c| passes(row, c))
            }),
        };
        let density = densities.get(block.material).map_or(0.0, |(density, _)| density.0);
        let held = |row: usize| {
            let state = view.element(row);
            let elastic = view.energy(row, &state) * state.volume;
            let mass = (density * state.volume, added.map_or(0.0, |added| added[row]));
            let (kinetic, given, momentum) = motion(&state, mass, (step, axes), clock.time_step);
            (elastic + state.hourglass_energy(row, view.shape) + kinetic, given, momentum)
        };
        let held: Vec<(f64, f64, DVec3)> = gone.iter().map(|&row| held(row)).collect();
        for (&row, (held, by_constraints, momentum)) in gone.iter().zip(held) {
            energies.set(row, held);
            given.set(row, by_constraints);
            (0..3).for_each(|i| momenta.set(lane_place(row, 3, i), momentum[i]));
            alive[row] = 0;
            deactivate(block, row, &mut shape);
        }
        if !gone.is_empty() && !touched.contains(&block.body) {
            touched.push(block.body);
        }
    }
    for body in touched {
        let Ok((authoring, .., mut mass, mut damping, mut inertia)) = bodies.get_mut(body) else {
            return Err(missing("a column of a body"));
        };
        let further = (damping.as_deref_mut(), inertia.as_deref_mut());
        recompute(authoring, (&blocks, &others), &densities, &mut mass, further)?;
        // elements of blocks that lose none are always there
        let alive = |(block, row): (u32, u32)| {
            let block = authoring.blocks.get(block as usize).and_then(|&block| blocks.get(block).ok());
            block.map_or(1, |block| block.8[row as usize])
        };
        for (load, _) in loads.iter().filter(|(_, of)| of.0 == body) {
            if let Some(faces) = load.on.faces() {
                faces.mark(|element| Some(alive(element)));
            }
        }
    }
    Ok(())
}

/// Rows for which something holds, ascending.
fn rows_where(cpu: &Cpu, count: usize, holds: impl Fn(usize) -> bool + Sync + Send) -> Vec<usize> {
    let rows = |task: usize| (task * ROWS_A_TASK..count.min((task + 1) * ROWS_A_TASK)).filter(|&row| holds(row));
    let found = Mutex::new(Vec::new());
    cpu.for_each(0..count.div_ceil(ROWS_A_TASK), |task| {
        let own: Vec<usize> = rows(task).collect();
        if !own.is_empty() {
            found.lock().unwrap_or_else(PoisonError::into_inner).extend(own);
        }
    });
    let mut found = found.into_inner().unwrap_or_else(PoisonError::into_inner);
    found.sort_unstable();
    found
}

pub(super) fn measure(measure: Measure, row: usize, view: &BlockView<'_>) -> f64 {
    let state = view.element(row);
    match measure {
        Measure::Stretch => state.largest_stretch(),
        Measure::VolumeRatio => state.volume_ratio(),
        Measure::NegativeVolumeRatio => -state.volume_ratio(),
        Measure::EnergyDensity => view.energy(row, &state),
    }
}

/// ½ m v² of the element's share of its nodes (J), v in the middle of the last step, m with what was added to it; the
/// part of it along constrained axes; and m v (kg m/s) without what was added.
fn motion(
    state: &ElementState,
    (mass, added): (f64, f64),
    (step, axes): (&Reals, &[u32]),
    time_step: f64,
) -> (f64, f64, DVec3) {
    let (mut all, mut constrained, mut mean) = (0.0, 0.0, DVec3::ZERO);
    for (&node, share) in state.nodes.iter().zip(mass_shares(state.kind)) {
        let v = step.vector(node as usize);
        all += share * v.length_squared();
        mean += share * v;
        let held = (0..3).filter(|&i| axes[node as usize] >> i & 1 == 1).map(|i| v[i] * v[i]);
        constrained += share * held.sum::<f64>();
    }
    let energy = |squares: f64| 0.5 * (mass + added) * squares / (time_step * time_step);
    (energy(all), energy(constrained), mass / time_step * mean)
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Removal {
    density: f32,
}
uniform!(Removal { density });

/// For each block that may lose elements: what finds those that pass a limit, and what takes away those that are due.
/// Then for each of the body's blocks what its nodes weigh.
fn kernels(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let blocks = BlockKernels::of_world(world, buffers);
    let criteria: Vec<RemovalCriterion> = world.query::<&RemovalCriterion>().iter(world).cloned().collect();
    let steps = criterion_steps(world.resource::<Clock>());
    let mut kernels = Vec::new();
    let mut recomputed = Vec::new();
    for block in blocks.iter().filter(|block| world.get::<Alive>(block.entity).is_some()) {
        let of_block: Vec<&RemovalCriterion> = criteria.iter().filter(|c| c.block == block.entity).collect();
        // a bit for each criterion
        for some in of_block.chunks(32) {
            kernels.push(with_step(criterion_kernel(block, (some, steps), buffers), world));
        }
        kernels.push(with_step(motion_kernel(block, world, buffers), world));
        kernels.push(with_step(removal_kernel(block, buffers), world));
        if !recomputed.contains(&block.block.body) {
            recomputed.push(block.block.body);
        }
    }
    for body in recomputed {
        for (place, block) in blocks.iter().filter(|block| block.block.body == body).enumerate() {
            kernels.extend(mass_kernel(block, place == 0, world, buffers));
        }
    }
    kernels
}

/// What finds elements that pass a limit, in every so many steps.
fn criterion_kernel(
    block: &BlockKernels,
    (criteria, steps): (&[&RemovalCriterion], u64),
    buffers: &mut dyn Buffers,
) -> Kernel {
    let mut text = format!(
        "const LIMITS: u32 = {}u;\nconst CRITERION_STEPS: u32 = {steps}u;\n\
         fn passes_a_limit(element: u32, of_element: u32, e: Element) -> bool {{\n    return false",
        criteria.len()
    );
    for (bit, criterion) in criteria.iter().enumerate() {
        let measure = match criterion.measure {
            Measure::Stretch => "stretch_of(e)",
            Measure::VolumeRatio => "volume_ratio_of(e)",
            Measure::NegativeVolumeRatio => "-volume_ratio_of(e)",
            Measure::EnergyDensity => "energy_density(element, e)",
        };
        text += &format!("\n        || (((of_element >> {bit}u) & 1u) == 1u && {measure} > limits[{bit}].x)");
    }
    text += ";\n}\n";
    let limits: Vec<[f32; 4]> = criteria.iter().map(|criterion| [criterion.limit as f32, 0.0, 0.0, 0.0]).collect();
    let mut bits = vec![0_u32; block.block.count];
    for (bit, criterion) in criteria.iter().enumerate() {
        if criterion.rows.is_empty() {
            bits.iter_mut().for_each(|bits| *bits |= 1 << bit);
        }
        criterion.rows.iter().for_each(|&row| bits[row as usize] |= 1 << bit);
    }
    let limits = buffers.uniform("limits of criterion".into(), bytemuck::cast_slice(&limits));
    let bits = buffers.constants("criteria".into(), bytemuck::cast_slice(&bits));
    let kernel = block
        .kernel("criterion")
        .fragment(shader!("criterion"))
        .fragment(block.generated("limits", text))
        .bind("limits", limits)
        .bind("criteria", bits);
    let columns = [RestShape::NAME, Alive::NAME, RemovalStep::NAME];
    let kernel = columns.iter().fold(kernel, |k, &name| k.bind(name, buffers.column(block.entity, name)));
    block.with_energy(kernel, buffers)
}

const REMOVED: [&str; 3] = [RestShape::NAME, RemovalStep::NAME, RemovedEnergy::NAME];

fn motion_kernel(block: &BlockKernels, world: &World, buffers: &mut dyn Buffers) -> Kernel {
    let density = world.get::<Density>(block.block.material).map_or(0.0, |density| density.0);
    let removal = Removal { density: density as f32 };
    let shares: Vec<String> =
        mass_shares(block.block.kind).iter().map(|share| format!("{:?}", *share as f32)).collect();
    let momenta = place_in_buffer::<RemovedMomentum>(block.entity, world);
    let shares =
        format!("const MASS_SHARES = array<f32, NODES>({});\nconst MOMENTA_AT: u32 = {momenta}u;\n", shares.join(", "));
    let kernel = block
        .of_columns("removed_motion")
        .fragment(shader!("removed_motion"))
        .fragment(shader!("due"))
        .fragment(block.generated("mass shares", shares))
        .bind_uniform::<Removal>("removal", buffers.uniform("element_removal".into(), &removal.bytes()))
        .bind(DisplacementIncrement::NAME, buffers.column(block.block.body, DisplacementIncrement::NAME))
        .bind(ConstrainedAxes::NAME, buffers.column(block.block.body, ConstrainedAxes::NAME))
        .bind(RemovedWork::BUFFER, buffers.column(block.entity, RemovedWork::NAME));
    let kernel = if world.get::<AddedMass>(block.entity).is_some() {
        let added = buffers.column(block.entity, AddedMass::NAME);
        kernel.fragment(shader!("added_mass")).bind(AddedMass::NAME, added)
    } else {
        let nothing = "fn added_to(element: u32) -> f32 {\n    return 0.0;\n}\n";
        kernel.fragment(Fragment::new("generated: no added mass", nothing))
    };
    REMOVED.iter().fold(kernel, |k, &name| k.bind(name, buffers.column(block.entity, name)))
}

fn removal_kernel(block: &BlockKernels, buffers: &mut dyn Buffers) -> Kernel {
    let (volume, further) = with_element_of!(block.block, E => (E::VOLUME_ROW, E::FORCE_ROW));
    let mut text = String::from("fn deactivate(element: u32) {\n");
    for row in std::iter::once(volume).chain(further) {
        text += &format!("    rest_shape[place(element, ROWS, {row}u)] = 0.0;\n");
    }
    let kernel = block
        .kernel("element_removal")
        .fragment(shader!("element_removal"))
        .fragment(shader!("due"))
        .fragment(block.generated("extinction", text + "}\n"))
        .bind(Alive::NAME, buffers.column(block.entity, Alive::NAME));
    let kernel = REMOVED.iter().fold(kernel, |k, &name| k.bind(name, buffers.column(block.entity, name)));
    block.with_energy(kernel, buffers)
}
