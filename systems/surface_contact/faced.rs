//! What points face now.

use super::{Surface, SurfaceContacts};
use crate::backend::cpu::Cpu;
use crate::contact::{Faced, Kept, Listed, Placed, Shortlist, Stays};

/// Points that a task looks at.
const POINTS_A_TASK: usize = 128;

/// What a point faces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// Its place in the lists.
    pub place: u32,
    pub faced: Faced,
    /// What of its list matters.
    short: Shortlist,
}

impl Found {
    const NONE: Self = Self { place: 0, faced: Faced::NOTHING, short: Shortlist::UNKNOWN };
}

/// Who is awake: points in the lists that may be near something, as far as nodes have moved since. Whether there are
/// any.
pub(super) fn wake(contacts: &mut SurfaceContacts, reach: f64) -> bool {
    let farthest = contacts.farthest(reach) + contacts.surface.motion.lists.moved;
    let Surface { wake, first_wake, found, .. } = &mut contacts.surface;
    let mut awake = 0;
    *first_wake = f64::INFINITY;
    for (place, &wake) in (0..).zip(&*wake) {
        if farthest < wake {
            *first_wake = first_wake.min(wake);
            continue;
        }
        // what was found in the last step is written over
        match found.get_mut(awake) {
            Some(found) => found.place = place,
            None => found.push(Found { place, ..Found::NONE }),
        }
        awake += 1;
    }
    found.truncate(awake);
    awake > 0
}

/// Finds what those face that are awake.
pub(super) fn face(contacts: &mut SurfaceContacts, reach: f64, cpu: &Cpu) {
    let farthest = contacts.farthest(reach);
    let [nearer, lately] = [&contacts.surface.motion.lists, &contacts.surface.motion.shortlists].map(|mark| mark.moved);
    let mut found = std::mem::take(&mut contacts.surface.found);
    let mut kept = std::mem::take(&mut contacts.surface.kept_by_task);
    let tasks = found.len().div_ceil(POINTS_A_TASK);
    kept.resize_with(kept.len().max(tasks), Kept::default);
    let surface = &contacts.surface;
    let now = Placed { places: &surface.places, normals: &surface.normals };
    // what has moved so far may move back, too
    let stays = Stays { moved: surface.stays.moved + lately, reach: surface.stays.reach - reach };
    cpu.for_each(found.chunks_mut(POINTS_A_TASK).zip(&mut kept), |(found, kept)| {
        for Found { place, faced, short } in found {
            *short = surface.shortlists[*place as usize];
            let point = &surface.points[surface.lists.points[*place as usize] as usize];
            let reach_of = |triangle: u32| {
                let body = surface.triangles.bodies[triangle as usize];
                reach + contacts.meeting(point.body, body).map_or(0.0, |meeting| meeting.thickness)
            };
            let place = *place as usize;
            let (triangles, distances) = (surface.lists.triangles(place), surface.lists.distances(place));
            let listed = Listed { triangles, distances, nearer, farthest };
            surface.triangles.faced(now, point, listed, (reach_of, contacts.edge), (short, stays), (faced, kept));
            if point.triangle.is_some() {
                let both = [&mut faced.first, &mut faced.second];
                both.into_iter().flatten().for_each(|facing| facing.gap = surface.gap_of_facet(point, facing));
            }
        }
    });
    let surface = &mut contacts.surface;
    for Found { place, faced, short } in &found {
        surface.shortlists[*place as usize] = *short;
        surface.wake[*place as usize] = faced.wakes;
        surface.first_wake = surface.first_wake.min(faced.wakes);
    }
    (surface.found, surface.kept_by_task) = (found, kept);
}
