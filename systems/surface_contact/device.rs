//! Contact between surfaces on a GPU: what its kernels know of the surfaces, and lists of what may be near what.
//!
//! The host makes the lists, with a skin, and looks before each submission how far nodes have moved (a reduction on the
//! device): a submission is no longer than they should hold. Should they not, kernels see that for themselves, in the
//! step in which it is so, and go through all triangles: slow, and right. So no step ever misses a contact, and what is
//! found does not depend on when lists are made.

use super::body_slices::slices;
use super::words::{FaceWords, Layout};
use super::{MeetingColumns, SurfaceContacts, motion, survey};
use crate::backend::cpu::Cpu;
use crate::backend::device::{Device, bring_to_host};
use crate::backend::kernel::{BufferId, uniform};
use crate::components::*;
use crate::error::Error;
use crate::math::Scalar;
use bevy_ecs::prelude::*;

/// Steps of a submission at most, whatever the lists allow.
const MOST_STEPS: f64 = 4096.0;

/// What is the same for all kernels but for the body whose columns they have.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct SurfaceContact {
    nodes: u32,
    points: u32,
    items: u32,
    pub contacts: u32,
    triangles: u32,
    bodies: u32,
    pub first: u32,
    pub count: u32,
    body: u32,
    around: u32,
    meetings: u32,
    apart: u32,
    face_points: u32,
    facets: u32,
    edges: u32,
    begins: u32,
    list: u32,
    inverse: u32,
    pub displacements: u32,
    margin: f32,
    rounding: f32,
    thickness: f32,
    depth: f32,
    relaxed: u32,
}
uniform!(SurfaceContact {
    nodes,
    points,
    items,
    contacts,
    triangles,
    bodies,
    first,
    count,
    body,
    around,
    meetings,
    apart,
    face_points,
    facets,
    edges,
    begins,
    list,
    inverse,
    displacements,
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

/// Words of `surface_motion`.
pub(super) const MOTION_WORDS: usize = 8;

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
    pub(super) fn uniform(&self, faces: &FaceWords, clock: &Clock) -> SurfaceContact {
        let (surface, layout) = (&self.surface, Layout::of(self));
        let (points, size) = (surface.points.len(), surface.places.iter().map(|at| at.abs().max_element()));
        SurfaceContact {
            nodes: surface.nodes.len() as u32,
            points: points as u32,
            items: (points + surface.crossings.edges.len()) as u32,
            contacts: layout.contacts as u32,
            triangles: surface.triangles.triangles.len() as u32,
            bodies: self.bodies.len() as u32,
            first: 0,
            count: surface.nodes.len() as u32,
            body: 0,
            around: faces.around as u32,
            meetings: faces.meetings as u32,
            apart: faces.apart as u32,
            face_points: faces.face_points as u32,
            facets: faces.facets as u32,
            edges: faces.edges as u32,
            begins: faces.begins as u32,
            list: layout.list as u32,
            inverse: layout.inverse as u32,
            displacements: layout.displacements as u32,
            margin: (survey::MARGIN * self.coarsest) as f32,
            // some roundings of a place
            rounding: (8.0 * f64::from(f32::EPSILON) * size.fold(0.0, f64::max)) as f32,
            thickness: self.thickness() as f32,
            depth: surface.shallowest as f32,
            relaxed: u32::from(clock.relaxation.is_some()),
        }
    }

    /// How many steps the lists should hold for, where nodes have come nearer (m) since they were made, and go so far
    /// in a step (m).
    fn steps_ahead(&self, nearer: f64, largest: f64) -> f64 {
        // half as fast again by the end of it
        let a_step = 3.0 * largest;
        let left = self.surface.lists.radius - self.least_farthest(motion::reach(self, 1.5 * largest)) - nearer;
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
    if words[5] > 0 {
        let why = "more than four edges cross one at once, of so many that a GPU has no room for all; the CPU has";
        return Err(Error::Options(why.into()));
    }
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
        for (at, piece) in &words.pieces {
            device.gpu().upload(lists, 4 * *at as u64, bytemuck::cast_slice(piece))?;
        }
    }
    Ok(steps)
}
