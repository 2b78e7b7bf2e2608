//! Contact between surfaces on a GPU: what its kernels know of the surfaces, and lists of what may be near what.
//!
//! The host makes the lists, with a skin, and looks before each submission how far nodes have moved (a reduction on the
//! device): a submission is no longer than they should hold. Should they not, kernels see that for themselves, in the
//! step in which it is so, and go through all triangles: slow, and right. So no step ever misses a contact, and what is
//! found does not depend on when lists are made.

use super::body_slices::slices;
use super::{MeetingColumns, Surface, SurfaceContacts, motion, survey};
use crate::backend::cpu::Cpu;
use crate::backend::device::{Device, bring_to_host};
use crate::backend::kernel::{BufferId, uniform};
use crate::components::*;
use crate::error::Error;
use crate::math::Scalar;
use bevy_ecs::prelude::*;

/// Triangles near a point that there is room for, on average, and besides.
const ROOM: [usize; 2] = [16, 4096];

/// Steps of a submission at most, whatever the lists allow.
const MOST_STEPS: f64 = 4096.0;

/// What is the same for all kernels but for the body whose columns they have.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct SurfaceContact {
    nodes: u32,
    triangles: u32,
    bodies: u32,
    pub first: u32,
    pub count: u32,
    pub body: u32,
    around: u32,
    meetings: u32,
    apart: u32,
    list: u32,
    inverse: u32,
    pub displacements: u32,
    edge: f32,
    settling: f32,
    margin: f32,
    rounding: f32,
    thickness: f32,
    depth: f32,
    relaxed: u32,
}
uniform!(SurfaceContact {
    nodes,
    triangles,
    bodies,
    first,
    count,
    body,
    around,
    meetings,
    apart,
    list,
    inverse,
    displacements,
    edge,
    settling,
    margin,
    rounding,
    thickness,
    depth,
    relaxed
});

impl SurfaceContact {
    /// For kernels that have the columns of a body, whose number it is, with so many nodes from the first on.
    pub fn of_body(self, body: u32, first: u32, count: u32) -> Self {
        Self { first, count, body, ..self }
    }
}

/// The buffers that the host writes while kernels run, and how much they hold.
#[derive(Resource, Clone, Copy, Debug)]
pub(super) struct OnDevice {
    pub lists: BufferId,
    pub motion: BufferId,
    /// Steps that were allowed last.
    ahead: u64,
}

/// Words of `surface_faces` about two bodies that may meet.
pub(super) const MEETING_WORDS: usize = 6;

/// Words of `surface_motion`.
pub(super) const MOTION_WORDS: usize = 8;

/// Where parts of `surface_lists` begin.
struct Layout {
    list: usize,
    inverse: usize,
    displacements: usize,
    room: usize,
}

impl Layout {
    fn of(surface: &Surface) -> Self {
        let nodes = surface.nodes.len();
        let room = ROOM[0] * nodes + ROOM[1];
        let inverse = 1 + nodes + 1 + room;
        // a triangle has three corners
        Self { list: 1, inverse, displacements: inverse + nodes + 1 + 3 * room, room }
    }
}

/// Finds surfaces and lists as they are, on the host, as a step would.
pub(crate) fn find(world: &mut World) {
    let precision = world.query::<&Displacement>().iter(world).next().map(|u| u.precision());
    let mut system: Box<dyn System<In = (), Out = ()>> = match precision {
        Some(Precision::F64) => Box::new(IntoSystem::into_system(find_lists::<f64>)),
        _ => Box::new(IntoSystem::into_system(find_lists::<f32>)),
    };
    system.initialize(world);
    // a system of the engine's own, on a world that has what it asks for
    let _ = system.run((), world);
}

fn find_lists<T: Scalar>(
    (clock, cpu): (Res<Clock>, Res<Cpu>),
    mut contacts: ResMut<SurfaceContacts>,
    mut bodies: Query<(Entity, MeetingColumns)>,
    authorings: Query<&Authoring>,
    blocks: Query<Ref<Alive>>,
) {
    let contacts = &mut *contacts;
    survey::follow(contacts, &mut bodies, &authorings, &blocks);
    let bodies = slices::<T>(contacts, &mut bodies);
    if bodies.len() != contacts.bodies.len() {
        return;
    }
    let moving = |body: u32| Some([bodies[body as usize].u, bodies[body as usize].step]);
    contacts.surface.motion.follow(&moving, &clock, &cpu);
    let reach = motion::reach(contacts, contacts.surface.motion.largest);
    motion::list(contacts, &bodies, reach, &cpu);
}

impl SurfaceContacts {
    /// What kernels know of the whole, with no body in particular.
    pub(super) fn uniform(&self, clock: &Clock) -> SurfaceContact {
        let surface = &self.surface;
        let (nodes, triangles, bodies) = (surface.nodes.len(), surface.triangles.triangles.len(), self.bodies.len());
        let around = 8 * triangles;
        let meetings = around + nodes + 1 + 3 * triangles;
        let layout = Layout::of(surface);
        let size = surface.places.iter().map(|at| at.abs().max_element()).fold(0.0, f64::max);
        SurfaceContact {
            nodes: nodes as u32,
            triangles: triangles as u32,
            bodies: bodies as u32,
            first: 0,
            count: nodes as u32,
            body: 0,
            around: around as u32,
            meetings: meetings as u32,
            apart: (meetings + MEETING_WORDS * bodies * bodies) as u32,
            list: layout.list as u32,
            inverse: layout.inverse as u32,
            displacements: layout.displacements as u32,
            edge: self.edge as f32,
            settling: self.settling as f32,
            margin: (survey::MARGIN * self.edge) as f32,
            // some roundings of a place
            rounding: (8.0 * f64::from(f32::EPSILON) * size) as f32,
            thickness: self.thickness() as f32,
            depth: surface.triangles.depths.iter().copied().fold(0.0, f64::max) as f32,
            relaxed: u32::from(clock.relaxation.is_some()),
        }
    }

    /// Words of `surface_faces`.
    pub(super) fn faces(&self) -> Vec<u32> {
        let surface = &self.surface;
        let of = &surface.triangles;
        let mut words = Vec::new();
        for (number, corners) in of.triangles.iter().enumerate() {
            words.extend(corners);
            words.extend(of.beside(number as u32));
            words.extend([of.bodies[number], (of.depths[number] as f32).to_bits()]);
        }
        let rows = |words: &mut Vec<u32>, row: &dyn Fn(u32) -> Vec<u32>| {
            let (mut starts, mut all) = (vec![0], Vec::new());
            for node in 0..surface.nodes.len() as u32 {
                all.extend(row(node));
                starts.push(all.len() as u32);
            }
            words.extend(starts);
            words.extend(all);
        };
        rows(&mut words, &|node| of.around(node).to_vec());
        for meeting in &self.meetings {
            let numbers = meeting.map_or([0.0; MEETING_WORDS - 1], |of| {
                let spring = of.spring.unwrap_or(ContactSpring { share: 0.0, damping: 0.0 });
                [of.friction[0], of.friction[1], of.thickness, spring.share, spring.damping]
            });
            words.push(u32::from(meeting.is_some()));
            words.extend(numbers.map(|number| (number as f32).to_bits()));
        }
        rows(&mut words, &|point| {
            let begin = surface.apart.partition_point(|&(other, _)| other < point);
            let end = surface.apart.partition_point(|&(other, _)| other <= point);
            surface.apart[begin..end].iter().map(|&(_, triangle)| triangle).collect()
        });
        words
    }

    /// Words of `surface_rows`: row and place at rest of each node.
    pub(super) fn rows(&self, world: &World) -> Vec<u32> {
        let word = |&(body, row): &(u32, u32)| {
            let rest = world.get::<RestPosition>(self.bodies[body as usize]);
            let rest = rest.map_or(self.reference, |rest| rest.0[row as usize]) - self.reference;
            let [x, y, z] = rest.as_vec3().to_array().map(f32::to_bits);
            [row, x, y, z]
        };
        self.surface.nodes.iter().flat_map(word).collect()
    }

    /// Words of `surface_lists`. Lists that there is no room for hold nothing: then kernels go through all.
    pub(super) fn list_words(&self, world: &World) -> Vec<u32> {
        let surface = &self.surface;
        let (layout, nodes) = (Layout::of(surface), surface.nodes.len());
        let lists = &surface.lists;
        let fits = lists.triangles.len() <= layout.room;
        let radius = if fits { lists.radius.min(f64::from(f32::MAX)) as f32 } else { -1.0 };
        let mut words = vec![0; layout.displacements + 3 * nodes];
        words[0] = radius.to_bits();
        if fits {
            let mut inverse: Vec<Vec<u32>> = vec![Vec::new(); nodes];
            let mut end = 0;
            let mut listed = lists.points.iter().enumerate().peekable();
            for point in 0..nodes as u32 {
                if let Some((place, _)) = listed.next_if(|(_, other)| **other == point) {
                    for &triangle in lists.triangles(place) {
                        words[layout.list + nodes + 1 + end] = triangle;
                        end += 1;
                        for corner in surface.triangles.triangles[triangle as usize] {
                            let of_corner = &mut inverse[corner as usize];
                            if of_corner.last() != Some(&point) {
                                of_corner.push(point);
                            }
                        }
                    }
                }
                words[layout.list + point as usize + 1] = end as u32;
            }
            let mut at = 0;
            for (node, points) in inverse.iter().enumerate() {
                let begin = layout.inverse + nodes + 1 + at;
                words[begin..begin + points.len()].copy_from_slice(points);
                at += points.len();
                words[layout.inverse + node + 1] = at as u32;
            }
        }
        for (node, &(body, row)) in surface.nodes.iter().enumerate() {
            if let Some(u) = world.get::<Displacement>(self.bodies[body as usize]) {
                let bits = u.vector(row as usize).as_vec3().to_array().map(f32::to_bits);
                words[layout.displacements + 3 * node..layout.displacements + 3 * node + 3].copy_from_slice(&bits);
            }
        }
        words
    }

    /// How many steps the lists should hold for, where nodes have come nearer (m) since they were made, and go so far
    /// in a step (m).
    fn steps_ahead(&self, nearer: f64, largest: f64) -> f64 {
        // half as fast again by the end of it
        let a_step = 3.0 * largest;
        let left = self.surface.lists.radius - self.farthest(motion::reach(self, 1.5 * largest)) - nearer;
        if left <= 0.0 {
            return 0.0;
        }
        (left / a_step.max(f64::MIN_POSITIVE)).min(MOST_STEPS)
    }
}

/// Notes the buffers that kernels have, where they could be made.
pub(super) fn note(lists: BufferId, motion: BufferId, world: &mut World) {
    if lists != BufferId::NONE && motion != BufferId::NONE {
        world.insert_resource(OnDevice { lists, motion, ahead: 4 });
    }
}

/// Whether kernels run on a device.
pub(super) fn is_on_device(world: &World) -> bool {
    world.contains_resource::<OnDevice>()
}

/// What must be done before steps are submitted, and how many there may be at most.
pub(super) fn before_steps(world: &mut World) -> Result<u64, Error> {
    let Some(on_device) = world.get_resource::<OnDevice>().copied() else { return Ok(u64::MAX) };
    let range = (on_device.motion, 0, 4 * MOTION_WORDS as u64);
    let Some(mut device) = world.get_resource_mut::<Device>() else { return Ok(u64::MAX) };
    let bytes = device.gpu().download_ranges(&[range])?.concat();
    // the next step counts anew, whatever its number
    device.gpu().upload(on_device.motion, 0, &[0; 16])?;
    let words: Vec<u32> = bytes.chunks_exact(4).map(bytemuck::pod_read_unaligned).collect();
    let length = |one: usize, other: usize| f64::from(f32::from_bits(words[one].max(words[other]))).sqrt();
    let largest = length(0, 1);
    let nearer = 2.0 * (length(2, 3) + largest);
    let mut contacts = world.resource_mut::<SurfaceContacts>();
    contacts.surface.figures.unlisted = u64::from(words[4]);
    let [left, fresh] = [nearer, 0.0].map(|nearer| contacts.steps_ahead(nearer, largest));
    // soon submissions would be short: it is time
    let mut allowed = left;
    if largest == 0.0 || left < 1.0 || 3.0 * left < fresh {
        allowed = renew(world)?;
    }
    // what begins to move may be faster than it was
    let most = 2 * on_device.ahead;
    let ahead = (allowed.max(1.0) as u64).min(most);
    world.insert_resource(OnDevice { ahead, ..on_device });
    Ok(ahead)
}

/// Makes lists of where the nodes are now, and gives them to the device; how many steps they should hold for.
fn renew(world: &mut World) -> Result<f64, Error> {
    let bodies = world.resource::<SurfaceContacts>().bodies.clone();
    let wanted = [Displacement::NAME, DisplacementIncrement::NAME];
    bring_to_host(world, |entity, name| bodies.contains(&entity) && wanted.contains(&name))?;
    find(world);
    let contacts = world.resource::<SurfaceContacts>();
    let words = contacts.list_words(world);
    let steps = contacts.steps_ahead(0.0, contacts.surface.motion.largest);
    let Some(lists) = world.get_resource::<OnDevice>().map(|on_device| on_device.lists) else { return Ok(steps) };
    if let Some(mut device) = world.get_resource_mut::<Device>() {
        device.gpu().upload(lists, 0, bytemuck::cast_slice(&words))?;
    }
    Ok(steps)
}
