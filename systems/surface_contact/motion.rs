//! What may be left as it is while surfaces have moved so far: all of it, or lists that hold all that is near.

use super::body_slices::BodySlices;
use super::survey::MARGIN;
use super::{Meeting, MeetingColumns, MeetingColumnsReadOnlyItem, Surface, SurfaceContacts};
use super::{crossings, faced, slices_of};
use crate::backend::cpu::Cpu;
use crate::components::Clock;
use crate::contact::{Finder, Lists, Point, Shortlist};
use crate::error::Error;
use crate::math::Scalar;
use bevy_ecs::prelude::*;
use glam::DVec3;
use smallvec::{SmallVec, smallvec};
use web_time::Instant;

/// Nodes whose places a task finds, and triangles whose normals or turns.
const NUMBERS_A_TASK: usize = 1024;

/// How far nodes may move before shortlists are begun anew, in edges: at least and at most; and for how many steps of
/// the fastest node, between these.
const STAYS: [f64; 2] = [2e-3, 3e-2];
const STEPS_OF_SHORTLISTS: f64 = 40.0;

/// How far faces must be looked at when the fastest node goes so far in a step (m): of the pair with the largest edge,
/// so that lists and who sleeps hold for all.
pub(super) fn reach(contacts: &SurfaceContacts, largest: f64) -> f64 {
    4.0 * largest + MARGIN * contacts.coarsest
}

impl SurfaceContacts {
    /// How far faces of two bodies that meet are looked at (m), of the `reach` of all (m).
    pub(super) fn reach_of(&self, meeting: &Meeting, reach: f64) -> f64 {
        reach - MARGIN * (self.coarsest - meeting.edge) + meeting.thickness
    }

    /// The largest thickness (m).
    pub(super) fn thickness(&self) -> f64 {
        self.meetings.iter().flatten().map(|meeting| meeting.thickness).fold(0.0, f64::max)
    }

    /// How far faces may be that are in a point's way (m): within reach outside, and as deep as any inside goes.
    pub(super) fn farthest(&self, reach: f64) -> f64 {
        f64::max(self.thickness() + reach, self.surface.triangles.deepest())
    }

    /// The same of the body whose inside is the shallowest: of others so much more is in lists as theirs is deeper, so
    /// that what is coarse makes no lists long of what is fine.
    pub(super) fn least_farthest(&self, reach: f64) -> f64 {
        f64::max(self.thickness() + reach, self.surface.shallowest)
    }

    /// Whether the lists hold all that is within `reach` (m) and thickness. What is no number is no bound.
    pub(super) fn lists_hold(&self, reach: f64) -> bool {
        self.least_farthest(reach) + self.surface.motion.lists.moved <= self.surface.lists.radius
    }

    /// Whether shortlists hold where faces are looked at so far (m).
    pub(super) fn shortlists_hold(&self, reach: f64) -> bool {
        let Surface { shortlists, neighbourhoods, stays, motion, .. } = &self.surface;
        let is_known = !shortlists.is_empty() && !neighbourhoods.is_too_wide(self.may_move());
        is_known && reach <= stays.reach && motion.shortlists.moved <= stays.moved
    }

    /// How far nodes may move before shortlists are begun anew (m).
    pub(super) fn may_move(&self) -> f64 {
        (STEPS_OF_SHORTLISTS * self.surface.motion.largest).clamp(STAYS[0] * self.edge, STAYS[1] * self.edge)
    }
}

/// Bodies as slices, and how far faces must be looked at (m); `None` where nothing may be near anything.
type Searched<'a, T> = (Option<f64>, Vec<BodySlices<'a, T>>);

/// How far faces must be looked at in this step (m); `None` where nothing was near anything in the last step, and
/// nothing can be now.
pub(super) fn awake<T: Scalar>(
    contacts: &mut SurfaceContacts,
    of: (&Clock, &Cpu),
    bodies: &Query<(Entity, MeetingColumns)>,
) -> Option<f64> {
    let reach = follow::<T>(contacts, of, bodies);
    let sleeps = contacts.sleeps(reach);
    contacts.surface.figures.steps += 1;
    contacts.surface.figures.asleep += u64::from(sleeps);
    (!sleeps).then_some(reach)
}

/// Sees to it that points may be asked what they face; `None` where nothing was near anything in the last step, and
/// nothing can be now.
pub(super) fn search<'a, T: Scalar>(
    contacts: &mut SurfaceContacts,
    (clock, cpu): (&Clock, &Cpu),
    bodies: &'a mut Query<(Entity, MeetingColumns)>,
) -> Result<Option<Searched<'a, T>>, Error> {
    let asked = contacts.surface.reach.take();
    let Some(reach) = asked.or_else(|| awake::<T>(contacts, (clock, cpu), bodies)) else { return Ok(None) };
    let bodies = slices_of::<T>(contacts, bodies)?;
    if !contacts.lists_hold(reach) {
        list(contacts, &bodies, reach, cpu);
    }
    if !faced::wake(contacts, reach) && contacts.surface.crossings.near.is_empty() {
        contacts.surface.figures.asleep += 1;
        return Ok(Some((None, bodies)));
    }
    update_places(contacts, &bodies, cpu);
    if !contacts.shortlists_hold(reach) {
        renew_shortlists(contacts, &bodies, reach);
    }
    contacts.surface.figures.examined += contacts.surface.awake.len() as u64;
    Ok(Some((Some(reach), bodies)))
}

/// Follows how nodes move; gives how far faces must be looked at (m). It is looked where nodes are when what their
/// steps add up to is too much to leave all as it is.
fn follow<T: Scalar>(
    contacts: &mut SurfaceContacts,
    (clock, cpu): (&Clock, &Cpu),
    bodies: &Query<(Entity, MeetingColumns)>,
) -> f64 {
    let mut motion = std::mem::take(&mut contacts.surface.motion);
    // by their numbers: one way through all is quicker than to look for each
    let mut slices: SmallVec<[Option<[&[T]; 2]>; 16]> = smallvec![None; contacts.bodies.len()];
    for (entity, MeetingColumnsReadOnlyItem { nodes, .. }) in bodies {
        if let Some(of_body) = slices.get_mut(contacts.surface.number_of(entity)) {
            *of_body = Some([nodes.u.slice(), nodes.step.slice()]);
        }
    }
    let moving = |body: u32| slices[body as usize];
    motion.follow(&moving, clock, cpu);
    let reach = reach(contacts, motion.largest);
    contacts.surface.motion = motion;
    let all_hold = || !contacts.is_idle() && contacts.lists_hold(reach) && contacts.shortlists_hold(reach);
    if !contacts.sleeps(reach) && !all_hold() {
        let mut motion = std::mem::take(&mut contacts.surface.motion);
        motion.look(&moving, cpu);
        contacts.surface.motion = motion;
    }
    reach
}

/// Where a node is (m, from the reference).
#[inline(always)] // with the instructions of whoever asks
pub(super) fn place<T: Scalar>(contacts: &SurfaceContacts, bodies: &[BodySlices<'_, T>], node: usize) -> DVec3 {
    let (body, row) = contacts.surface.nodes[node];
    let (of_body, row) = (&bodies[body as usize], row as usize);
    of_body.rest[row] - contacts.reference + of_body.displacement(row)
}

/// Finds the values with these numbers, ascending, of all.
pub(super) fn fill<V: Send>(cpu: &Cpu, numbers: &[u32], mut left: &mut [V], value: impl Fn(u32) -> V + Sync) {
    let (mut first, value) = (0, &value);
    let tasks = numbers.chunks(NUMBERS_A_TASK).map(move |numbers| {
        let end = numbers.last().map_or(first, |&last| last as usize + 1);
        let (values, others) = std::mem::take(&mut left).split_at_mut(end - first);
        left = others;
        Fill { numbers, first: std::mem::replace(&mut first, end), values, value }
    });
    cpu.for_each(tasks, |task| cpu.dispatch(task));
}

/// The task of finding values with some numbers.
struct Fill<'a, V, F> {
    numbers: &'a [u32],
    /// The number of the first value.
    first: usize,
    values: &'a mut [V],
    value: &'a F,
}

impl<V, F: Fn(u32) -> V> pulp::WithSimd for Fill<'_, V, F> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { numbers, first, values, value } = self;
        numbers.iter().for_each(|&number| values[number as usize - first] = value(number));
    }
}

/// Makes the lists anew, of all that is within `reach` (m) and thickness, and a skin.
pub(super) fn list<T: Scalar>(contacts: &mut SurfaceContacts, bodies: &[BodySlices<'_, T>], reach: f64, cpu: &Cpu) {
    let farthest = contacts.least_farthest(reach);
    let started = Instant::now();
    let mut places = std::mem::take(&mut contacts.surface.places);
    places.iter_mut().enumerate().for_each(|(node, at)| *at = place(contacts, bodies, node));
    contacts.surface.places = places;
    let mut trees = std::mem::take(&mut contacts.surface.trees);
    let meets = |point: u32, face: u32, of_face: bool| contacts.meets(point, face, of_face);
    let Surface { triangles, points, places, apart, beyond, .. } = &contacts.surface;
    trees.iter_mut().for_each(|tree| tree.refit(|number| triangles.corners(places, number)));
    let finder = Finder { surfaces: triangles, points, meets: &meets, apart, beyond };
    // reach is four steps of the fastest and a little: of what is fast lists serve some steps, too; by the smallest
    // edge, since by another lists of what is fine would be long
    let of_smallest = reach - MARGIN * (contacts.coarsest - contacts.edge);
    let skin = contacts.skin * (contacts.edge + 40.0 * of_smallest).min(4.0 * contacts.edge);
    let lists = Lists::find(&finder, &trees, places, farthest + skin, cpu);
    let listed = lists.points.iter().map(|&point| points[point as usize]);
    let listed: Vec<Point> = listed.collect();
    (contacts.surface.trees, contacts.surface.lists) = (trees, lists);
    crossings::list(contacts, farthest + skin);
    let surface = &mut contacts.surface;
    let among: Vec<u32> = surface.lists.triangles.iter().copied().chain(surface.crossings.triangles()).collect();
    let near = surface.triangles.neighbourhood(listed.into_iter(), &among);
    surface.wake.clear();
    surface.wake.resize(surface.lists.points.len(), 0.0);
    (0..).zip(&near.nodes).for_each(|(slot, &node)| surface.gathered.slots[node as usize] = slot);
    surface.near = near;
    // some are near no more, and would stay as they are
    surface.turns.clear();
    surface.motion.mark_lists(bodies);
    // they are begun when somebody looks
    surface.shortlists.clear();
    surface.figures.builds += 1;
    surface.figures.building += started.elapsed();
}

/// Begins shortlists anew where nodes have moved so far that they do not hold: for nodes that move no farther than some
/// steps of the fastest will take them; and all for new lists, and where faces are looked at farther than up to now, as
/// far as twice `reach` (m).
pub(super) fn renew_shortlists<T: Scalar>(contacts: &mut SurfaceContacts, bodies: &[BodySlices<'_, T>], reach: f64) {
    let may_move = contacts.may_move();
    let Surface { triangles, points, places, lists, neighbourhoods, motion, shortlists, stays, .. } =
        &mut contacts.surface;
    motion.mark_shortlists(bodies);
    let is_known = !shortlists.is_empty() && reach <= stays.reach;
    if !is_known {
        neighbourhoods.list(triangles, points, lists);
        shortlists.resize(lists.points.len(), Shortlist::UNKNOWN);
        // of what has no bound nothing is known in the next step
        stays.reach = if reach.is_finite() { 2.0 * reach } else { 0.0 };
    }
    stays.moved = neighbourhoods.follow(places, may_move, |places| {
        shortlists.iter_mut().take(places.end).skip(places.start).for_each(|short| *short = Shortlist::UNKNOWN);
    });
}

/// Sees where the nodes are that are near something.
pub(super) fn update_places<T: Scalar>(contacts: &mut SurfaceContacts, bodies: &[BodySlices<'_, T>], cpu: &Cpu) {
    let mut places = std::mem::take(&mut contacts.surface.places);
    let of = &*contacts;
    fill(cpu, &of.surface.near.nodes, &mut places, |node| place(of, bodies, node as usize));
    contacts.surface.places = places;
}

/// Sees which way the triangles look that are near something.
pub(super) fn update_normals(surface: &mut Surface, cpu: &Cpu) {
    let Surface { near, triangles, places, normals, .. } = surface;
    fill(cpu, &near.triangles, normals, |triangle| triangles.normal(places, triangle));
}
