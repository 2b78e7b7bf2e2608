//! `surface_contact`: bodies keep each other, and themselves, outside.

mod body_slices;
mod crossings;
mod device;
mod ends;
mod faced;
mod gather;
mod hold;
mod kernels;
mod look;
mod meet;
mod memory;
mod motion;
mod pairs;
mod solved;
mod survey;
mod turns;
mod words;

use super::node_slices::SlicedColumns;
use super::repeat::Repeat;
use super::system::{Phase, System};
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::contact::{Faced, Lists, Near, Neighbourhoods, Point, Shortlist, Stays, Surfaces, Tree};
use crate::error::{Error, missing};
use crate::math::Scalar;
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use body_slices::BodySlices;
pub(crate) use device::find as find_surfaces;
use glam::DVec3;
pub(super) use kernels::{FORESEEN_NUMBERS, ForeseenNodes, note_farther};
pub use memory::SurfaceMemory;
pub(crate) use solved::{count_work as count_surface_work, find as find_surface_springs, seek as seek_surfaces};
use std::time::Duration;

/// The explicit Lagrange correction of the predicted step, of points of surfaces against faces of others (see
/// [`ContactSet::solve`]). Like `tool_contact` it finds the forces that keep the next step from ending inside and adds
/// them to the loads: nothing to tune, no change of the stable step, nothing that `integrate` or the balance of energy
/// must know of. Places and normals are those at the beginning of the step, only the steps of points against faces are
/// predicted.
pub fn system() -> System {
    let system = System::built_in(
        "surface_contact",
        Phase::Contact,
        "keeps bodies outside of each other",
        "`Between(...)` or `Itself(...)` under `contacts`",
        |world| {
            let contacts = world.get_resource::<SurfaceContacts>()?;
            let bodies = contacts.bodies.len();
            Some(format!("surfaces of {bodies} {} that may meet", if bodies == 1 { "body" } else { "bodies" }))
        },
        surface_contact,
    );
    System {
        shared_only: surfaces_stay,
        may_sleep: true,
        // where elements go, surfaces are found anew: on the host
        device_when: surfaces_stay,
        before_steps: Some(device::before_steps),
        repeats: sweeps,
        ..system.on_device(kernels::kernels)
    }
}

/// Whether no surface of theirs changes, so that no patch moves its nodes by itself.
fn surfaces_stay(world: &World) -> bool {
    let contacts = world.get_resource::<SurfaceContacts>();
    contacts.is_some_and(|contacts| contacts.bodies.iter().all(|&body| world.get::<SurfaceRows>(body).is_some()))
}

/// What corrects the forces.
fn sweeps(world: &World) -> Option<Repeat> {
    let contacts = world.get_resource::<SurfaceContacts>()?;
    let what = ["normal forces", "what they do to nodes", "friction", "what it does to nodes"];
    Repeat::several(contacts.sweeps, if contacts.has_friction() { &what } else { &what[..2] })
}

/// How far points may go before it is looked anew what is near what, in edges; four times that of fast ones.
const SKIN: f64 = 0.25;

/// How points of one body meet faces of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// Coefficients of friction: while they stick, and while they slide.
    pub friction: [f64; 2],
    /// How far they stay apart (m).
    pub thickness: f64,
    /// Whether the points are those of faces, and not nodes.
    pub faces: bool,
    /// Whether edges that cross meet, too.
    pub edges: bool,
    /// The spring that keeps them out, in place of the kinematic law.
    pub spring: Option<ContactSpring>,
    /// The smaller edge of both (m): by it goes what must be little for elements of either.
    pub edge: f64,
    /// How fast points that begin inside are pushed out (m/s).
    pub settling: f64,
}

/// Which bodies may meet, and what is known of their surfaces. Nothing in it is carried on from step to step but what
/// can be found anew.
#[derive(Resource, Clone, Debug, Default)]
pub struct SurfaceContacts {
    /// The bodies.
    pub bodies: Vec<Entity>,
    /// How points of body i meet faces of body j, at i times the number of bodies plus j.
    pub meetings: Vec<Option<Meeting>>,
    /// How often the forces are corrected in a step.
    pub sweeps: usize,
    /// How far points may go before it is looked anew what is near what, in edges. It changes nothing but the time that
    /// this takes.
    pub skin: f64,
    /// A point near the bodies (m), from which places are counted: so they keep their digits far from the origin.
    pub reference: DVec3,
    /// Length of an edge of each body's surface (m).
    pub edges: Vec<f64>,
    /// The smallest of these (m): by it goes only what is the same for all at once, and when it is looked anew.
    pub edge: f64,
    /// The largest [`Meeting::edge`] (m).
    coarsest: f64,
    surface: Surface,
}

/// What is known of the surfaces as they are.
#[derive(Clone, Debug, Default)]
struct Surface {
    triangles: Surfaces,
    /// The nodes of the facet that each triangle is of, where there are points of faces; a triangle repeats its last
    /// one.
    facets: Vec<[u32; 4]>,
    /// Body and row of each node.
    nodes: Vec<(u32, u32)>,
    /// Nodes, in their order, then points of faces.
    points: Vec<Point>,
    /// The row of each node, and of each point of a face its place among those of its body.
    places_kept: Vec<u32>,
    /// Points and triangles that are near each other at rest: never in each other's way.
    apart: Vec<(u32, u32)>,
    /// A number for which elements are there; `None` before anything is known.
    elements: Option<u64>,
    /// One a body.
    trees: Vec<Tree>,
    /// How deep the inside of the shallowest body goes (m), and how much deeper that of each (m).
    shallowest: f64,
    beyond: Vec<f64>,
    lists: Lists,
    crossings: crossings::Crossings,
    /// Of each node of a body that meets itself its piece, as of all its elements; else empty.
    pieces: Vec<u32>,
    /// What is near, as long as the lists hold.
    near: Near,
    /// Where the nodes are that are near something (m, from the reference).
    places: Vec<DVec3>,
    /// Which way the triangles look that are.
    normals: Vec<DVec3>,
    /// How they have turned in the last step; empty where few are asked for it.
    turns: Vec<Option<turns::Turn>>,
    /// How far nodes have moved since the lists were made; and how far faces must be looked at in this step (m), where
    /// that was found before forces.
    motion: look::Motion,
    reach: Option<f64>,
    /// Of each point in the lists, how far that may be before it has to be looked at again (m), and the least of all.
    wake: Vec<f64>,
    first_wake: f64,
    /// Of each point in the lists, what of its list matters; empty before they are begun.
    shortlists: Vec<Shortlist>,
    /// How far nodes may move from where they were when it was looked last whether these hold, and how far faces may be
    /// looked at (m).
    stays: Stays,
    /// Where nodes have moved how far since their shortlists were begun.
    neighbourhoods: Neighbourhoods,
    /// Nodes that bore a force in the last step.
    pressed: Vec<u32>,
    /// Points that touched or faced something, ascending.
    touching: Vec<u32>,
    /// Bodies with their numbers, in the order of entities.
    numbers: Vec<(Entity, usize)>,
    // what a step finds, kept so that the next one need not ask for memory
    /// Places in the lists of points that may be near something.
    awake: Vec<u32>,
    kept_by_task: Vec<crate::contact::Kept>,
    reaches: Vec<f64>,
    gathered: gather::Gathered,
    /// What points face in an implicit step, in the order of points, and what may touch.
    faced_by_task: Vec<Vec<(u32, Faced)>>,
    pairs: Vec<pairs::Pair>,
    /// The slopes of each contact of an implicit step.
    solved: Vec<solved::Slopes>,
    figures: Figures,
}

/// What the search has come to so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// Steps.
    pub steps: u64,
    /// Steps in which nothing was near.
    pub asleep: u64,
    /// How often lists were made.
    pub builds: u64,
    /// Points that were looked at, of all steps.
    pub examined: u64,
    /// Contacts, of all steps.
    pub contacts: u64,
    /// How long making lists has taken.
    pub building: Duration,
    /// The deepest that a point has been inside after a step (m).
    pub deepest: f64,
    /// Steps on a GPU that found their lists too old, and went through all triangles.
    pub unlisted: u64,
}

/// What is known of a body.
#[derive(QueryData)]
#[query_data(mutable)]
struct MeetingColumns {
    nodes: SlicedColumns,
    force: &'static mut ContactForce,
    touch: &'static mut SurfaceTouch,
    face_touch: Option<&'static mut FaceTouch>,
    face_places: Option<&'static FacePlaces>,
    /// Where tools may hold its nodes.
    grip: Option<(&'static Grasps, &'static ToolHold)>,
}

impl Surface {
    /// Where a point's numbers are.
    fn kept(&self, point: u32) -> body_slices::Kept {
        let Point { body, triangle, .. } = &self.points[point as usize];
        let first = MEETING_NUMBERS * self.places_kept[point as usize] as usize;
        body_slices::Kept { body: *body as usize, of_face: triangle.is_some(), first }
    }

    /// The number of a body; none of those that there are where it meets nobody.
    fn number_of(&self, body: Entity) -> usize {
        let place = self.numbers.binary_search_by_key(&body, |(entity, _)| *entity);
        place.map_or(usize::MAX, |place| self.numbers[place].1)
    }
}

impl SurfaceContacts {
    /// Of bodies that meet nobody yet.
    pub fn new(bodies: Vec<Entity>) -> Self {
        Self { meetings: vec![None; bodies.len() * bodies.len()], sweeps: 1, skin: SKIN, bodies, ..Self::default() }
    }

    /// Lets two bodies meet, or one itself.
    pub fn meet(&mut self, [a, b]: [usize; 2], meeting: Meeting) {
        let count = self.bodies.len();
        self.meetings[a * count + b] = Some(meeting);
        self.meetings[b * count + a] = Some(meeting);
        self.coarsest = self.coarsest.max(meeting.edge);
    }

    /// How points of a body meet faces of another.
    fn meeting(&self, point: u32, face: u32) -> Option<Meeting> {
        self.meetings[point as usize * self.bodies.len() + face as usize]
    }

    /// Whether points of a body may meet faces of another: its nodes, or points of its faces.
    fn meets(&self, point: u32, face: u32, of_face: bool) -> bool {
        self.meeting(point, face).is_some_and(|meeting| meeting.faces == of_face)
    }

    /// The bodies that are kept away from one, by their places among all.
    pub(crate) fn met_by(&self, body: usize) -> Vec<Entity> {
        let meets = |other: &usize| self.meeting(body as u32, *other as u32).is_some();
        (0..self.bodies.len()).filter(meets).map(|other| self.bodies[other]).collect()
    }

    /// Whether points of a body's faces may meet anybody.
    pub(crate) fn has_face_points(&self, body: usize) -> bool {
        let count = self.bodies.len();
        self.meetings[body * count..(body + 1) * count].iter().flatten().any(|meeting| meeting.faces)
    }

    /// Whether there is any friction.
    fn has_friction(&self) -> bool {
        self.meetings.iter().flatten().any(|meeting| meeting.friction != [0.0; 2])
    }

    /// How many points and faces there are.
    pub fn size(&self) -> [usize; 2] {
        [self.surface.points.len(), self.surface.triangles.triangles.len()]
    }

    /// What the search has come to so far.
    pub fn figures(&self) -> Figures {
        self.surface.figures
    }

    /// Whether nothing faced anything in the last step, and no edges may cross.
    fn is_idle(&self) -> bool {
        let Surface { pressed, touching, crossings, .. } = &self.surface;
        pressed.is_empty() && touching.is_empty() && crossings.near.is_empty()
    }

    /// Whether nothing can be near anything that is looked at so far (m), and nothing was in the last step.
    fn sleeps(&self, reach: f64) -> bool {
        let Surface { first_wake, motion, .. } = &self.surface;
        self.is_idle() && self.lists_hold(reach) && self.farthest(reach) + motion.lists.moved < *first_wake
    }
}

/// A step, or whether it sleeps through it, where that is asked before.
fn surface_contact(
    (clock, cpu, signals, observed): (Res<Clock>, Res<Cpu>, Res<Signals>, Option<Res<Observed>>),
    mut contacts: ResMut<SurfaceContacts>,
    (mut sleep, mut gain): (Option<ResMut<SurfaceSleep>>, Option<ResMut<ContactGain>>),
    mut bodies: Query<(Entity, MeetingColumns)>,
    authorings: Query<&Authoring>,
    blocks: Query<Ref<Alive>>,
) -> Result<(), Error> {
    let contacts = &mut *contacts;
    let asked = sleep.as_mut().filter(|sleep| sleep.asked);
    match clock.springs.map(|springs| springs.forces) {
        // where it has been asked
        None if contacts.surface.reach.is_some() && asked.is_none() => {}
        None | Some(SpringForces::Sought | SpringForces::Stepped) => {
            survey::follow(contacts, &mut bodies, &authorings, &blocks)
        }
        Some(SpringForces::Tried | SpringForces::Noted) => {}
        Some(SpringForces::Omitted) => return Ok(()),
    }
    let precision = bodies.iter().next().map(|(_, columns)| columns.nodes.u.precision());
    let of_step = (&*clock, &*cpu);
    if let Some(sleep) = asked {
        contacts.surface.reach = match precision.filter(|_| clock.springs.is_none()) {
            Some(Precision::F32) => motion::awake::<f32>(contacts, of_step, &bodies),
            Some(Precision::F64) => motion::awake::<f64>(contacts, of_step, &bodies),
            None => None,
        };
        sleep.asleep &= clock.springs.is_none() && contacts.surface.reach.is_none();
        return Ok(());
    }
    let gain = gain.as_deref_mut().filter(|_| observed.is_some_and(|observed| observed.0));
    match precision {
        Some(Precision::F32) => step::<f32>(contacts, of_step, &mut bodies, (&signals, gain)),
        Some(Precision::F64) => step::<f64>(contacts, of_step, &mut bodies, (&signals, gain)),
        None => Ok(()),
    }
}

fn step<T: Scalar>(
    contacts: &mut SurfaceContacts,
    of: (&Clock, &Cpu),
    bodies: &mut Query<(Entity, MeetingColumns)>,
    (signals, gain): (&Signals, Option<&mut ContactGain>),
) -> Result<(), Error> {
    match &of.0.springs {
        Some(springs) if matches!(springs.forces, SpringForces::Sought | SpringForces::Stepped) => {
            contacts.surface.pairs.clear();
            let Some((near, mut bodies)) = motion::search::<T>(contacts, of, bodies)? else { return Ok(()) };
            if let Some(reach) = near {
                pairs::pair(contacts, of, reach, &bodies);
            }
            if springs.forces == SpringForces::Stepped {
                solved::press(contacts, (of.0, springs, of.1), &mut bodies);
            }
        }
        // before the first step nobody has looked
        Some(_) if contacts.surface.numbers.is_empty() => {}
        Some(springs) => {
            let mut bodies = slices_of::<T>(contacts, bodies)?;
            motion::update_places(contacts, &bodies, of.1);
            solved::press(contacts, (of.0, springs, of.1), &mut bodies);
        }
        None => match motion::search::<T>(contacts, of, bodies)? {
            None => {}
            Some((None, mut bodies)) => {
                meet::release(&mut contacts.surface, &mut bodies);
                meet::forget(contacts, &[], &mut bodies);
            }
            Some((Some(reach), mut bodies)) => {
                meet::meet(contacts, (of, reach), &mut bodies, (signals, gain));
                contacts.surface.figures.contacts += contacts.surface.gathered.set.count() as u64;
            }
        },
    }
    Ok(())
}

fn slices_of<'a, T: Scalar>(
    contacts: &SurfaceContacts,
    bodies: &'a mut Query<(Entity, MeetingColumns)>,
) -> Result<Vec<BodySlices<'a, T>>, Error> {
    let bodies = body_slices::slices::<T>(contacts, bodies);
    if bodies.len() == contacts.bodies.len() { Ok(bodies) } else { Err(missing("a column of a body")) }
}
