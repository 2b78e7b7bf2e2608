//! Tools that go farther in a step than they are thick: where a node's way first meets them.

use super::Touch;
use crate::components::ToolContact;
use crate::tools::Geometry;
use glam::DVec3;

/// Steps along the way at most; who grazes a tool needs most.
const TURNS: usize = 64;

/// How near is there, as a share of what a node may go unseen.
const NEAR: f64 = 1e-3;

/// The plane that a tool's surface has where a node first meets it, in the tool's frame: the outward normal, and a
/// place.
pub(super) type Plane = (DVec3, DVec3);

impl Touch {
    /// How far a place in the tool's frame is outside of what the node must stay outside of (m), and which way out is.
    pub(super) fn surface(plane: Option<Plane>, tool: &ToolContact, at: DVec3) -> (f64, DVec3) {
        match plane {
            Some((normal, place)) => ((at - place).dot(normal), normal),
            None => tool.geometry.distance(at),
        }
    }
}

/// Where the way of a node first meets a tool, from one place to another in its frame; `None` where it never does,
/// begins inside, or is no longer than what may be looked at by its end alone (`beyond`, m).
///
/// By conservative advancement: a distance is never more than the true one, so that much of the way is free. The
/// plane is that of the nearest place on the surface; a tool that is convex there is all behind it.
pub(super) fn first_touch(geometry: &Geometry, beyond: f64, [from, to]: [DVec3; 2]) -> Option<Plane> {
    let way = from.distance(to);
    if beyond <= 0.0 || way.is_nan() || way <= beyond {
        return None;
    }
    let mut share = 0.0;
    let mut met = None;
    for turn in 0..TURNS {
        let at = from.lerp(to, share);
        let (distance, normal) = geometry.distance(at);
        if turn == 0 && distance < -NEAR * beyond {
            return None;
        }
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
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::tools::{Shape, Solid};

    fn needle() -> Geometry {
        Geometry::Analytic(Solid::new(Shape::Capsule { length: 1.0, radius: 0.1 }, 0.0).unwrap())
    }

    /// Ways across a needle, beside its middle by some part of its radius.
    #[test]
    fn a_way_meets_a_tool_where_it_first_comes_to_its_surface() {
        for beside in [0.0, 0.05, 0.09, 0.0999] {
            for long in [0.3, 1.0, 40.0] {
                let ends = [DVec3::new(-0.15, beside, 0.5), DVec3::new(-0.15 + long, beside, 0.5)];
                let (normal, place) = first_touch(&needle(), 0.05, ends).unwrap();
                let x = -(0.1_f64 * 0.1 - beside * beside).sqrt();
                // it stops within a thousandth of what it may go unseen, and nearly along the surface farther off
                assert!((place - DVec3::new(x, beside, 0.5)).length() < 2e-3, "{beside}, {long}: {place}");
                assert!((normal - DVec3::new(x, beside, 0.0) / 0.1).length() < 2e-2, "{beside}, {long}: {normal}");
                assert!((ends[0] - place).dot(normal) > 0.0 && (ends[1] - place).dot(normal) < 0.0);
            }
        }
    }

    #[test]
    fn ways_that_are_free_short_or_begin_inside_meet_nothing() {
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.5);
        let meets = |from, to| first_touch(&needle(), 0.05, [from, to]).is_some();
        assert!(!meets(at(-0.15, 0.101), at(1.0, 0.101)), "beside it");
        assert!(!meets(at(-0.15, 0.0), at(-0.1001, 0.0)), "before it");
        assert!(!meets(at(-0.12, 0.0), at(-0.08, 0.0)), "short");
        assert!(!meets(at(-0.05, 0.0), at(0.5, 0.0)), "from inside");
        assert!(!meets(at(f64::NAN, 0.0), at(0.5, 0.0)) && !meets(at(-0.15, 0.0), at(f64::NAN, 0.0)));
        // who lies on the surface but for rounding is not inside
        assert!(meets(at(-0.1 + 1e-9, 0.0), at(0.5, 0.0)));
        assert!(first_touch(&needle(), 0.0, [at(-0.15, 0.0), at(1.0, 0.0)]).is_none(), "not asked for");
    }
}
