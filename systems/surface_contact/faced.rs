//! What points face now.

use super::SurfaceContacts;
use crate::backend::cpu::Cpu;
use crate::contact::{Faced, Placed};

/// Points that a task looks at.
const POINTS_A_TASK: usize = 128;

/// What a point faces.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Found {
    /// Its place in the lists.
    pub place: u32,
    pub faced: Faced,
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

/// Finds what those face that are awake.
pub(super) fn face(contacts: &mut SurfaceContacts, reach: f64, nearer: f64, cpu: &Cpu) {
    let mut found = std::mem::take(&mut contacts.surface.found);
    let surface = &contacts.surface;
    let now = Placed { places: &surface.places, normals: &surface.normals };
    cpu.for_each(found.chunks_mut(POINTS_A_TASK), |found| {
        for Found { place, faced } in found {
            let point = &surface.points[surface.lists.points[*place as usize] as usize];
            let reach_of = |triangle: u32| {
                let body = surface.triangles.bodies[triangle as usize];
                reach + contacts.meeting(point.body, body).map_or(0.0, |meeting| meeting.thickness)
            };
            let triangles = surface.lists.triangles(*place as usize);
            *faced = surface.triangles.faced(now, point, triangles, reach_of, contacts.edge);
        }
    });
    let surface = &mut contacts.surface;
    for Found { place, faced } in &found {
        // nobody can be there before the nearest has come so far; both have moved since the lists were made
        let wake = faced.nearest - nearer;
        surface.wake[*place as usize] = wake;
        surface.first_wake = surface.first_wake.min(wake);
    }
    surface.found = found;
}
