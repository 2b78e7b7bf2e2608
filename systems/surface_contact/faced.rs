//! What points face now.

use super::motion::update_normals;
use super::{Surface, SurfaceContacts};
use crate::backend::cpu::Cpu;
use crate::contact::{Faced, Kept, Lately, Listed, Own, Placed, Shortlist, Stays};

/// Points that a task looks at.
const POINTS_A_TASK: usize = 128;

/// The normals of all that is near are found beforehand where there are no more triangles than so many for each point
/// that is awake.
const TRIANGLES_A_POINT: usize = 8;

/// They are, too, where more than one of so many points that are awake goes through its list: else few are asked for.
const POINTS_A_LIST: usize = 8;

/// One triangle of a shortlist alone is to matter while nodes move so much of how far shortlists may serve; and it is
/// counted anew how far nodes have gone when that is so many times as much, for it is kept in few digits.
const ALONE: f64 = 0.25;
const COUNTED: f64 = 1000.0;

/// Some points that are awake, by their places in the lists, what is kept there of these and of those between, and what
/// is made of what they face.
struct Awake<'a, M> {
    places: &'a [u32],
    /// The first place of the next two.
    first: usize,
    shortlists: &'a mut [Shortlist],
    wake: &'a mut [f64],
    kept: &'a mut Kept,
    made: M,
}

/// What is the same for all points in a step.
struct Looking<'a> {
    contacts: &'a SurfaceContacts,
    now: Placed<'a>,
    /// How far faces are looked at that a point of a body meets of a body (m), at their numbers as in
    /// [`SurfaceContacts::meetings`].
    reaches: &'a [f64],
    /// How much nearer anything can have come since lists were made (m), and the farthest that is looked at (m).
    nearer: f64,
    farthest: f64,
    /// How far nodes have moved since it was looked last whether shortlists hold, and how much farther faces may be
    /// looked at (m).
    stays: Stays,
    /// How far they have gone lately.
    lately: Lately,
}

/// Who is awake: points in the lists that may be near something, as far as nodes have moved since. Whether there are
/// any.
pub(super) fn wake(contacts: &mut SurfaceContacts, reach: f64) -> bool {
    let farthest = contacts.farthest(reach) + contacts.surface.motion.lists.moved;
    let Surface { wake, first_wake, awake, .. } = &mut contacts.surface;
    awake.clear();
    *first_wake = f64::INFINITY;
    for (place, &wake) in (0..).zip(&*wake) {
        match farthest < wake {
            true => *first_wake = first_wake.min(wake),
            false => awake.push(place),
        }
    }
    !awake.is_empty()
}

/// How many tasks look at those that are awake.
pub(super) fn tasks(contacts: &SurfaceContacts) -> usize {
    contacts.surface.awake.len().div_ceil(POINTS_A_TASK)
}

/// Finds what those face that are awake, and tells it point by point, by their numbers and in their order, to whom each
/// task has been given to make something of it.
pub(super) fn face<M: Send>(
    contacts: &mut SurfaceContacts,
    reach: f64,
    cpu: &Cpu,
    mut made: impl Iterator<Item = M>,
    tell: impl Fn(&SurfaceContacts, u32, &Faced, &mut M) + Sync + Send,
) {
    let [nearer, moved] = [&contacts.surface.motion.lists, &contacts.surface.motion.shortlists].map(|mark| mark.moved);
    let surface = &mut contacts.surface;
    let awake = std::mem::take(&mut surface.awake);
    let unknown = awake.iter().filter(|&&place| !surface.shortlists[place as usize].is_known()).count();
    let are_few = surface.near.triangles.len() <= TRIANGLES_A_POINT * awake.len();
    let has_normals = are_few || POINTS_A_LIST * unknown > awake.len() || !surface.crossings.near.is_empty();
    if has_normals {
        update_normals(surface, cpu);
    }
    let mut kept = std::mem::take(&mut surface.kept_by_task);
    let mut reaches = std::mem::take(&mut surface.reaches);
    let mut shortlists = std::mem::take(&mut surface.shortlists);
    let mut wake = std::mem::take(&mut surface.wake);
    let mut lately = Lately { gone: contacts.surface.motion.gone, farther: ALONE * contacts.may_move() };
    // what is no number does not tell
    if !lately.gone.is_finite() || lately.gone > COUNTED * lately.farther {
        shortlists.iter_mut().for_each(Shortlist::count_anew);
        (lately.gone, contacts.surface.motion.gone) = (f64::INFINITY, 0.0);
    }
    kept.resize_with(kept.len().max(awake.len().div_ceil(POINTS_A_TASK)), Kept::default);
    reaches.clear();
    let meetings = contacts.meetings.iter();
    reaches.extend(meetings.map(|meeting| meeting.map_or(reach, |meeting| contacts.reach_of(&meeting, reach))));
    let stays = Stays { moved, reach: f64::max(contacts.surface.stays.reach - reach, 0.0) };
    let farthest = contacts.farthest(reach);
    let surface = &contacts.surface;
    let normals = if has_normals { &surface.normals[..] } else { &[] };
    let now = Placed { places: &surface.places, normals };
    let looking = Looking { contacts, now, reaches: &reaches, nearer, farthest, stays, lately };
    let mut left = (0, &mut shortlists[..], &mut wake[..]);
    let chunks = awake.chunks(POINTS_A_TASK).zip(&mut kept);
    let tasks = chunks.zip(&mut made).map(|((places, kept), made)| {
        let (first, shortlists, wake) = std::mem::take(&mut left);
        // places ascend
        let end = places.last().map_or(first, |&last| last as usize + 1);
        let (shortlists, shortlists_left) = shortlists.split_at_mut(end - first);
        let (wake, wake_left) = wake.split_at_mut(end - first);
        left = (end, shortlists_left, wake_left);
        Awake { places, first, shortlists, wake, kept, made }
    });
    cpu.for_each(tasks, |awake| cpu.dispatch(Face { looking: &looking, awake, tell: &tell }));
    let surface = &mut contacts.surface;
    let first = awake.iter().map(|&place| wake[place as usize]).fold(surface.first_wake, f64::min);
    (surface.awake, surface.kept_by_task, surface.reaches) = (awake, kept, reaches);
    (surface.shortlists, surface.wake, surface.first_wake) = (shortlists, wake, first);
}

/// The task of finding what some points face.
struct Face<'a, 'b, M, F> {
    looking: &'a Looking<'b>,
    awake: Awake<'a, M>,
    tell: &'a F,
}

impl<M, F: Fn(&SurfaceContacts, u32, &Faced, &mut M)> pulp::WithSimd for Face<'_, '_, M, F> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.looking.face(self.awake, self.tell);
    }
}

impl Looking<'_> {
    /// Finds what some points face.
    #[inline(always)] // with the instructions of whoever asks
    fn face<M>(&self, of: Awake<'_, M>, tell: &impl Fn(&SurfaceContacts, u32, &Faced, &mut M)) {
        let Awake { places, first, shortlists, wake, kept, mut made } = of;
        let Looking { contacts, now, .. } = *self;
        let (surface, count, mut own) = (&contacts.surface, contacts.bodies.len(), Own::default());
        let mut faced = Faced::NOTHING;
        for &place in places {
            let place = place as usize;
            let number = surface.lists.points[place];
            let (point, short) = (&surface.points[number as usize], &mut shortlists[place - first]);
            let others = point.body as usize * count..(point.body as usize + 1) * count;
            let (reaches, meetings) = (&self.reaches[others.clone()], &contacts.meetings[others]);
            let body = |triangle: u32| surface.triangles.bodies[triangle as usize] as usize;
            let reach = |triangle: u32| reaches[body(triangle)];
            let edge = |triangle: u32| meetings[body(triangle)].as_ref().map_or(contacts.edge, |meeting| meeting.edge);
            let at_a_glance = (self.nearer, (reach, self.stays.reach), edge);
            let moved = || surface.neighbourhoods.stays(place) + self.stays.moved;
            let triangles = surface.lists.triangles(place);
            let (of_point, seen) = ((now, point, (&mut *short, triangles)), (&mut faced, &mut own));
            if !surface.triangles.faced_at_a_glance(of_point, at_a_glance, (self.lately, moved), seen) {
                let distances = surface.lists.distances(place);
                let listed = Listed { triangles, distances, nearer: self.nearer, farthest: self.farthest };
                let (stays, kept) = (Stays { moved: moved(), ..self.stays }, (&mut faced, &mut *kept));
                surface.triangles.faced((now, point), listed, (reach, edge), (short, stays), kept);
            }
            if point.triangle.is_some() {
                let both = [&mut faced.first, &mut faced.second];
                both.into_iter().flatten().for_each(|facing| facing.gap = surface.gap_of_facet(point, facing));
            }
            wake[place - first] = faced.wakes;
            tell(contacts, number, &faced, &mut made);
        }
    }
}
