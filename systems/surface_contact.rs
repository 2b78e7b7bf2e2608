//! `surface_contact`: bodies keep each other, and themselves, outside.

mod meet;
mod survey;

use super::registry::{Phase, System};
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::contact::{ContactSet, Lists, Point, Surfaces, Tree};
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use glam::DVec3;

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
    System { shared_only: surfaces_stay, ..system }
}

/// Whether no surface of theirs changes, so that no patch moves its nodes by itself.
fn surfaces_stay(world: &World) -> bool {
    let contacts = world.get_resource::<SurfaceContacts>();
    contacts.is_some_and(|contacts| contacts.bodies.iter().all(|&body| world.get::<SurfaceRows>(body).is_some()))
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
    /// Length of an edge of the surfaces (m).
    pub edge: f64,
    /// How fast points that begin inside another body are pushed out (m/s).
    pub settling: f64,
    surface: Surface,
}

/// What is known of the surfaces as they are.
#[derive(Clone, Debug, Default)]
struct Surface {
    triangles: Surfaces,
    /// Body and row of each node.
    nodes: Vec<(u32, u32)>,
    points: Vec<Point>,
    /// Points and triangles that are near each other at rest: never in each other's way.
    apart: Vec<(u32, u32)>,
    /// Elements that are there; `None` before anything is known.
    elements: Option<usize>,
    /// One a body.
    trees: Vec<Tree>,
    lists: Lists,
    /// Where the nodes are (m, from the reference).
    places: Vec<DVec3>,
    /// How far the two fastest points can have come towards each other since the lists were made (m).
    travelled: f64,
    /// Of each point in the lists, how far that may be before it has to be looked at again (m).
    wake: Vec<f64>,
    /// Nodes that bore a force in the last step.
    pressed: Vec<u32>,
    /// Points that touched or faced something.
    touching: Vec<u32>,
    /// How far the fastest node went in the last step (m).
    largest: f64,
    /// Place of a node in the set, or none.
    slots: Vec<u32>,
    set: ContactSet,
}

/// What is known of a body.
#[derive(QueryData)]
#[query_data(mutable)]
struct MeetingColumns {
    rest: &'static RestPosition,
    mass: &'static Mass,
    fictitious: Option<&'static FictitiousMass>,
    damping: Option<&'static DampingCoefficient>,
    axes: &'static ConstrainedAxes,
    internal: &'static InternalForce,
    external: &'static mut ExternalForce,
    u: &'static Displacement,
    step: &'static DisplacementIncrement,
    force: &'static mut ContactForce,
    touch: &'static mut SurfaceTouch,
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
    }

    /// How points of a body meet faces of another.
    fn meeting(&self, point: u32, face: u32) -> Option<Meeting> {
        self.meetings[point as usize * self.bodies.len() + face as usize]
    }

    /// The largest thickness (m).
    fn thickness(&self) -> f64 {
        self.meetings.iter().flatten().map(|meeting| meeting.thickness).fold(0.0, f64::max)
    }

    /// How far faces may be that are in a point's way (m): within reach outside, and as deep as an inside goes.
    fn farthest(&self, reach: f64) -> f64 {
        self.surface.triangles.depths.iter().copied().fold(self.thickness() + reach, f64::max)
    }

    /// How many points and faces there are.
    pub fn size(&self) -> [usize; 2] {
        [self.surface.points.len(), self.surface.triangles.triangles.len()]
    }
}

fn surface_contact(
    (clock, cpu): (Res<Clock>, Res<Cpu>),
    mut contacts: ResMut<SurfaceContacts>,
    mut bodies: Query<MeetingColumns>,
    authorings: Query<&Authoring>,
    blocks: Query<Ref<Alive>>,
) {
    let contacts = &mut *contacts;
    survey::follow(contacts, &mut bodies, &authorings, &blocks);
    let largest = survey::update_places(contacts, &bodies);
    contacts.surface.largest = largest;
    contacts.surface.travelled += 2.0 * largest;
    let reach = 4.0 * largest + survey::MARGIN * contacts.edge;
    survey::search(contacts, reach, &cpu);
    meet::meet(contacts, reach, &clock, &cpu, &mut bodies);
}
