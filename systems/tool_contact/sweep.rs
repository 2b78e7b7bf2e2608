//! Nodes that go farther in a step against a tool than it is thick, for it is fast, or they are drawn hard: where their
//! way first meets it.

use crate::tools::Geometry;
use glam::DVec3;

/// Steps along the way at most; who grazes a tool needs most.
const TURNS: usize = 64;

/// How near is there, as a share of what a node may go unseen.
const NEAR: f64 = 1e-3;

/// The plane that a tool's surface has where a node first meets it, in the tool's frame: the outward normal, and a
/// place.
pub(in crate::systems) type Plane = (DVec3, DVec3);

/// How far a place in the tool's frame is outside of what a node must stay outside of (m), and which way out is: of a
/// plane, if its way meets one, else of the tool.
pub(in crate::systems) fn surface(plane: Option<Plane>, geometry: &Geometry, at: DVec3) -> (f64, DVec3) {
    match plane {
        Some((normal, place)) => ((at - place).dot(normal), normal),
        None => geometry.distance(at),
    }
}

/// Where the way of a node first meets a tool, from one place to another in its frame; `None` where it never does, or
/// is no longer than what may be looked at by its end alone (`beyond`, m).
///
/// By conservative advancement: a distance is never more than the true one, so that much of the way is free. The plane
/// is that of the nearest place on the surface; a tool that is convex there is all behind it. Of a way that begins
/// inside it is the side that the node is nearest to where it begins.
pub(in crate::systems) fn first_touch(geometry: &Geometry, beyond: f64, [from, to]: [DVec3; 2]) -> Option<Plane> {
    let way = from.distance(to);
    if beyond <= 0.0 || way.is_nan() || way <= beyond {
        return None;
    }
    let mut share = 0.0;
    let mut met = None;
    for _ in 0..TURNS {
        let at = from.lerp(to, share);
        let (distance, normal) = geometry.distance(at);
        met = Some((normal, at - distance * normal));
        if distance <= NEAR * beyond {
            break;
        }
        share += distance / way;
        if share >= 1.0 {
            return None;
        }
    }
    met
}

#[cfg(test)]
mod tests;
