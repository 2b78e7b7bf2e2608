//! A look at the triangles of a shortlist of which one at most matters, as for most points.

use super::{Facing, Own, TURNED_AWAY};
use crate::contact::candidates::{NEARER, ON_IT};
use crate::contact::shortlist::MOST;
use crate::contact::surfaces::{Placed, Point, Surfaces};
use crate::mesh::OnTriangle;
use glam::DVec3;

/// What is near a point of whose shortlist one triangle at most is to be looked at.
pub(super) enum Only {
    Nothing,
    /// Its place in the shortlist, and where it is nearest.
    One(usize, OnTriangle),
    More,
}

/// A look at the triangles of a point's shortlist, which is known.
pub(super) struct Glance<'a, R, E> {
    pub surfaces: &'a Surfaces,
    pub now: Placed<'a>,
    pub point: &'a Point,
    /// Where it is (m).
    pub at: DVec3,
    /// How far off triangles are looked at (m).
    pub reach: R,
    /// The length of an edge (m), of a triangle's body or the point's.
    pub edge: E,
}

impl<R: Fn(u32) -> f64, E: Fn(u32) -> f64> Glance<'_, R, E> {
    /// The one triangle that matters: others are far off, beside another or behind a rim. Writes how far off each is
    /// (m) and which part of it is nearest; for `wakes` see [`Faced`].
    #[inline(always)]
    pub fn only(&self, triangles: &[u32], seen: &mut [(f64, usize); MOST], (nearer, wakes): (f64, &mut f64)) -> Only {
        let (mut only, mut beside) = (Only::Nothing, 0_u16);
        for (place, &triangle) in triangles.iter().enumerate() {
            let found = OnTriangle::nearest(self.at, self.surfaces.corners(self.now.places, triangle));
            let distance = self.at.distance(found.at);
            seen[place] = (distance, found.part);
            *wakes = wakes.min(distance - nearer);
            if distance > self.surfaces.depths[triangle as usize] && distance > (self.reach)(triangle) {
                continue;
            }
            if found.part != 0 && distance > ON_IT * (self.edge)(triangle) {
                beside |= 1 << place;
            } else if let Only::Nothing = only {
                only = Only::One(place, found);
            } else {
                return Only::More;
            }
        }
        let mut beside = (0..triangles.len()).filter(|place| beside >> place & 1 == 1);
        let away = if let Only::One(one, _) = only { seen[one].0 } else { 0.0 };
        if beside.all(|place| self.is_told((triangles, seen), place, away)) { only } else { Only::More }
    }

    /// Whether a triangle whose rim is what is nearest matters to nobody: another that shares it is nearer. The one
    /// that matters is so far `away` (m): who is behind that, and nearer outside of another, is not in the body.
    #[inline(always)]
    fn is_told(&self, (triangles, seen): (&[u32], &[(f64, usize)]), place: usize, away: f64) -> bool {
        let Self { surfaces, now, at, .. } = *self;
        let (triangle, (distance, part)) = (triangles[place], seen[place]);
        let farthest = NEARER * distance;
        let mut others = triangles.iter().zip(seen).filter(|(_, (distance, _))| *distance < farthest);
        // those that show it are not all in shortlists; beyond a rim there are none, and what is outside there is so as
        // far as it is away
        others.any(|(&other, _)| surfaces.shares_part(other, triangle, part))
            || distance > (self.reach)(triangle)
                && distance > (1.0 + ON_IT) * away
                && surfaces.is_outside((now, at), (triangle, part))
            || surfaces.goes_on_nearer((now.places, at), (triangle, part), farthest)
    }

    /// Whether all others stay where they need not be looked at, as long as no two nodes move against each other by
    /// more than `gone` (m) and triangles are looked at that are farther by no more than `more` (m).
    #[inline(always)]
    pub fn stays_alone(
        &self,
        (triangles, seen): (&[u32], &[(f64, usize)]),
        place: usize,
        (gone, more): (f64, f64),
    ) -> bool {
        let Self { surfaces, now, at, .. } = *self;
        let (triangle, nearest) = (triangles[place], seen[place].0);
        triangles.iter().zip(seen).all(|(&other, &(distance, part))| {
            let within = f64::max(surfaces.depths[other as usize], (self.reach)(other) + more);
            other == triangle
                || distance - gone > f64::max(within, nearest + gone)
                || distance - gone > ON_IT * (self.edge)(other)
                    && nearest + gone < NEARER * (distance - gone)
                    && surfaces.shares_part(triangle, other, part)
                    && OnTriangle::stays_nearest(at, surfaces.corners(now.places, other), part, gone)
        })
    }

    /// What the point faces of a triangle that is looked at alone. It is asked for the triangles that may be near where
    /// it may have a rim, and whether it stays turned away from all around the point.
    #[inline(always)]
    pub fn in_front<'r>(
        &self,
        (triangle, OnTriangle { at: nearest, weights, .. }): (u32, OnTriangle),
        ask: impl FnOnce() -> (Option<&'r [u32]>, bool),
        own: &mut Own,
    ) -> Option<Facing> {
        let Self { surfaces, now, point, at, .. } = *self;
        let normal = surfaces.normal_now(now, triangle);
        let gap = (at - nearest).dot(normal);
        if !(gap >= -surfaces.depths[triangle as usize] && gap <= (self.reach)(triangle)) || normal == DVec3::ZERO {
            return None;
        }
        let mut facing = Facing { triangle, weights, at: nearest, normal, gap, part: 0 };
        let (mut of_point, (rims, is_turned_away)) = (None, ask());
        if let Some(listed) = rims {
            let ask = || *of_point.insert(own.of(surfaces, now, point));
            let within = ((self.reach)(triangle), (self.edge)(triangle));
            facing = surfaces.flank(now, (point, ask), (listed, within), facing)?;
        }
        let is_turned_away = match (of_point, point.triangle) {
            (Some(own), _) => facing.normal.dot(own) < TURNED_AWAY,
            (None, Some(_)) => normal.dot(own.of(surfaces, now, point)) < TURNED_AWAY,
            // of one at a rim, with walls beside it, its own normal is asked
            (None, None) => {
                is_turned_away
                    || surfaces.all_turned_away(now, point.nodes[0], normal)
                    || normal.dot(own.of(surfaces, now, point)) < TURNED_AWAY
            }
        };
        is_turned_away.then_some(facing)
    }
}

#[cfg(test)]
mod tests;
