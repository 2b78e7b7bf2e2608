//! The kernels of contact between surfaces. In a step, for each body: where its surface is
//! (`shaders/surface_contact_place.wgsl`), where it would go (`surface_contact_foresee`), what it faces
//! (`surface_contact`). Then in each sweep for all: normal forces (`surface_contact_impulse`), what they do to nodes
//! (`surface_contact_apply`), and the same with `surface_contact_friction` where there is any. At last, for each body:
//! its loads (`surface_contact_push`), and what is kept of contacts (`surface_contact_touch`).

use super::SurfaceContacts;
use super::device::{MOTION_WORDS, SurfaceContact, find, is_on_device, note};
use super::gather::OUT;
use super::meet::{FACES, FREE, SLIDES, STICKS};
use crate::backend::Buffers;
use crate::backend::kernel::{BufferId, Fragment, Kernel, Uniform, uniform};
use crate::backend::step::with_step;
use crate::components::*;
use crate::shader;
use crate::systems::integrate::damping_fragment;
use bevy_ecs::prelude::*;

/// A body's part of the surfaces.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct SurfaceBody {
    first: u32,
    count: u32,
    displacements: u32,
}
uniform!(SurfaceBody { first, count, displacements });

/// Buffers that all have.
struct Shared {
    surface: BufferId,
    faces: BufferId,
    lists: BufferId,
    motion: BufferId,
    nodes: BufferId,
    rows: BufferId,
    contacts: BufferId,
}

impl Shared {
    /// A kernel that goes through surfaces and lists.
    fn kernel(&self, entry: &'static str, text: Fragment, surface: BufferId, world: &World) -> Kernel {
        let kernel = Kernel::new(entry, entry)
            .fragment(text)
            .fragment(shader!("surface_lists"))
            .fragment(shader!("row"))
            .bind_uniform::<SurfaceContact>("surface", surface)
            .bind("surface_faces", self.faces)
            .bind("surface_lists", self.lists)
            .bind("surface_motion", self.motion)
            .bind("surface_contacts", self.contacts);
        with_step(kernel, world)
    }

    /// With where nodes are, and where they go.
    fn with_nodes(&self, kernel: Kernel) -> Kernel {
        kernel.bind("surface_nodes", self.nodes)
    }

    /// One that goes through the contacts of nodes.
    fn of_contacts(&self, entry: &'static str, text: Fragment, surface: BufferId, world: &World) -> Kernel {
        let kernel = self.kernel(entry, text, surface, world);
        kernel.fragment(shader!("surface_contacts_of")).fragment(shader!("surface_motion"))
    }
}

/// Constants of what is kept of a point, the same here and there.
fn touch_constants() -> Fragment {
    let states = [("FREE", FREE), ("FACES", FACES), ("STICKS", STICKS), ("SLIDES", SLIDES), ("OUT", OUT)];
    let states = states.map(|(name, number)| format!("const {name}: f32 = {number:?};\n")).concat();
    let text = format!("const TOUCH_NUMBERS: u32 = {MEETING_NUMBERS}u;\n{states}");
    Fragment::new("generated: what is kept of a point", text)
}

/// See the module.
pub(super) fn kernels(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    // who only describes kernels leaves alone what those that run go by
    let of_device = buffers.are_of_device();
    if of_device || !is_on_device(world) {
        find(world);
    }
    let Some(contacts) = world.get_resource::<SurfaceContacts>() else { return Vec::new() };
    let whole = contacts.uniform(world.resource::<Clock>());
    let nodes = contacts.surface.nodes.len();
    let words = |words: Vec<u32>| bytemuck::cast_slice::<u32, u8>(&words).to_vec();
    let shared = Shared {
        surface: buffers.uniform("surface_contact".into(), &whole.bytes()),
        faces: buffers.constants("triangles of surfaces".into(), &words(contacts.faces())),
        lists: buffers.constants("lists of what may be near what".into(), &words(contacts.list_words(world))),
        motion: buffers.constants("motion of surfaces".into(), &[0; 4 * MOTION_WORDS]),
        nodes: buffers.constants("nodes of surfaces".into(), &vec![0; 4 * 12 * nodes]),
        rows: buffers.constants("rows of surfaces".into(), &words(contacts.rows(world))),
        contacts: buffers.constants("contacts".into(), &vec![0; 4 * 24 * 2 * nodes]),
    };
    let contacts = contacts.clone();
    if of_device {
        note(shared.lists, shared.motion, world);
    }
    let of_bodies: Vec<(Entity, SurfaceContact)> = (0..)
        .zip(&contacts.bodies)
        .map(|(body, &entity)| {
            let first = contacts.surface.nodes.partition_point(|(other, _)| *other < body) as u32;
            let end = contacts.surface.nodes.partition_point(|(other, _)| *other <= body) as u32;
            (entity, whole.of_body(body, first, end - first))
        })
        .collect();
    let uniforms: Vec<BufferId> =
        of_bodies.iter().map(|(_, of)| buffers.uniform("surface_contact of a body".into(), &of.bytes())).collect();
    let mut all = Vec::new();
    for (body, of) in &of_bodies {
        all.extend(before(&shared, *body, *of, whole, world, buffers));
    }
    for ((body, of), &surface) in of_bodies.iter().zip(&uniforms) {
        let kernel = shared.kernel("surface_contact", shader!("surface_contact"), surface, world);
        all.push(
            shared
                .with_nodes(kernel)
                .fragment(touch_constants())
                .fragment(shader!("surface_facing"))
                .fragment(shader!("contact_spring"))
                .fragment(shader!("surface_motion_turns"))
                .bind("surface_rows", shared.rows)
                .bind(SurfaceTouch::NAME, buffers.column(*body, SurfaceTouch::NAME))
                .threads(of.count),
        );
    }
    let sweep = |entry, text, threads| {
        shared.with_nodes(shared.of_contacts(entry, text, shared.surface, world)).threads(threads).repeated()
    };
    let (apply, pairs) = ("surface_contact_apply", 2 * nodes as u32);
    all.push(sweep("surface_contact_impulse", shader!("surface_contact_impulse"), pairs));
    all.push(sweep(apply, shader!("surface_contact_apply"), nodes as u32));
    if contacts.has_friction() {
        all.push(sweep("surface_contact_friction", shader!("surface_contact_friction"), pairs));
        all.push(sweep(apply, shader!("surface_contact_apply"), nodes as u32));
    }
    for ((body, of), &surface) in of_bodies.iter().zip(&uniforms) {
        let push = shared.of_contacts("surface_contact_push", shader!("surface_contact_push"), surface, world);
        all.push(
            push.bind("surface_rows", shared.rows)
                .bind(ExternalForce::NAME, buffers.column(*body, ExternalForce::NAME))
                .bind(ContactForce::NAME, buffers.column(*body, ContactForce::NAME))
                .threads(of.count),
        );
        let touch = shared.of_contacts("surface_contact_touch", shader!("surface_contact_touch"), surface, world);
        all.push(
            shared
                .with_nodes(touch)
                .fragment(touch_constants())
                .bind("surface_rows", shared.rows)
                .bind(SurfaceTouch::NAME, buffers.column(*body, SurfaceTouch::NAME))
                .threads(of.count),
        );
    }
    all
}

/// Where a body's surface is, and where it would go.
fn before(
    shared: &Shared,
    body: Entity,
    of: SurfaceContact,
    whole: SurfaceContact,
    world: &World,
    buffers: &mut dyn Buffers,
) -> [Kernel; 2] {
    let of_body = SurfaceBody { first: of.first, count: of.count, displacements: whole.displacements };
    let of_body = buffers.uniform("surface of a body".into(), &of_body.bytes());
    let place = Kernel::new("surface_contact_place", "surface_contact_place")
        .fragment(shader!("surface_contact_place"))
        .fragment(shader!("row"))
        .bind_uniform::<SurfaceBody>("body", of_body)
        .threads(of.count);
    let place = with_step(place, world)
        .bind("surface_rows", shared.rows)
        .bind("surface_nodes", shared.nodes)
        .bind("surface_lists", shared.lists)
        .bind("surface_motion", shared.motion)
        .bind(Displacement::NAME, buffers.column(body, Displacement::NAME))
        .bind(DisplacementIncrement::NAME, buffers.column(body, DisplacementIncrement::NAME));
    let nodes = ForeseenNodes { rows: shared.rows, nodes: shared.nodes, of_body, count: of.count };
    [place, nodes.foresee("surface_contact_foresee", body, world, buffers)]
}

/// Nodes of a body whose next steps are wanted.
pub(in crate::systems) struct ForeseenNodes {
    /// Four words a node: its row, and three of whoever asks.
    rows: BufferId,
    /// Twelve numbers a node: three of whoever asks, the next step, the last step, which must be there already, and the
    /// response to forces.
    nodes: BufferId,
    /// A [`SurfaceBody`].
    of_body: BufferId,
    count: u32,
}

impl ForeseenNodes {
    /// Of a body's so many nodes, from the first on.
    pub fn new([rows, nodes]: [BufferId; 2], [first, count]: [u32; 2], buffers: &mut dyn Buffers) -> Self {
        let of_body = SurfaceBody { first, count, displacements: 0 };
        Self { rows, nodes, of_body: buffers.uniform("nodes of a body".into(), &of_body.bytes()), count }
    }

    /// The kernel that finds next steps and responses.
    pub fn foresee(&self, label: &str, body: Entity, world: &World, buffers: &mut dyn Buffers) -> Kernel {
        let damped = world.get::<DampingCoefficient>(body).is_some();
        let relaxed = world.resource::<Clock>().relaxation.is_some();
        let mass = if world.get::<FictitiousMass>(body).is_some() { FictitiousMass::NAME } else { Mass::NAME };
        let foresee = Kernel::new(label, "surface_contact_foresee")
            .fragment(shader!("surface_contact_foresee"))
            .fragment(shader!("row"))
            .fragment(damping_fragment(damped, relaxed))
            .bind_uniform::<SurfaceBody>("body", self.of_body)
            .bind("surface_rows", self.rows)
            .bind("surface_nodes", self.nodes)
            .bind(Mass::NAME, buffers.column(body, mass))
            .threads(self.count);
        let columns = [ConstrainedAxes::NAME, InternalForce::NAME, ExternalForce::NAME];
        let columns = columns.into_iter().chain(damped.then_some(DampingCoefficient::NAME));
        let foresee = columns.fold(foresee, |kernel, name| kernel.bind(name, buffers.column(body, name)));
        with_step(foresee, world)
    }
}
