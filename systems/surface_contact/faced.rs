//! What points face now.

use super::SurfaceContacts;
use crate::backend::cpu::Cpu;
use crate::contact::{Faced, Listed, Placed};

/// Points that a task looks at.
const POINTS_A_TASK: usize = 128;

/// What a point faces.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Found {
    /// Its place in the lists.
    pub place: u32,
    pub faced: Faced,
    pub steady: Steady,
}

/// Who is awake: points in the lists that may be near something, as far as `nearer` (m) nodes have moved since. Whether
/// there are any.
pub(super) fn wake(contacts: &mut SurfaceContacts, reach: f64, nearer: f64) -> bool {
    let farthest = contacts.farthest(reach);
    let surface = &mut contacts.surface;
    surface.found.clear();
    surface.first_wake = f64::INFINITY;
    for (place, &wake) in (0..).zip(&surface.wake) {
        if nearer + farthest < wake {
            surface.first_wake = surface.first_wake.min(wake);
        } else {
            surface.found.push(Found { place, ..Found::default() });
        }
    }
    !surface.found.is_empty()
}

/// What a point faced when it was looked at last, as long as that is so.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Steady {
    /// Until nodes have [travelled](super::Surface::travelled) so far (m); 0 where that is not known.
    until: f64,
    /// How often it is not worth while to ask how long that will be so, since the last answer served for no step.
    waits: u8,
    /// The triangle; none where it faced nothing.
    triangle: Option<u32>,
}

/// So often it is not asked again after an answer that served for no step.
const WAITS: u8 = 16;

/// Finds what those face that are awake.
pub(super) fn face(contacts: &mut SurfaceContacts, reach: f64, nearer: f64, cpu: &Cpu) {
    let farthest = contacts.farthest(reach);
    let mut found = std::mem::take(&mut contacts.surface.found);
    let surface = &contacts.surface;
    let is_steady = |found: &&Found| surface.travelled < surface.steady[found.place as usize].until;
    let unsteady = found.len() - found.iter().filter(is_steady).count();
    // each of them asks for some twenty
    if 16 * unsteady > surface.near.triangles.len() || !surface.crossings.near.is_empty() {
        super::motion::find_normals(contacts, cpu);
    }
    let surface = &contacts.surface;
    let normals = if surface.has_normals { &*surface.normals } else { &[] };
    let now = Placed { places: &surface.places, normals };
    cpu.for_each(found.chunks_mut(POINTS_A_TASK), |found| {
        for Found { place, faced, steady } in found {
            let point = &surface.points[surface.lists.points[*place as usize] as usize];
            let reach_of = |triangle: u32| {
                let body = surface.triangles.bodies[triangle as usize];
                reach + contacts.meeting(point.body, body).map_or(0.0, |meeting| meeting.thickness)
            };
            let place = *place as usize;
            *steady = surface.steady[place];
            let first = match steady.triangle.filter(|_| surface.travelled < steady.until) {
                Some(triangle) => {
                    surface.triangles.still_faced(&surface.places, point, triangle, reach_of(triangle)).map(Some)
                }
                None => (surface.travelled < steady.until).then_some(None),
            };
            if let Some(first) = first {
                *faced = Faced { first, wakes: surface.wake[place], ..Faced::default() };
                steady.waits = 0;
            } else {
                let (triangles, distances) = (surface.lists.triangles(place), surface.lists.distances(place));
                let listed = Listed { triangles, distances, nearer, farthest };
                let foresees = contacts.remembers && steady.waits == 0;
                *faced = surface.triangles.faced(now, point, listed, reach_of, (contacts.edge, foresees));
                let waits = if foresees { WAITS } else { steady.waits.saturating_sub(1) };
                let until = if foresees { surface.travelled + faced.steady } else { 0.0 };
                *steady = Steady { until, waits, triangle: faced.first.map(|first| first.triangle) };
            }
            if point.triangle.is_some() {
                let both = [&mut faced.first, &mut faced.second];
                both.into_iter().flatten().for_each(|facing| facing.gap = surface.gap_of_facet(point, facing));
            }
        }
    });
    let surface = &mut contacts.surface;
    surface.figures.searched += unsteady as u64;
    for Found { place, faced, steady } in &found {
        surface.wake[*place as usize] = faced.wakes;
        surface.steady[*place as usize] = *steady;
        surface.first_wake = surface.first_wake.min(faced.wakes);
    }
    surface.found = found;
}
