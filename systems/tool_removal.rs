//! `tool_removal`: chooses the elements that tools take. `shaders/tool_removal.wgsl` is its twin, with
//! `shaders/tool_removal_choice.wgsl` and `shaders/tool_removal_due.wgsl`.

use super::system::{Phase, System};
use crate::backend::Buffers;
use crate::backend::block_kernel::BlockKernels;
use crate::backend::cpu::{Cpu, ROWS_A_TASK};
use crate::backend::kernel::{BufferId, Fragment, Kernel, Uniform, uniform};
use crate::backend::step::with_step;
use crate::components::*;
use crate::elements::node_count;
use crate::error::missing;
use crate::evaluation::rest_volume;
use crate::math::lane_place;
use crate::shader;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// A tool takes a volume in a second, and elements by rest volume, whole and one after the other: those whose centroids
/// are nearest to its mouth first, of equally near ones that of the lower number. So the volume that is gone is that
/// which was taken in, to one element, whatever the mesh.
///
/// What is in reach is looked at as often as [`ToolLooks`] says; while there is nothing, nothing is taken in. Where
/// nothing is left in reach, no more than the largest element's volume stays taken in, and what the steps from one look
/// to the next take: the rest was no tissue. While the rate is 0 or below nothing goes, and nothing is given back. An
/// element that is chosen is due at once: `element_removal` takes it in the same step.
pub fn system() -> System {
    System::built_in(
        "tool_removal",
        Phase::Removal,
        "chooses the elements that tools take",
        "`InTool(rate: ...)` under `removal`",
        |world| {
            let mut query = world.query::<&ToolRemovals>();
            let takers = query.iter(world).flat_map(|removals| &removals.all);
            match takers.filter(|removal| removal.threshold.is_none()).count() {
                0 => None,
                1 => Some("1 tool that takes elements".into()),
                count => Some(format!("{count} tools that take elements")),
            }
        },
        tool_removal,
    )
    .on_device(kernels)
}

type BodyQuery<'a> = (&'a ToolRemovals, &'a mut ToolIntake, &'a Authoring, &'a RestPosition, &'a Displacement);

type BlockQuery<'a> = (&'a Block, &'a Connectivity, &'a RestShape, &'a Alive, &'a mut RemovalStep);

/// An element in reach: how far from the mouth (m), the author's place of it, block and row, rest volume (m³).
pub(super) type InReach = (f64, u32, Entity, usize, f64);

/// The tools that take by a rate, with their places among all.
fn by_rate(removals: &ToolRemovals) -> impl Iterator<Item = (usize, &ToolRemoval)> {
    removals.all.iter().enumerate().filter(|(_, removal)| removal.threshold.is_none())
}

fn tool_removal(
    clock: Res<Clock>,
    looks: Res<ToolLooks>,
    cpu: Res<Cpu>,
    signals: Res<Signals>,
    mut bodies: Query<BodyQuery>,
    mut blocks: Query<BlockQuery>,
) {
    let steps = looks.0;
    for (removals, mut intake, authoring, rest, displacement) in &mut bodies {
        let place = |node: u32| rest.0[node as usize] - removals.reference + displacement.vector(node as usize);
        for (number, removal) in by_rate(removals) {
            let at = INTAKE_NUMBERS * number;
            let mut volume = intake.get(at);
            // nothing is given back
            let of_step = (signals.values()[removal.rate][0] * clock.time_step).max(0.0);
            if intake.get(at + 1) != 0.0 {
                volume += of_step;
            }
            if clock.step.is_multiple_of(steps) {
                let mut found = Vec::new();
                for (&entity, numbers) in authoring.blocks.iter().zip(&removal.numbers) {
                    let Ok(block) = blocks.get(entity) else { continue };
                    let pose = removal.pose_in(&signals);
                    found.extend(in_reach(removal, &pose, (entity, block), numbers, (&cpu, clock.step), place));
                }
                found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                intake.set(at + 1, f64::from(u8::from(!found.is_empty())));
                let (count, mut gone) = (found.len(), 0);
                for (.., entity, row, of_element) in found.into_iter().take(removal.burst as usize) {
                    // what is next waits until there is room for it
                    if of_step <= 0.0 || volume < of_element {
                        break;
                    }
                    volume -= of_element;
                    gone += 1;
                    if let Ok((.., mut due)) = blocks.get_mut(entity) {
                        due[row] = u32::try_from(clock.step).unwrap_or(u32::MAX);
                    }
                }
                // nothing is left in reach: what is more was no tissue
                if gone == count {
                    volume = volume.min(removal.largest + steps as f64 * of_step);
                }
            }
            intake.set(at, volume);
        }
    }
}

/// The elements of a block in a tool's reach, in the order of their rows.
pub(super) fn in_reach(
    removal: &ToolRemoval,
    pose: &Pose,
    (entity, (block, connectivity, shape, alive, due)): (
        Entity,
        (&Block, &Connectivity, &RestShape, &Alive, &RemovalStep),
    ),
    numbers: &[u32],
    (cpu, step): (&Cpu, u64),
    place: impl Fn(u32) -> DVec3 + Sync,
) -> Vec<InReach> {
    let nodes = node_count(block.kind);
    let of_row = |row: usize| -> Option<InReach> {
        if numbers[row] == u32::MAX || alive[row] == 0 || u64::from(due[row]) <= step {
            return None;
        }
        let corners = (0..nodes).map(|corner| place(connectivity[lane_place(row, nodes, corner)]));
        let distance = removal.mouth.distance(pose.inverse(corners.sum::<DVec3>() / nodes as f64));
        if distance > removal.reach {
            return None;
        }
        Some((distance, numbers[row], entity, row, rest_volume(block, row, shape)))
    };
    let rows = |task: usize| (task * ROWS_A_TASK..block.count.min((task + 1) * ROWS_A_TASK)).filter_map(of_row);
    cpu.map(block.count.div_ceil(ROWS_A_TASK), |task| rows(task).collect::<Vec<InReach>>()).concat()
}

/// Where a tool takes elements, as kernels see it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Reach {
    kind: u32,
    size_0: f32,
    size_1: f32,
    size_2: f32,
    size_3: f32,
    size_4: f32,
    size_5: f32,
    rounding: f32,
    pose: u32,
    reach: f32,
}
uniform!(Reach { kind, size_0, size_1, size_2, size_3, size_4, size_5, rounding, pose, reach });

/// The kind of what is a disc.
const DISC: u32 = u32::MAX;

impl Reach {
    fn of(removal: &ToolRemoval) -> Self {
        let (kind, [size_0, size_1, size_2, size_3, size_4, size_5, rounding]) = match &removal.mouth {
            Mouth::Disc(radius) => (DISC, [*radius as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            Mouth::Tool(solid) => {
                let [kind, sizes @ ..] = solid.packed();
                (kind.to_bits(), sizes)
            }
        };
        let (pose, reach) = (removal.pose as u32, removal.reach as f32);
        Self { kind, size_0, size_1, size_2, size_3, size_4, size_5, rounding, pose, reach }
    }
}

/// What is chosen from.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Choice {
    rate: u32,
    intake: u32,
    burst: u32,
    chosen: u32,
    largest: f32,
}
uniform!(Choice { rate, intake, burst, chosen, largest });

/// Where a block's elements find whether they are chosen.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Chosen {
    count: u32,
    chosen: u32,
}
uniform!(Chosen { count, chosen });

/// For each tool: what finds the elements in its reach, block by block; what chooses among them; what marks the chosen.
fn kernels(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let blocks = BlockKernels::of_world(world, buffers);
    let all: Vec<(Entity, ToolRemovals)> =
        world.query::<(Entity, &ToolRemovals)>().iter(world).map(|(body, removals)| (body, removals.clone())).collect();
    let steps = world.resource::<ToolLooks>().0;
    let mut kernels = Vec::new();
    for (body, removals) in all {
        let (Some(authoring), Some(rest)) = (world.get::<Authoring>(body), world.get::<RestPosition>(body)) else {
            debug_assert!(false, "{}", missing("a column of a body"));
            continue;
        };
        let points: Vec<[f32; 3]> = rest.0.iter().map(|&x| (x - removals.reference).as_vec3().to_array()).collect();
        let points = buffers.constants("places of nodes".into(), bytemuck::cast_slice(&points));
        let chosen = ToolRemovals::chosen(authoring.cells.len()) as u32;
        for (number, removal) in by_rate(&removals) {
            let mut marks = Vec::new();
            for (entity, numbers) in authoring.blocks.iter().zip(&removal.numbers) {
                let Some(block) = blocks.iter().find(|block| block.entity == *entity) else { continue };
                let numbers = buffers.constants("numbers of elements".into(), bytemuck::cast_slice(numbers));
                let column = |name: &'static str, buffers: &mut dyn Buffers| buffers.column(*entity, name);
                let reach = buffers.column(body, ToolReach::NAME);
                let due = column(RemovalStep::NAME, buffers);
                let kernel = block
                    .of_columns("tool_removal")
                    .fragment(shader!("tool_removal"))
                    .fragment(shader!("tool_shape"))
                    .fragment(criterion_due(steps))
                    .bind_uniform::<Reach>("reach", buffers.uniform("tool_removal".into(), &Reach::of(removal).bytes()))
                    .bind(Displacement::NAME, buffers.column(body, Displacement::NAME))
                    .bind(RestShape::NAME, column(RestShape::NAME, buffers))
                    .bind(Alive::NAME, column(Alive::NAME, buffers))
                    .bind(RemovalStep::NAME, due)
                    .bind(ToolReach::NAME, reach)
                    .bind("rest_points", points)
                    .bind("numbers", numbers);
                kernels.push(with_step(kernel, world));
                let count = block.block.count as u32;
                let due_of = buffers.uniform("tool_removal_due".into(), &Chosen { count, chosen }.bytes());
                let mark = Kernel::new("tool_removal_due", "tool_removal_due")
                    .fragment(shader!("tool_removal_due"))
                    .fragment(shader!("row"))
                    .fragment(criterion_due(steps))
                    .threads(count)
                    .bind_uniform::<Chosen>("due", due_of)
                    .bind(RemovalStep::NAME, due)
                    .bind(ToolReach::NAME, reach)
                    .bind("numbers", numbers);
                marks.push(with_step(mark, world));
            }
            let choose = Kernel::new("tool_removal_choice", "tool_removal_choice")
                .fragment(shader!("tool_removal_choice"))
                .fragment(criterion_due(steps))
                .bind_uniform::<Choice>("choice", choice((removal, number), chosen, buffers))
                .bind(ToolIntake::NAME, buffers.column(body, ToolIntake::NAME))
                .bind(ToolReach::NAME, buffers.column(body, ToolReach::NAME))
                .threads(64);
            kernels.push(with_step(choose, world));
            kernels.append(&mut marks);
        }
    }
    kernels
}

fn choice((removal, number): (&ToolRemoval, usize), chosen: u32, buffers: &mut dyn Buffers) -> BufferId {
    let intake = (INTAKE_NUMBERS * number) as u32;
    let (rate, burst, largest) = (removal.rate as u32, removal.burst, removal.largest as f32);
    let choice = Choice { rate, intake, burst, chosen, largest };
    buffers.uniform("choice of tool_removal".into(), &choice.bytes())
}

/// Whether the criterion is due where a step ends, in every so many.
fn criterion_due(steps: u64) -> Fragment {
    let text = format!(
        "const CRITERION_STEPS: u32 = {steps}u;\n\
         fn step_that_comes() -> u32 {{\n    return max(step.number, step.number + 1u);\n}}\n\
         fn criterion_due() -> bool {{\n    return step_that_comes() % CRITERION_STEPS == 0u;\n}}\n"
    );
    Fragment::new("generated: when the criterion is due", text)
}
