//! `suction_mouth`: which faces tools suck, and by what pressure. `shaders/suction_mouth.wgsl` is its twin, with
//! `shaders/suction_presence.wgsl`, `shaders/suction_hidden.wgsl`, `shaders/suction_nodes.wgsl` and
//! `shaders/suction_pressure.wgsl`.

use super::suction::parts_of;
use super::system::{Phase, System};
use crate::backend::Buffers;
use crate::backend::block_kernel::BlockKernels;
use crate::backend::kernel::{BufferId, Fragment, Kernel, Uniform, uniform};
use crate::backend::step::with_step;
use crate::components::*;
use crate::error::{Error, missing};
use crate::shader;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Exposed faces in the mouth that are turned to it are sucked, those at its edge by the share that is within. As often
/// as [`ToolLooks`] says it is looked which those are, and what share χ of the mouth they close, seen along its axis,
/// with those of other bodies that the tool sucks at by the same mouth. An open mouth leaks: the pressure goes to Δp
/// χ², and follows in the time that the scene names.
///
/// A face is exposed while its element is there and its neighbour's is not: what removal bares is sucked at once.
pub fn system() -> System {
    let system = System::built_in(
        "suction_mouth",
        Phase::Boundary,
        "finds the faces that tools suck, and by what pressure",
        "an entry under `suction`",
        |world| super::registry::count::<Suction>(world, "tool that sucks", "tools that suck"),
        suction_mouth,
    );
    System { device_when: is_of_one_body, ..system.on_device(kernels) }
}

type BodyQuery<'a> = (&'a Authoring, &'a RestPosition, &'a Displacement, &'a mut SuctionMarks, &'a mut SuctionPressure);

/// Whether no mouth is of several bodies, which the host adds up.
fn is_of_one_body(world: &World) -> bool {
    let Some(mut all) = world.try_query::<&Suction>() else { return false };
    let mut seen = BTreeSet::new();
    all.iter(world).all(|suction| seen.insert(suction.mouth))
}

fn suction_mouth(
    clock: Res<Clock>,
    looks: Res<ToolLooks>,
    signals: Res<Signals>,
    mut all: Query<(&mut Suction, &OfBody)>,
    mut bodies: Query<BodyQuery>,
    blocks: Query<Option<&Alive>, With<Block>>,
) -> Result<(), Error> {
    let is_due = clock.step.is_multiple_of(looks.0);
    // what is seen in each mouth, and what share of that bodies close
    let mut seen: BTreeMap<usize, Vec<Seen>> = BTreeMap::new();
    let mut shares: BTreeMap<usize, f64> = BTreeMap::new();
    for (suction, body) in all.iter().filter(|_| is_due) {
        let Ok((authoring, rest, displacement, ..)) = bodies.get(body.0) else {
            return Err(missing("a column of a body"));
        };
        let of_block = |&block: &Entity| blocks.get(block).ok().flatten().map(|alive| alive.0.as_slice());
        let alive: Vec<Option<&[u32]>> = authoring.blocks.iter().map(of_block).collect();
        let is_there = |face: usize| {
            let (block, row) = suction.faces.elements[face];
            alive[block as usize].is_none_or(|alive| alive[row as usize] == 1)
        };
        let pose = suction.pose_in(&signals);
        let place =
            |node: u32| pose.inverse(rest.0[node as usize] - suction.reference + displacement.vector(node as usize));
        seen.entry(suction.mouth).or_default().extend(seen_by(suction, body.0, is_there, place));
    }
    for (suction, body) in all.iter().filter(|_| is_due) {
        let Ok((_, rest, displacement, mut marks, _)) = bodies.get_mut(body.0) else {
            return Err(missing("a column of a body"));
        };
        let Some(seen) = seen.get(&suction.mouth) else { continue };
        let first = suction.first_mark();
        mark(suction, body.0, seen, &mut marks[first..first + suction.faces.words()]);
        let place = |node: u32| rest.0[node as usize] + displacement.vector(node as usize);
        *shares.entry(suction.mouth).or_default() +=
            closed(suction, &suction.pose_in(&signals), place, &marks[first..]);
    }
    for (mut suction, body) in &mut all {
        let Ok((.., marks, mut pressures)) = bodies.get_mut(body.0) else { return Err(missing("a column of a body")) };
        if let Some(share) = shares.get(&suction.mouth) {
            pressures.set(suction.share_at(), share.min(1.0));
        }
        let (at, share) = (SUCTION_NUMBERS * suction.number, pressures.get(suction.share_at()));
        let wanted = signals.values()[suction.pressure][0] * share * share;
        let now = pressures.get(at);
        pressures.set(at, now + follows(suction.delay, clock.time_step) * (wanted - now));
        if is_due {
            suction.renew(&marks, &pressures);
        } else {
            suction.now = pressures.get(at);
        }
    }
    Ok(())
}

/// By what share pressure comes nearer in a step (s) to what it goes to.
fn follows(delay: f64, time_step: f64) -> f64 {
    if delay > time_step { time_step / delay } else { 1.0 }
}

/// A face that is in a mouth, seen along its axis.
struct Seen {
    body: Entity,
    face: usize,
    /// The share of it that is.
    share: f32,
    /// Its corners in the tool's frame (m).
    corners: [DVec3; 4],
}

/// The faces of a body that are in the mouth; some of them may hide others.
fn seen_by(
    suction: &Suction,
    body: Entity,
    is_there: impl Fn(usize) -> bool,
    place: impl Fn(u32) -> DVec3,
) -> impl Iterator<Item = Seen> {
    let faces = &suction.faces;
    (0..faces.len()).filter_map(move |face| {
        let opposite = faces.opposites[face];
        if !is_there(face) || opposite != NO_FACE && is_there(opposite as usize) {
            return None;
        }
        let corners = faces.corners[face].map(&place);
        let share = suction.share_in_mouth(corners);
        (share > 0.0).then_some(Seen { body, face, share, corners })
    })
}

/// Marks the faces of a body that are sucked, which no other hides, then their nodes.
fn mark(suction: &Suction, body: Entity, seen: &[Seen], marks: &mut [u32]) {
    let faces = &suction.faces;
    let (of_faces, of_nodes) = marks.split_at_mut(faces.len());
    of_faces.fill(0);
    for Seen { face, share, corners, .. } in seen.iter().filter(|seen| seen.body == body) {
        // warped, a face would be before itself
        let hides =
            |other: &Seen| (other.body, other.face) != (body, *face) && suction.is_hidden(corners, &other.corners);
        if !seen.iter().any(hides) {
            of_faces[*face] = share.to_bits();
        }
    }
    let parts = &faces.parts;
    for (i, mark) in of_nodes.iter_mut().enumerate() {
        let corners = &parts.corners[parts.starts[i] as usize..parts.starts[i + 1] as usize];
        let sucked = |corner: &u32| of_faces[faces.of_part[*corner as usize / 4] as usize] != 0;
        *mark = u32::from(corners.iter().any(sucked));
    }
}

/// The share of the mouth that marked faces close, seen along its axis: from 0 to 1.
fn closed(suction: &Suction, pose: &Pose, place: impl Fn(u32) -> DVec3, marks: &[u32]) -> f64 {
    let (faces, axis) = (&suction.faces, pose.rotation.z_axis);
    let mut sum = 0.0;
    for ((nodes, weight), &face) in faces.parts.faces.iter().zip(&faces.parts.weights).zip(&faces.of_part) {
        if marks[face as usize] != 0 {
            let [a, b, c, d] = nodes.map(&place);
            sum += share(marks[face as usize]) * weight * 0.5 * (c - a).cross(d - b).dot(axis);
        }
    }
    (sum / mouth_area(suction)).clamp(0.0, 1.0)
}

fn mouth_area(suction: &Suction) -> f64 {
    std::f64::consts::PI * suction.bore * suction.bore
}

/// A mouth as kernels see it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct SuctionMouth {
    faces: u32,
    nodes: u32,
    parts: u32,
    first: u32,
    numbers: u32,
    pose: u32,
    pressure: u32,
    bore: f32,
    reach: f32,
    delay: f32,
    area: f32,
}
uniform!(SuctionMouth { faces, nodes, parts, first, numbers, pose, pressure, bore, reach, delay, area });

/// The elements whose faces are there or not.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Presence {
    count: u32,
}
uniform!(Presence { count });

/// For each body what tells which faces are there, block by block; for each tool what finds faces in the mouth, what
/// marks those that no other hides, what marks nodes, and what finds the pressure.
fn kernels(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let blocks = BlockKernels::of_world(world, buffers);
    let all: Vec<(Suction, Entity)> =
        world.query::<(&Suction, &OfBody)>().iter(world).map(|(suction, body)| (suction.clone(), body.0)).collect();
    let looks = *world.resource::<ToolLooks>();
    let mut kernels = Vec::new();
    let mut seen: Vec<Entity> = Vec::new();
    for (suction, body) in all {
        let (Some(authoring), Some(rest)) = (world.get::<Authoring>(body), world.get::<RestPosition>(body)) else {
            debug_assert!(false, "{}", missing("a column of a body"));
            continue;
        };
        if !seen.contains(&body) {
            seen.push(body);
            for (place, &entity) in (0..).zip(&authoring.blocks) {
                let block = blocks.iter().find(|block| block.entity == entity);
                if let Some(block) = block.filter(|_| world.get::<Alive>(entity).is_some()) {
                    kernels.push(with_step(presence(block, (place, looks), &suction.faces, buffers), world));
                }
            }
        }
        let points: Vec<[f32; 3]> = rest.0.iter().map(|&x| (x - suction.reference).as_vec3().to_array()).collect();
        let of_tool = OfTool {
            body,
            points: buffers.constants("places of nodes".into(), bytemuck::cast_slice(&points)),
            mouth: mouth(&suction, buffers),
            suction,
            looks,
        };
        kernels.extend(of_tool.kernels(buffers).map(|kernel| with_step(kernel, world)));
    }
    kernels
}

fn mouth(suction: &Suction, buffers: &mut dyn Buffers) -> BufferId {
    let mouth = SuctionMouth {
        faces: suction.faces.len() as u32,
        nodes: suction.faces.parts.rows.len() as u32,
        parts: suction.faces.parts.faces.len() as u32,
        first: suction.first_mark() as u32,
        numbers: (SUCTION_NUMBERS * suction.number) as u32,
        pose: suction.pose as u32,
        pressure: suction.pressure as u32,
        bore: suction.bore as f32,
        reach: suction.reach as f32,
        delay: suction.delay as f32,
        area: mouth_area(suction) as f32,
    };
    buffers.uniform("mouth of suction".into(), &mouth.bytes())
}

/// Where each row of a block has its faces, and which of them are there.
fn presence(
    block: &BlockKernels,
    (place, looks): (u32, ToolLooks),
    faces: &BodyFaces,
    buffers: &mut dyn Buffers,
) -> Kernel {
    let mut of_rows: Vec<(u32, u32)> =
        (0..).zip(&faces.elements).filter(|(_, of)| of.0 == place).map(|(face, of)| (of.1, face)).collect();
    of_rows.sort_unstable();
    let start = |row: usize| of_rows.partition_point(|&(of, _)| (of as usize) < row) as u32;
    let count = block.block.count;
    let starts = (0..=count).map(|row| start(row) + count as u32 + 1);
    let lists: Vec<u32> = starts.chain(of_rows.iter().map(|&(_, face)| face)).collect();
    let presence = buffers.uniform("suction_presence".into(), &Presence { count: count as u32 }.bytes());
    Kernel::new("suction_presence", "suction_presence")
        .fragment(shader!("suction_presence"))
        .fragment(shader!("row"))
        .fragment(criterion_due(looks))
        .threads(count as u32)
        .bind_uniform::<Presence>("presence", presence)
        .bind("faces_of_elements", buffers.constants("faces of elements".into(), bytemuck::cast_slice(&lists)))
        .bind(Alive::NAME, buffers.column(block.entity, Alive::NAME))
        .bind(FacePresence::NAME, buffers.column(block.block.body, FacePresence::NAME))
}

/// What the kernels of a tool have in common.
struct OfTool {
    body: Entity,
    points: BufferId,
    mouth: BufferId,
    suction: Suction,
    looks: ToolLooks,
}

impl OfTool {
    fn kernel(&self, entry: &'static str, shader: Fragment) -> Kernel {
        Kernel::new(entry, entry)
            .fragment(shader)
            .fragment(shader!("suction_tool"))
            .fragment(shader!("row"))
            .fragment(criterion_due(self.looks))
            .bind_uniform::<SuctionMouth>("mouth", self.mouth)
    }

    fn kernels(&self, buffers: &mut dyn Buffers) -> [Kernel; 4] {
        let faces = &self.suction.faces;
        let of_faces: Vec<[u32; 5]> = faces
            .corners
            .iter()
            .zip(&faces.opposites)
            .map(|(&[a, b, c, d], &opposite)| [a, b, c, d, opposite])
            .collect();
        let of_faces = buffers.constants("faces of a body".into(), bytemuck::cast_slice(&of_faces));
        let lists: Vec<u32> = faces.parts.starts.iter().map(|start| start + faces.parts.starts.len() as u32).collect();
        let of_corner = |corner: &u32| faces.of_part[*corner as usize / 4];
        let lists: Vec<u32> = lists.into_iter().chain(faces.parts.corners.iter().map(of_corner)).collect();
        let lists = buffers.constants("faces of nodes".into(), bytemuck::cast_slice(&lists));
        let parts = buffers.constants("parts of faces".into(), bytemuck::cast_slice(&parts_of(faces)));
        let displacement = buffers.column(self.body, Displacement::NAME);
        let shares = buffers.constants("shares of faces in a mouth".into(), &vec![0; 4 * faces.len()]);
        let of_each_face = |kernel: Kernel| {
            kernel
                .fragment(shader!("suction_faces"))
                .fragment(Fragment::new(
                    "generated: how steep faces stand, and how near layers are",
                    format!("const STEEP: f32 = {STEEP:?};\nconst APART: f32 = {APART:?};\n"),
                ))
                .bind("faces", of_faces)
                .bind("rest_points", self.points)
                .bind(Displacement::NAME, displacement)
                .bind("shares_in_mouth", shares)
                .threads(faces.len() as u32)
        };
        [
            of_each_face(self.kernel("suction_mouth", shader!("suction_mouth")))
                .bind(FacePresence::NAME, buffers.column(self.body, FacePresence::NAME)),
            of_each_face(self.kernel("suction_hidden", shader!("suction_hidden")))
                .bind(SuctionMarks::NAME, buffers.column(self.body, SuctionMarks::NAME)),
            self.kernel("suction_nodes", shader!("suction_nodes"))
                .bind(SuctionMarks::NAME, buffers.column(self.body, SuctionMarks::NAME))
                .bind("faces_of_nodes", lists)
                .threads(faces.parts.rows.len() as u32),
            self.kernel("suction_pressure_of", shader!("suction_pressure"))
                .bind(SuctionMarks::NAME, buffers.column(self.body, SuctionMarks::NAME))
                .bind("parts", parts)
                .bind("rest_points", self.points)
                .bind(Displacement::NAME, displacement)
                .bind(SuctionPressure::NAME, buffers.column(self.body, SuctionPressure::NAME))
                .threads(256),
        ]
    }
}

/// Whether the criterion is due where a step begins.
fn criterion_due(looks: ToolLooks) -> Fragment {
    let text = format!("fn criterion_due() -> bool {{\n    return step.number % {}u == 0u;\n}}\n", looks.0);
    Fragment::new("generated: when the criterion is due", text)
}
