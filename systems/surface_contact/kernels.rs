//! The kernels of contact between surfaces. In a step, for each body: where its surface is
//! (`shaders/surface_contact_place.wgsl`), where it would go (`surface_contact_foresee`, and `surface_contact_hold`
//! where tools may hold it), what its nodes and points of its faces face (`surface_contact`). Then for all: which edges
//! cross (`surface_contact_edges`), into how many shares masses are split (`surface_contact_share`), and in each sweep
//! normal forces (`surface_contact_impulse`), what they do to nodes (`surface_contact_apply`), and the same with
//! `surface_contact_friction` where there is any. At last, for each body: its loads and what contact takes of it
//! (`surface_contact_push`), and what is kept of contacts (`surface_contact_touch`).

use super::device::{MOTION_WORDS, SurfaceContact, find, is_on_device, note};
use super::gather::OUT;
use super::{Meeting, SurfaceContacts};
use crate::backend::Buffers;
use crate::backend::kernel::{BufferId, Fragment, Kernel, Uniform, uniform};
use crate::backend::step::with_step;
use crate::components::*;
use crate::shader;
use crate::systems::integrate::damping_fragment;
use crate::systems::tool_contact::STILL;
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

/// Numbers of a node whose next step is wanted: see [`ForeseenNodes`].
pub(in crate::systems) const FORESEEN_NUMBERS: usize = 16;

/// Words of a contact beside its nodes and weights, as in `shaders/surface_contacts.wgsl`.
const CONTACT_WORDS: usize = 19;

/// Buffers that kernels share.
struct Shared {
    faces: BufferId,
    lists: BufferId,
    motion: BufferId,
    nodes: BufferId,
    rows: BufferId,
    contacts: BufferId,
    /// Nodes of a contact at most.
    parts: usize,
    /// Whether edges meet.
    edges: bool,
}

impl Shared {
    /// A kernel of contacts, for whom its uniform says.
    fn kernel(&self, entry: &'static str, text: Fragment, surface: BufferId, world: &World) -> Kernel {
        let parts = format!("const PARTS: u32 = {}u;\n", self.parts);
        let kernel = Kernel::new(entry, entry)
            .fragment(text)
            .fragment(shader!("surface_lists"))
            .fragment(shader!("surface_contacts"))
            .fragment(Fragment::new("generated: nodes of a contact", parts))
            .fragment(shader!("row"))
            .bind_uniform::<SurfaceContact>("surface", surface)
            .bind("surface_contacts", self.contacts);
        with_step(kernel, world)
    }

    /// With where nodes are, and where they go.
    fn with_nodes(&self, kernel: Kernel) -> Kernel {
        kernel.bind("surface_nodes", self.nodes)
    }

    /// With what may be near what, as long as that holds.
    fn with_lists(&self, kernel: Kernel) -> Kernel {
        kernel.bind("surface_lists", self.lists).bind("surface_motion", self.motion)
    }

    /// That asks how points go against what they face.
    fn relative(&self, kernel: Kernel) -> Kernel {
        self.with_nodes(kernel.fragment(shader!("surface_relative")).fragment(shader!("surface_motion")))
    }

    /// That goes through the contacts of nodes.
    fn of_nodes(&self, kernel: Kernel) -> Kernel {
        self.with_lists(kernel).fragment(shader!("surface_contacts_of"))
    }

    /// That finds contacts.
    fn begins(&self, kernel: Kernel) -> Kernel {
        let kernel = kernel.fragment(shader!("surface_contact_begin")).fragment(shader!("surface_facing"));
        self.with_nodes(self.with_lists(kernel)).fragment(shader!("contact_spring")).bind("surface_faces", self.faces)
    }

    /// With what is kept of points of a kind.
    fn with_touch(&self, kernel: Kernel, points: &Points, buffers: &mut dyn Buffers) -> Kernel {
        let did = [("FREE", Did::Free), ("FACES", Did::Faces), ("STICKS", Did::Sticks), ("SLIDES", Did::Slides)];
        let did = did.map(|(name, did)| (name, PointState { did, in_corner: false }.number()));
        let numbers =
            did.into_iter().chain([("IN_CORNER", PointState::IN_CORNER.into()), ("OUT", OUT), ("STILL", STILL)]);
        let states: String = numbers.map(|(name, number)| format!("const {name}: f32 = {number:?};\n")).collect();
        let (rows, place) = match points.of_faces {
            true => ("", "point - surface.first"),
            false => {
                ("@group(0) @binding(0) var<storage, read> surface_rows: array<u32>;\n", "surface_rows[4u * point]")
            }
        };
        let text = format!(
            "const TOUCH_NUMBERS: u32 = {MEETING_NUMBERS}u;\n{states}{rows}fn touch_of(point: u32) -> u32 {{\n    \
             return TOUCH_NUMBERS * ({place});\n}}\n"
        );
        let kernel = kernel.fragment(Fragment::new("generated: what is kept of a point", text));
        let name = if points.of_faces { FaceTouch::NAME } else { SurfaceTouch::NAME };
        let kernel = kernel.bind(SurfaceTouch::NAME, buffers.column(points.body, name));
        if points.of_faces { kernel } else { kernel.bind("surface_rows", self.rows) }
    }

    /// What points of a body face.
    fn face(&self, points: &Points, world: &World, buffers: &mut dyn Buffers) -> Kernel {
        let kernel = self.kernel("surface_contact", shader!("surface_contact"), points.surface, world);
        let what = if points.of_faces { shader!("surface_point_face") } else { shader!("surface_point_node") };
        let kernel =
            self.begins(kernel).fragment(shader!("surface_faced")).fragment(shader!("surface_ends")).fragment(what);
        let kernel = kernel.fragment(shader!("surface_motion"));
        self.with_touch(kernel, points, buffers).threads(points.of.count)
    }

    /// What is kept of them.
    fn touch(&self, points: &Points, world: &World, buffers: &mut dyn Buffers) -> Kernel {
        let text = shader!("surface_contact_touch");
        let kernel = self.relative(self.kernel("surface_contact_touch", text, points.surface, world));
        let kernel = match self.edges && !points.of_faces {
            true => self.with_lists(kernel).fragment(shader!("surface_touch_edges")).bind("surface_faces", self.faces),
            false => kernel.fragment(Fragment::new(
                "generated: no edges begin at a point",
                "fn note_edges(point: u32, at: u32) {}\n",
            )),
        };
        self.with_touch(kernel, points, buffers).threads(points.of.count)
    }
}

/// Nodes of a body, or points of its faces.
struct Points {
    body: Entity,
    of_faces: bool,
    /// Whether they may face others.
    face: bool,
    of: SurfaceContact,
    surface: BufferId,
}

impl Points {
    /// Those that have anything kept, of a body with such a number.
    fn of_body(contacts: &SurfaceContacts, body: usize, whole: SurfaceContact, buffers: &mut dyn Buffers) -> Vec<Self> {
        let (surface, nodes) = (&contacts.surface, contacts.surface.nodes.len());
        let of_row = &contacts.meetings[body * contacts.bodies.len()..(body + 1) * contacts.bodies.len()];
        let meets = |is: fn(&Meeting) -> bool| of_row.iter().flatten().any(is);
        let kinds = [(false, meets(|of| !of.faces), meets(|of| of.edges)), (true, meets(|of| of.faces), false)];
        let mut all = Vec::new();
        for (of_faces, face, kept) in kinds {
            let points = if of_faces { &surface.points[nodes..] } else { &surface.points[..nodes] };
            let first = points.partition_point(|point| (point.body as usize) < body);
            let count = points.partition_point(|point| point.body as usize <= body) - first;
            if (face || kept) && count > 0 {
                let first = if of_faces { nodes + first } else { first };
                let of = whole.of_body(body as u32, first as u32, count as u32);
                let uniform = buffers.uniform("surface_contact of a body".into(), &of.bytes());
                all.push(Self { body: contacts.bodies[body], of_faces, face, of, surface: uniform });
            }
        }
        all
    }
}

/// See the module.
pub(super) fn kernels(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    // who only describes kernels leaves alone what those that run go by
    let of_device = buffers.are_of_device();
    if of_device || !is_on_device(world) {
        find(world);
    }
    let Some(contacts) = world.get_resource::<SurfaceContacts>() else { return Vec::new() };
    let faces = contacts.face_words();
    let whole = contacts.uniform(&faces, world.resource::<Clock>());
    let nodes = contacts.surface.nodes.len();
    let parts = if contacts.surface.points.len() > nodes { 8 } else { 4 };
    let words = |words: Vec<u32>| bytemuck::cast_slice::<u32, u8>(&words).to_vec();
    let shared = Shared {
        faces: buffers.constants("triangles of surfaces".into(), &words(faces.words)),
        lists: buffers.constants("lists of what may be near what".into(), &words(contacts.list_words(world).whole())),
        motion: buffers.constants("motion of surfaces".into(), &[0; 4 * MOTION_WORDS]),
        nodes: buffers.constants("nodes of surfaces".into(), &vec![0; 4 * FORESEEN_NUMBERS * nodes]),
        rows: buffers.constants("rows of surfaces".into(), &words(contacts.row_words(world))),
        contacts: {
            let count = whole.contacts as usize;
            buffers.constants("contacts".into(), &vec![0; 4 * (CONTACT_WORDS + 2 * parts) * count])
        },
        parts,
        edges: !contacts.surface.crossings.edges.is_empty(),
    };
    let contacts = contacts.clone();
    if of_device {
        note(shared.lists, shared.motion, world);
    }
    let world = &*world;
    let bodies = 0..contacts.bodies.len();
    let points: Vec<Points> =
        bodies.clone().flat_map(|body| Points::of_body(&contacts, body, whole, buffers)).collect();
    let mut all = Vec::new();
    let of_bodies: Vec<(Entity, SurfaceContact)> = bodies
        .map(|body| {
            let of = |is: fn(u32, u32) -> bool| {
                contacts.surface.nodes.partition_point(|(other, _)| is(*other, body as u32)) as u32
            };
            let (first, end) = (of(|other, body| other < body), of(|other, body| other <= body));
            (contacts.bodies[body], whole.of_body(body as u32, first, end - first))
        })
        .collect();
    for (number, &(body, of)) in of_bodies.iter().enumerate() {
        let (kernels, foreseen) = before(&shared, body, of, world, buffers);
        all.extend(kernels);
        let node = |row| contacts.surface.nodes.binary_search(&(number as u32, row)).ok().map(|node| node as u32);
        all.extend(foreseen.hold("surface_contact_hold", body, node, world, buffers));
    }
    all.extend(points.iter().filter(|points| points.face).map(|points| shared.face(points, world, buffers)));
    let surface = buffers.uniform("surface_contact".into(), &whole.bytes());
    if shared.edges {
        let kernel = shared.kernel("surface_contact_edges", shader!("surface_contact_edges"), surface, world);
        let kernel = shared.begins(kernel).fragment(shader!("surface_motion_turns"));
        all.push(kernel.bind("surface_rows", shared.rows).threads(contacts.surface.crossings.edges.len() as u32));
    }
    let share = shared.kernel("surface_contact_share", shader!("surface_contact_share"), surface, world);
    let share = shared.of_nodes(share).fragment(shader!("surface_motion_turns"));
    all.push(shared.with_nodes(share).threads(nodes as u32));
    let of_contacts =
        |entry, text| shared.relative(shared.kernel(entry, text, surface, world)).threads(whole.contacts).repeated();
    let apply = || {
        let kernel = shared.kernel("surface_contact_apply", shader!("surface_contact_apply"), surface, world);
        let kernel = shared.of_nodes(kernel).fragment(shader!("surface_motion"));
        shared.with_nodes(kernel).threads(nodes as u32).repeated()
    };
    let impulse = of_contacts("surface_contact_impulse", shader!("surface_contact_impulse"));
    all.extend([impulse, apply()]);
    if contacts.has_friction() {
        all.extend([of_contacts("surface_contact_friction", shader!("surface_contact_friction")), apply()]);
    }
    for &(body, of) in &of_bodies {
        let surface = buffers.uniform("surface_contact of a body".into(), &of.bytes());
        let push = shared.kernel("surface_contact_push", shader!("surface_contact_push"), surface, world);
        let push = shared.relative(shared.of_nodes(push)).fragment(numbers_met()).bind("surface_rows", shared.rows);
        let columns = [ExternalForce::NAME, ContactForce::NAME, SurfaceTouch::NAME];
        let push = columns.into_iter().fold(push, |kernel, name| kernel.bind(name, buffers.column(body, name)));
        all.push(push.threads(of.count));
        let of_body = points.iter().filter(|points| points.body == body);
        all.extend(of_body.map(|points| shared.touch(points, world, buffers)));
    }
    all
}

/// Where a body's surface is, and where it would go.
fn before(
    shared: &Shared,
    body: Entity,
    of: SurfaceContact,
    world: &World,
    buffers: &mut dyn Buffers,
) -> ([Kernel; 2], ForeseenNodes) {
    let of_body = SurfaceBody { first: of.first, count: of.count, displacements: of.displacements };
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
        .bind(DisplacementIncrement::NAME, buffers.column(body, DisplacementIncrement::NAME))
        .fragment(numbers_met())
        .bind(SurfaceTouch::NAME, buffers.column(body, SurfaceTouch::NAME));
    let nodes = ForeseenNodes { rows: shared.rows, nodes: shared.nodes, of_body, count: of.count };
    ([place, nodes.foresee("surface_contact_foresee", body, world, buffers)], nodes)
}

/// How many numbers of a node contact keeps.
fn numbers_met() -> Fragment {
    Fragment::new("generated: numbers of a node", format!("const MET: u32 = {MEETING_NUMBERS}u;\n"))
}

/// What gives a kernel `note_farther`, for systems that act on nodes of a body after contact: its text, and the columns
/// that it asks for.
pub(in crate::systems) fn note_farther(body: Entity, world: &World) -> (Vec<Fragment>, &'static [&'static str]) {
    if world.get::<ContactForce>(body).is_none() {
        let text = "fn note_farther(node: u32, farther: vec3<f32>) {}\n";
        return (vec![Fragment::new("generated: the surface meets nothing", text)], &[]);
    }
    (vec![numbers_met(), shader!("contact_farther")], &[ContactForce::NAME, SurfaceTouch::NAME])
}

/// Nodes of a body whose next steps are wanted.
pub(in crate::systems) struct ForeseenNodes {
    /// Four words a node: its row, and three of whoever asks.
    rows: BufferId,
    /// [`FORESEEN_NUMBERS`] a node: three of whoever asks, the next step, the last step, which must be there already,
    /// the response to forces, the last step for work that is counted, and one more of whoever asks.
    pub(super) nodes: BufferId,
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
        let mass = if world.get::<InertialMass>(body).is_some() { InertialMass::NAME } else { Mass::NAME };
        let foresee = Kernel::new(label, "surface_contact_foresee")
            .fragment(shader!("surface_contact_foresee"))
            .fragment(shader!("row"))
            .fragment(damping_fragment(damped, relaxed))
            .fragment(last_step(body, world))
            .bind_uniform::<SurfaceBody>("body", self.of_body)
            .bind("surface_rows", self.rows)
            .bind("surface_nodes", self.nodes)
            .bind(Mass::NAME, buffers.column(body, mass))
            .threads(self.count);
        let columns = [ConstrainedAxes::NAME, InternalForce::NAME, ExternalForce::NAME];
        let columns = columns.into_iter().chain(damped.then_some(DampingCoefficient::NAME));
        let foresee = columns.fold(foresee, |kernel, name| kernel.bind(name, buffers.column(body, name)));
        let foresee = match world.get::<PreviousPrescribedIncrement>(body) {
            Some(_) => {
                let column = buffers.column(body, PreviousPrescribedIncrement::NAME);
                foresee.bind(PreviousPrescribedIncrement::BUFFER, column)
            }
            None => foresee,
        };
        with_step(foresee, world)
    }
}

/// What declares `last_step`: the last step of a node (m), from what is written there, which along axes that are told
/// is the next one.
fn last_step(body: Entity, world: &World) -> Fragment {
    let declared = "fn last_step(node: u32, written: vec3<f32>, held: vec3<bool>) -> vec3<f32> {\n";
    if world.get::<PreviousPrescribedIncrement>(body).is_none() {
        let text = format!("{declared}    return written;\n}}\n");
        return Fragment::new("generated: previous steps are not kept", text);
    }
    let at = place_in_buffer::<PreviousPrescribedIncrement>(body, world);
    let word = |i: usize| format!("bitcast<f32>(atomicLoad(&node_diagnostics[{}u + 3u * node]))", at + i);
    let text = format!(
        "@group(0) @binding(0) var<storage, read_write> node_diagnostics: array<atomic<u32>>;\n{declared}    let kept = \
         vec3<f32>({}, {}, {});\n    return select(written, kept, held);\n}}\n",
        word(0),
        word(1),
        word(2)
    );
    Fragment::new("generated: previous steps", text)
}
