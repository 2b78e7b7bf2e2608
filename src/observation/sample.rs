//! What the guards sample: energies of parts, the smallest J, the fastest node. On the CPU by vector kernels, on the
//! GPU by kernels whose sums of sixty-four rows each are brought to the host, but for implicit steps, whose state the
//! host has.

use crate::backend::cpu::{BlockLaw, BlockSums, Cpu, GuardColumns, run_guard};
use crate::backend::device::{Device, bring_to_host};
use crate::backend::kernel::KernelId;
use crate::components::*;
use crate::elements::{averages, with_element_of};
use crate::error::{Error, missing};
use crate::evaluation::BlockView;
use crate::math::SimdScalar;
use bevy_ecs::prelude::*;

/// The kernels of the guards, on a GPU. A resource.
#[derive(Resource, Default)]
pub struct GuardKernels(pub Vec<KernelId>);

/// A sample of all bodies, where velocities are: in the middle of the last step, of implicit ones at its end.
#[derive(Clone, Debug, Default)]
pub struct Sample {
    /// ½ m v² (J).
    pub kinetic: f64,
    /// Work against internal forces since the start (J).
    pub internal_work: f64,
    /// The body, row and speed (m/s) of the fastest node.
    pub fastest: Option<(Entity, u32, f64)>,
    /// Each body, and the largest displacement of a node (m).
    pub reach: Vec<(Entity, f64)>,
    /// Each block and what its elements come to.
    pub parts: Vec<(Entity, BlockSums)>,
}

/// Samples all bodies.
///
/// # Errors
/// What the GPU says.
pub fn sample(world: &mut World) -> Result<Sample, Error> {
    let kernels = world.get_resource::<GuardKernels>().map(|kernels| kernels.0.clone()).unwrap_or_default();
    let mut sample = Sample { internal_work: internal_work(world)?, ..Sample::default() };
    if kernels.is_empty() {
        let wanted = [Displacement::NAME, DisplacementIncrement::NAME, Mass::NAME, RestShape::NAME];
        bring_to_host(world, |_, name| wanted.contains(&name))?;
        sample_nodes(&mut sample, world);
        sample_elements(&mut sample, world)?;
        return Ok(sample);
    }
    if let Some(mut device) = world.get_resource_mut::<Device>() {
        device.run(&kernels, &[], 0, 1)?;
    }
    bring_to_host(world, |_, name| name == NodeSums::NAME || name == ElementSums::NAME)?;
    add_up_nodes(&mut sample, world);
    for (entity, _, sums) in world.query::<(Entity, &Block, &ElementSums)>().iter(world) {
        let of_group = |words: &[u32]| {
            let number = |i: usize| f64::from(f32::from_bits(words[i]));
            BlockSums {
                strain: number(0),
                hourglass: number(1),
                least_volume_ratio: if words[3] == u32::MAX { f64::INFINITY } else { number(2) },
                row: words[3],
            }
        };
        sample.parts.push((entity, sums.chunks_exact(4).map(of_group).fold(BlockSums::default(), BlockSums::and)));
    }
    Ok(sample)
}

/// Work against internal forces (J) of all bodies, as it is counted.
fn internal_work(world: &mut World) -> Result<f64, Error> {
    bring_to_host(world, |_, name| name == InternalWork::NAME || name == Work::NAME)?;
    let mut sum = 0.0;
    for (guarded, work) in world.query::<(Option<&InternalWork>, Option<&Work>)>().iter(world) {
        sum += guarded.map_or(0.0, InternalWork::total);
        if let Some(work) = work {
            sum += (0..work.len() / WORK_NUMBERS).map(|row| work.get(WORK_NUMBERS * row + 3)).sum::<f64>();
        }
    }
    Ok(sum)
}

impl Sample {
    fn add_nodes(&mut self, body: Entity, motion: f64, square: f64, row: u32, rate: f64, reach: f64) {
        match self.reach.last_mut().filter(|(of, _)| *of == body) {
            // max forgets what is no number
            Some((_, most)) if !most.is_nan() => *most = if reach.is_nan() { reach } else { most.max(reach) },
            Some(_) => {}
            None => self.reach.push((body, reach)),
        }
        self.kinetic += motion * rate * rate;
        let speed = square.max(0.0).sqrt() * rate;
        if self.fastest.is_none_or(|(_, _, fastest)| speed > fastest) {
            self.fastest = Some((body, row, speed));
        }
    }
}

fn add_up_nodes(sample: &mut Sample, world: &mut World) {
    let rate = world.resource::<Clock>().rate();
    for (body, sums) in world.query::<(Entity, &NodeSums)>().iter(world) {
        for words in sums.chunks_exact(4) {
            let number = |i: usize| f64::from(f32::from_bits(words[i]));
            sample.add_nodes(body, number(0), number(1), words[2], rate, number(3).sqrt());
        }
    }
}

fn sample_nodes(sample: &mut Sample, world: &mut World) {
    let rate = world.resource::<Clock>().rate();
    for (body, mass, step, u) in world.query::<(Entity, &Mass, &DisplacementIncrement, &Displacement)>().iter(world) {
        let (mut motion, mut fastest, mut reach) = (0.0, (-1.0, u32::MAX), 0.0_f64);
        for row in 0..mass.len() {
            reach = reach.max(u.vector(row).length_squared());
            let square = step.vector(row).length_squared();
            motion += 0.5 * mass.get(row) * square;
            if square > fastest.0 {
                fastest = (square, row as u32);
            }
        }
        sample.add_nodes(body, motion, fastest.0, fastest.1, rate, reach.sqrt());
    }
}

fn sample_elements(sample: &mut Sample, world: &mut World) -> Result<(), Error> {
    let blocks: Vec<(Entity, Entity)> =
        world.query::<(Entity, &Block)>().iter(world).map(|(entity, block)| (entity, block.body)).collect();
    let mut there: Option<(Entity, Displacement)> = None;
    for (entity, body) in blocks {
        if there.as_ref().is_none_or(|(of, _)| *of != body) {
            there = where_velocities_are(world, body).map(|displacement| (body, displacement));
        }
        let Some((_, displacement)) = &there else {
            return Err(missing("a column of a body"));
        };
        let sums = match displacement.0 {
            Reals::F32(_) => sums_of::<f32>(world, entity, displacement),
            Reals::F64(_) => sums_of::<f64>(world, entity, displacement),
        };
        debug_assert!(sums.is_some(), "a broken invariant: a block that cannot be sampled");
        sample.parts.extend(sums.map(|sums| (entity, sums)));
    }
    Ok(())
}

/// Each block and what its elements come to at the present displacements, evaluated on the host.
///
/// # Errors
/// What the GPU says.
pub fn sample_result(world: &mut World) -> Result<Vec<(Entity, BlockSums)>, Error> {
    bring_to_host(world, |_, name| name == Displacement::NAME || name == RestShape::NAME)?;
    let blocks: Vec<(Entity, Entity)> =
        world.query::<(Entity, &Block)>().iter(world).map(|(entity, block)| (entity, block.body)).collect();
    let sums = |(entity, body): (Entity, Entity)| {
        let displacement = world.get::<Displacement>(body)?;
        let sums = match displacement.0 {
            Reals::F32(_) => sums_of::<f32>(world, entity, displacement),
            Reals::F64(_) => sums_of::<f64>(world, entity, displacement),
        };
        Some((entity, sums?))
    };
    Ok(blocks.into_iter().filter_map(sums).collect())
}

/// Displacements in the middle of the last step, of implicit ones at its end, in the run's precision.
fn where_velocities_are(world: &World, body: Entity) -> Option<Displacement> {
    let (u, step) = (world.get::<Displacement>(body)?, world.get::<DisplacementIncrement>(body)?);
    if world.resource::<Clock>().velocities_at_ends {
        return Some(u.clone());
    }
    Some(Displacement(match (&u.0, &step.0) {
        (Reals::F32(u), Reals::F32(step)) => Reals::F32(u.iter().zip(step).map(|(u, d)| u - 0.5 * d).collect()),
        (Reals::F64(u), Reals::F64(step)) => Reals::F64(u.iter().zip(step).map(|(u, d)| u - 0.5 * d).collect()),
        _ => return None,
    }))
}

fn sums_of<T: SimdScalar>(world: &World, entity: Entity, displacement: &Displacement) -> Option<BlockSums> {
    let (block, cpu) = (world.get::<Block>(entity)?, world.resource::<Cpu>());
    let means: Vec<T> = match averages(block.kind) {
        false => Vec::new(),
        true => {
            // made afresh, under these displacements
            let means = BlockView::under(world, entity, &displacement.0)?.nodal_volume_change?;
            (0..means.len()).map(|node| T::from_f64(means.get(node))).collect()
        }
    };
    let columns = GuardColumns::<T> {
        displacement: displacement.slice(),
        connectivity: world.get::<Connectivity>(entity)?,
        rest_shape: world.get::<RestShape>(entity)?.slice(),
        fibre_direction: world.get::<FibreDirection>(entity).map(|f| f.slice()),
        nodal_volume_change: &means,
    };
    let rounded;
    let law = match world.get::<BlockLaw<T>>(entity) {
        Some(law) => law,
        None => {
            rounded = world.get::<BlockLaw<f64>>(entity)?.rounded::<T>();
            &rounded
        }
    };
    Some(with_element_of!(block, E => run_guard::<E, T>(cpu, &columns, law, patch_groups(block.kind))))
}
