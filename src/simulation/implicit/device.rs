//! Conjugate gradients on a device: their vectors stay there, from the right-hand side to the solution. What the host
//! does of a step is the same as without: Newton's iterations, with the residual, in f64.

mod coarse;
mod forces;
mod kernels;

use super::axes::Axes;
use super::conjugate_gradients::{Ended, Solved, Stop};
use super::formula::Formula;
use super::place::Place;
use super::preconditioner::Preconditioner;
use super::sums::Sums;
use super::trial::{STRAIN, Trial};
use super::vectors::{clear, update};
use crate::backend::device::Device;
use crate::backend::kernel::{BufferId, Kernel, KernelId, Uniform};
use crate::components::{Displacement, Reals};
use crate::error::Error;
use bevy_ecs::prelude::*;
use coarse::{Layout, turns};
pub(super) use forces::{bring_removal, bring_state, left, send_state};
use kernels::{CoarseBuffers, EXTENT, Extent, Room, SOLVE_WORDS, Vectors};

/// Iterations between two looks at whether a solve has ended: those that are too many cost passes, a look a wait for
/// the device.
const ITERATIONS_A_LOOK: u64 = 4;

/// What the device says of how a solve ended, from the word that means it goes on.
const ENDINGS: [(&str, Option<Ended>); 4] = [
    ("RUNNING", None),
    ("CONVERGED", Some(Ended::Converged)),
    ("NEGATIVE_CURVATURE", Some(Ended::NegativeCurvature)),
    ("NOT_FINITE", Some(Ended::NotFinite)),
];

/// The constants of kernels: how solves end, and how far differences strain elements.
fn endings() -> String {
    let numbers = ENDINGS.iter().enumerate().map(|(number, (name, _))| format!("const {name}: u32 = {number}u;\n"));
    numbers.collect::<String>() + &format!("const STRAIN: f32 = {:e};\n", STRAIN[0])
}

/// (D + c K) x = b at w; all vectors are of all axes.
pub(super) struct LinearSystem<'a> {
    /// w.
    pub place: Place<'a>,
    /// b (N).
    pub right: &'a Reals,
    /// The forces at w (N).
    pub net: &'a Reals,
    pub preconditioner: &'a dyn Preconditioner,
}

/// What solves on a device.
pub(super) struct OnDevice {
    vectors: Vectors,
    coarse: Option<CoarseBuffers>,
    room: Room,
    /// Which matrices of the coarse level are there.
    made: Option<u64>,
    extent: Extent,
    /// What comes before the first iteration; of an iteration what comes before the forces, and after them.
    begin: Vec<KernelId>,
    ahead: Vec<KernelId>,
    after: Vec<KernelId>,
}

impl OnDevice {
    /// Makes buffers and kernels, with room for a coarse level of that size.
    fn new(trial: &mut Trial<'_>, formula: &Formula, room: Room) -> Result<Self, Error> {
        let axes = trial.axes;
        let slope = trial.looks_at_steps().then_some(formula.after * formula.of_displacement);
        let extent = Extent::of(axes, formula.stiffness());
        let mut made = None;
        let mut counts = [0; 2];
        let ids = Device::prepare(trial.world, |world, buffers| {
            let vectors = Vectors::new(axes, &extent, buffers);
            let coarse = (room != Room::default()).then(|| CoarseBuffers::new(extent.nodes as usize, room, buffers));
            let [displace, image_of] = vectors.bodies(axes, slope, world, buffers);
            let begin = precondition(&vectors, coarse.as_ref(), &extent, room);
            let nodes = extent.nodes as usize;
            let ahead = [vectors.vectors("direct", nodes), vectors.scalars("reach_along")];
            let after = [vectors.scalars("step_length"), vectors.vectors("advance", nodes)];
            made = Some((vectors, coarse));
            counts = [begin.len(), ahead.len() + displace.len()];
            begin.into_iter().chain(ahead).chain(displace).chain(image_of).chain(after).collect()
        })?;
        let Some((vectors, coarse)) = made.filter(|_| !ids.is_empty()) else {
            return Err(Error::Options("there is no device to solve on".into()));
        };
        let (begin, rest) = ids.split_at(counts[0]);
        let (ahead, after) = rest.split_at(counts[1]);
        let after = [after, begin].concat();
        Ok(Self { vectors, coarse, room, made: None, extent, begin: begin.into(), ahead: ahead.into(), after })
    }

    /// Fills in a system, divided by the norm of its right-hand side.
    fn fill(&mut self, trial: &mut Trial<'_>, system: &LinearSystem<'_>, size: f64, stop: Stop) -> Result<(), Error> {
        let mut numbers = [0.0_f32; SOLVE_WORDS];
        numbers[LEFT + 1] = (stop.tolerance * stop.tolerance) as f32;
        let Place { formula, h, motion, .. } = system.place;
        let (of_nodes, looks_at_steps, world) = (motion.inertia(formula, h), trial.looks_at_steps(), &mut *trial.world);
        let of_axis = |(axis, &free): (usize, &bool)| if free { of_nodes.of(axis / 3) } else { -1.0 };
        let inertia = motion.free.iter().enumerate().map(of_axis);
        let blocks = (0..system.right.len() / 3).flat_map(|node| {
            let block = system.preconditioner.block(node);
            let [x, y, z] = [block.x_axis, block.y_axis, block.z_axis];
            [x.x, y.y, z.z, y.x, z.x, z.y]
        });
        let rounded = |numbers: &mut dyn Iterator<Item = f64>| numbers.map(|number| number as f32).collect();
        let vectors = self.vectors;
        // the world is there
        let columns = trial.axes.bodies.iter().filter_map(|&body| world.get::<Displacement>(body));
        let place = columns.flat_map(|u| numbers_of(u).map(|number| number as f32)).collect();
        let filled: [(BufferId, Vec<f32>); 7] = [
            (vectors.solve, numbers.to_vec()),
            (vectors.solution, vec![0.0; system.right.len()]),
            (vectors.residual, rounded(&mut numbers_of(system.right).map(|force| force / size))),
            (vectors.place, place),
            (vectors.net_force, rounded(&mut numbers_of(system.net))),
            (vectors.inertia, rounded(&mut { inertia })),
            (vectors.node_blocks, rounded(&mut { blocks })),
        ];
        let steps = looks_at_steps.then(|| (vectors.place_step, rounded(&mut system.place.steps(trial.axes, world))));
        for (buffer, numbers) in filled.into_iter().chain(steps) {
            upload(world, buffer, &numbers)?;
        }
        self.fill_coarse(world, system)
    }

    /// Fills in the coarse level: its matrices where these are others, and how aggregates have turned.
    fn fill_coarse(&mut self, world: &mut World, system: &LinearSystem<'_>) -> Result<(), Error> {
        let Some(coarse) = self.coarse else { return Ok(()) };
        let pieces = system.preconditioner.coarse();
        if self.made != Some(system.preconditioner.made()) {
            let layout = Layout::of(&pieces, system.right.len() / 3);
            upload(world, coarse.arms, &layout.arms)?;
            upload(world, coarse.aggregate_nodes, &layout.aggregate_nodes)?;
            upload(world, coarse.coarse_rows, &layout.rows)?;
            upload(world, coarse.coarse_inverse, &layout.inverse)?;
            let aggregates = layout.room().aggregates as u32;
            self.extent = Extent { aggregates, unknowns: layout.rows.len() as u32, ..self.extent };
            world.resource_mut::<Device>().rewrite(EXTENT, &self.extent.bytes())?;
            self.made = Some(system.preconditioner.made());
        }
        upload(world, coarse.turns, &turns(&pieces))
    }

    /// Takes iterations until one of the two ends it.
    fn iterate(&self, trial: &mut Trial<'_>, most: u64) -> Result<Solved, Error> {
        let record = trial.record();
        let forces = trial.kernels(|pass| pass.finds_forces);
        let iteration = [&self.ahead[..], &forces, &self.after].concat();
        run(trial.world, &self.begin, &record, 1)?;
        let mut taken = 0;
        loop {
            let count = ITERATIONS_A_LOOK.min(most - taken);
            run(trial.world, &iteration, &record, count)?;
            taken += count;
            let words: Vec<u32> = read(trial.world, self.vectors.solve)?;
            let [ended, iterations] = [ENDED, ENDED + 1].map(|place| words.get(place).copied().unwrap_or(0));
            let ended = ENDINGS.get(ended as usize).and_then(|(_, ended)| *ended);
            if ended.is_some() || taken >= most {
                trial.count += taken;
                let ended = ended.unwrap_or(Ended::Exhausted);
                return Ok(Solved { iterations: iterations.into(), ended, along: 0.0 });
            }
        }
    }
}

/// Places of what kernels keep of a solve.
const LEFT: usize = 4;
const ENDED: usize = 6;

/// The kernels of z = B r and of β.
fn precondition(vectors: &Vectors, coarse: Option<&CoarseBuffers>, extent: &Extent, room: Room) -> Vec<Kernel> {
    let of_coarse = coarse.map(|coarse| {
        let unknowns = room.aggregates * super::preconditioner::RIGID;
        [vectors.coarse("restrict_residual", room.aggregates, coarse), vectors.coarse("solve_coarse", unknowns, coarse)]
    });
    let fine = [vectors.precondition(extent.nodes as usize, coarse), vectors.scalars("turn_direction")];
    of_coarse.into_iter().flatten().chain(fine).collect()
}

/// Runs kernels so many times, with one record.
fn run(world: &mut World, kernels: &[KernelId], record: &[u8], count: u64) -> Result<(), Error> {
    let records = record.repeat(count as usize);
    world.resource_mut::<Device>().run(kernels, &records, record.len(), count as u32)
}

fn upload<T: bytemuck::NoUninit>(world: &mut World, buffer: BufferId, numbers: &[T]) -> Result<(), Error> {
    Ok(world.resource_mut::<Device>().gpu().upload(buffer, 0, bytemuck::cast_slice(numbers))?)
}

fn read<T: bytemuck::AnyBitPattern>(world: &mut World, buffer: BufferId) -> Result<Vec<T>, Error> {
    Ok(world.resource_mut::<Device>().gpu().download_rows(buffer)?)
}

/// The numbers of a vector, widened.
fn numbers_of(vector: &Reals) -> impl Iterator<Item = f64> + '_ {
    (0..vector.len()).map(|axis| vector.get(axis))
}

/// x ≈ (D + c K)⁻¹ b, as [`solve`](super::conjugate_gradients::solve) finds it on the host; in f32, with the numbers
/// divided by the norm of b.
pub(super) fn solve(
    on_device: &mut Option<OnDevice>,
    trial: &mut Trial<'_>,
    system: &LinearSystem<'_>,
    sums: &Sums,
    x: &mut Reals,
    stop: Stop,
) -> Result<Solved, Error> {
    clear(x);
    let size = sums.norm(system.right);
    let solved = |ended| Ok(Solved { iterations: 1, ended, along: 0.0 });
    match size {
        0.0 => return solved(Ended::NegativeCurvature),
        _ if !size.is_finite() => return solved(Ended::NotFinite),
        _ => {}
    }
    let room = needed(system.preconditioner);
    let fits = |made: &OnDevice| room.aggregates <= made.room.aggregates && room.entries <= made.room.entries;
    if !on_device.as_ref().is_some_and(fits) {
        // pieces become more where elements go
        let more = if on_device.is_some() { 2 } else { 1 };
        let room = Room { aggregates: more * room.aggregates, entries: more * room.entries };
        *on_device = Some(OnDevice::new(trial, system.place.formula, room)?);
    }
    let Some(on_device) = on_device else { return solved(Ended::NotFinite) };
    on_device.fill(trial, system, size, stop)?;
    let solved = on_device.iterate(trial, stop.most)?;
    trial.elsewhere = true;
    let found: Vec<f32> = read(trial.world, on_device.vectors.solution)?;
    update(x, |axis, _| size * found.get(axis).copied().map_or(0.0, f64::from));
    system.preconditioner.settle(system.right, x);
    Ok(Solved { along: sums.dot(x, system.right), ..solved })
}

fn needed(preconditioner: &dyn Preconditioner) -> Room {
    let sizes = preconditioner.coarse().into_iter().map(|piece| piece.size());
    sizes.fold(Room::default(), |room, size| Room {
        aggregates: room.aggregates + size / super::preconditioner::RIGID,
        entries: room.entries + size * size,
    })
}

/// What a solve dispatches, in words.
pub(super) fn in_words(axes: &Axes, has_coarse: bool, forces: usize) -> String {
    let bodies = axes.each().count();
    let own = 6 + 2 * bodies + if has_coarse { 2 } else { 0 };
    format!(
        "conjugate gradients run on the GPU: {} dispatches an iteration, {forces} of them forces; whether they have ended \
         is read every {ITERATIONS_A_LOOK} iterations, residuals are the host's, in f64",
        own + forces
    )
}
