//! The face that a point faces.

mod glance;
mod stays;

use super::candidates::{Candidates, Kept, Listed, ON_IT};
use super::shortlist::{Lately, MOST, Shortlist, Stays};
use super::surfaces::{Placed, Point, Surfaces};
use crate::mesh::OnTriangle;
use glam::DVec3;
use glance::{Glance, Only};
use smallvec::SmallVec;

/// Surfaces face one another where the cosine between their normals is below this.
pub const TURNED_AWAY: f64 = 0.2;

/// What counts for nothing of a distance between two faces that are in a point's way, in edges, the smallest of those
/// of the bodies: there the one that it faces more is. Nor is a wall one that rises no higher beside a point of a face.
pub(super) const ALIKE: f64 = 0.05;

/// Two faces are a corner where the cosine between their normals is below this (30°).
const CORNER: f64 = 0.866;

/// A face that a point faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facing {
    /// Its number.
    pub triangle: u32,
    /// What each of its corners has of the place that bears the point: of the nearest one, or of the one below it in
    /// the plane of a wall or a flank, also beyond the sides.
    pub weights: [f64; 3],
    /// The nearest place (m).
    pub at: DVec3,
    /// The unit normal, out of the face's body.
    pub normal: DVec3,
    /// How far the point is outside (m); negative inside.
    pub gap: f64,
    /// The side or corner, as [`OnTriangle::part`] counts them, that the point is before and the normal is the way
    /// from; 0 where the normal is the face's own.
    pub part: u32,
}

/// The normal of the triangle that the last point of a face was on, as is the next as a rule.
#[derive(Clone, Copy, Debug, Default)]
pub struct Own(Option<(u32, DVec3)>);

impl Own {
    /// A point's own normal: that of the triangle that it is on, or of its node.
    fn of(&mut self, surfaces: &Surfaces, now: Placed<'_>, point: &Point) -> DVec3 {
        match (point.triangle, self.0) {
            (None, _) => surfaces.normal_of_node(now, point.nodes[0]),
            (Some(triangle), Some((known, normal))) if known == triangle => normal,
            (Some(triangle), _) => self.0.insert((triangle, surfaces.normal_now(now, triangle))).1,
        }
    }
}

/// What a point faces: the face in its way, and where that is a wall of a corner, the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Faced {
    /// The face in its way.
    pub first: Option<Facing>,
    /// Another one.
    pub second: Option<Facing>,
    /// Where three walls meet that it is behind, along the way to there: in explicit steps it is borne there, and not
    /// by walls. In implicit ones the way would be that at the beginning of a long step.
    pub tip: Option<Facing>,
    /// So much nearer than when the list was made (m) something must come before there is anything to see.
    pub wakes: f64,
}

impl Faced {
    /// Nothing, which nothing changes.
    pub const NOTHING: Self = Self { first: None, second: None, tip: None, wakes: f64::INFINITY };

    /// Whether any normal is the way from a side or a corner.
    #[inline(always)] // with the instructions of whoever asks
    pub fn is_beside(&self) -> bool {
        [&self.first, &self.second].into_iter().flatten().any(|facing| facing.part != 0)
    }
}

impl Surfaces {
    /// What a point faces whose shortlist is known: where all triangles that matter but one at most are far off, beside
    /// another or behind a rim, and the point is in front of that one, as for most. Whether that is all there is to it.
    /// Nothing has come nearer since lists were made than by `nearer`, and faces are looked at that are no farther than
    /// `reach` (m), nor later by `more`; `edge` is the length of an edge (m), of a triangle's body or the point's. As
    /// long as nodes hardly move, the others stay where they are, and one is looked at alone; `moved` tells how far
    /// they may while the shortlist holds (m).
    #[inline(always)] // with the instructions of whoever asks
    pub fn faced_at_a_glance(
        &self,
        (now, point, (short, listed)): (Placed<'_>, &Point, (&mut Shortlist, &[u32])),
        (nearer, (reach, more), edge): (f64, (impl Fn(u32) -> f64, f64), impl Fn(u32) -> f64),
        (lately, moved): (Lately, impl FnOnce() -> f64),
        (faced, own): (&mut Faced, &mut Own),
    ) -> bool {
        let Some((triangles, first)) = short.triangles_now(lately) else { return false };
        *faced = Faced { wakes: short.wakes, ..Faced::NOTHING };
        if triangles.is_empty() {
            return true;
        }
        let glance = Glance { surfaces: self, now, point, at: point.place(now.places), reach, edge };
        let mut seen = [(0.0, 0); MOST];
        let (place, found) = match glance.only(triangles, &mut seen, (nearer, &mut faced.wakes)) {
            Only::Nothing => return true,
            Only::One(place, found) => (place, found),
            Only::More => return false,
        };
        let (triangle, number) = (triangles[place], first + place);
        if triangles.len() > 1 && short.may_be_alone(lately) {
            let is_alone = glance.stays_alone((triangles, &seen), place, (lately.farther, more));
            short.note_alone(is_alone.then_some(number), lately);
        }
        let ask = || {
            if !short.is_asked(number) {
                short.note_asked(number, self.ask((now, point), triangle, moved()));
            }
            (short.may_have_rim(number).then_some(listed), short.is_turned_away(number))
        };
        faced.first = glance.in_front((triangle, found), ask, own);
        true
    }

    /// Whether a place is outside of a triangle that is nearest at a part of it: then it is so as far as that is away,
    /// which [`Candidates::outside`] gives.
    fn is_outside(&self, (now, at): (Placed<'_>, DVec3), (triangle, part): (u32, usize)) -> bool {
        let nearest = OnTriangle::nearest(at, self.corners(now.places, triangle)).at;
        (at - nearest).dot(self.normal_of_part(now, triangle, part)) >= 0.0
    }

    /// Whether any triangle that shares a part of one is nearer to a place than a distance (m).
    fn goes_on_nearer(&self, (places, at): (&[DVec3], DVec3), (triangle, part): (u32, usize), distance: f64) -> bool {
        let mut others = self.around_part(triangle, part).filter(|&other| other != triangle);
        others.any(|other| at.distance(OnTriangle::nearest(at, self.corners(places, other)).at) < distance)
    }

    /// What a point faces among the triangles of its list that are no farther than `reach` (m), and which of them
    /// matter as long as nodes move no farther than a shortlist allows for; where that is known, the others are not
    /// looked at. `edge` is the length of an edge (m), of a triangle's body or the point's.
    #[inline(never)] // all points would make room for what few need
    pub fn faced(
        &self,
        (now, point): (Placed<'_>, &Point),
        listed: Listed<'_>,
        (reach, edge): (impl Fn(u32) -> f64, impl Fn(u32) -> f64),
        (short, stays): (&mut Shortlist, Stays),
        (faced, kept): (&mut Faced, &mut Kept),
    ) {
        let Kept { nearest } = kept;
        let at = point.place(now.places);
        let mut candidates = Candidates::new((self, now), at, listed, nearest);
        let (triangles, reach, edge) = (listed.triangles, &reach, &edge);
        let (own, seen, before) = (None, SmallVec::new(), SmallVec::new());
        let mut way = Way { surfaces: self, now, point, at, triangles, reach, edge, own, seen, before };
        let mut wakes = f64::INFINITY;
        let mut look = |candidates: &Candidates<'_, '_>, number: usize, triangle: u32| {
            let &(found, distance) = candidates.nearest(number);
            // both have moved since the list was made
            wakes = wakes.min(distance - listed.nearer);
            let (reach, depth) = (reach(triangle), self.depths[triangle as usize]);
            if distance > reach && distance > depth {
                return;
            }
            let Some(facing) = candidates.outside(triangle, (found, distance), edge(triangle)) else { return };
            if facing.gap > 0.0 {
                way.before.push((triangle, facing.gap));
            }
            if facing.gap >= -depth && facing.gap <= reach {
                way.seen.push(facing);
            }
        };
        match short.triangles() {
            Some(triangles) => {
                triangles.iter().for_each(|&triangle| candidates.find(triangle));
                triangles.iter().enumerate().for_each(|(number, &triangle)| look(&candidates, number, triangle));
            }
            None => {
                candidates.find_listed();
                let away = |place: usize| {
                    let triangle = listed.triangles[place];
                    candidates.stays_away(place, (reach(triangle), edge(triangle)), stays)
                };
                let nearest = |place: usize| match listed.is_far(place) {
                    true => listed.distance(place),
                    false => candidates.nearest(place).1 - listed.nearer,
                };
                *short = Shortlist::of(listed.triangles, away, nearest);
                // what stays away is in nobody's way now
                for (place, triangle) in listed.triangles.iter().enumerate() {
                    if !listed.is_far(place) && short.triangles().is_none_or(|left| left.contains(triangle)) {
                        look(&candidates, place, *triangle);
                    }
                }
                wakes = (0..listed.triangles.len()).map(nearest).fold(wakes, f64::min);
            }
        }
        *faced = Faced { wakes: wakes.min(short.wakes), ..way.finish() };
    }

    /// Whether two faces are walls of a corner that the point is in: the second rises before the first. A node on an
    /// edge has both its flanks, too. A point of a face is never on one, and a wall that falls off beside it, with a
    /// corner in the first's plane or one that rounding lifts a little, would push it along the face. Where the first
    /// is behind the second, the second falls off beyond a rim, and bent faces lift its edge a little.
    fn is_corner(&self, places: &[DVec3], point: &Point, [first, second]: [&Facing; 2], edge: f64) -> bool {
        let is_above = point.triangle.is_none() && first.normal.dot(second.at - first.at) > 0.0;
        let is_before = second.normal.dot(first.at - second.at) > -ALIKE * edge;
        let rises = || is_above || self.rises(places, second.triangle, (first.at, first.normal), edge);
        first.normal.dot(second.normal) < CORNER && is_before && rises()
    }

    /// Whether a triangle goes on farther out than a plane through a place with such a normal, by more than what counts
    /// for nothing of an `edge` (m).
    fn rises(&self, places: &[DVec3], triangle: u32, (at, normal): (DVec3, DVec3), edge: f64) -> bool {
        self.corners(places, triangle).into_iter().any(|corner| normal.dot(corner - at) > ALIKE * edge)
    }

    /// Whether a wall rises before a triangle at a side or corner of it, with such a normal through a place there.
    pub(super) fn rises_beside(
        &self,
        now: Placed<'_>,
        (triangle, part): (u32, usize),
        (at, normal): (DVec3, DVec3),
        edge: f64,
    ) -> bool {
        self.around_part(triangle, part).any(|other| {
            self.normal_now(now, other).dot(normal) < CORNER && self.rises(now.places, other, (at, normal), edge)
        })
    }

    /// A point's own normal.
    fn own_normal(&self, now: Placed<'_>, point: &Point) -> DVec3 {
        match point.triangle {
            Some(triangle) => self.normal_now(now, triangle),
            None => self.normal_of_node(now, point.nodes[0]),
        }
    }

    /// Whether a direction is turned away from the normals of all triangles around a node: then it is from the node's
    /// own, which lies between them.
    fn all_turned_away(&self, now: Placed<'_>, node: u32, normal: DVec3) -> bool {
        self.around(node).iter().all(|&triangle| self.normal_now(now, triangle).dot(normal) <= 0.0)
    }
}

/// How little a face is in a point's way, whose normal's cosine with the point's own is `turned`. Outside the nearest
/// is most in its way, or with a thickness it would come nearer to that one for the sake of another. Inside, and at an
/// edge, where the walls beside a face are as near as itself, it is the one that it faces more.
fn in_way(facing: &Facing, turned: f64, edge: f64) -> f64 {
    facing.gap.max(0.0) + ((-facing.gap).max(0.0) + ALIKE * edge) * (1.0 + TURNED_AWAY + turned)
}

/// The faces that are in a point's way, of those seen so far.
struct Way<'a, R, E> {
    surfaces: &'a Surfaces,
    now: Placed<'a>,
    point: &'a Point,
    /// Where it is (m).
    at: DVec3,
    /// The triangles that may be near it.
    triangles: &'a [u32],
    /// How far off triangles are looked at (m).
    reach: &'a R,
    /// The length of an edge (m), of a triangle's body or the point's.
    edge: &'a E,
    /// The point's own normal, once somebody has asked for it.
    own: Option<DVec3>,
    /// Those that it sees.
    seen: SmallVec<[Facing; 4]>,
    /// Triangles that it is in front of, and how far (m).
    before: SmallVec<[(u32, f64); 4]>,
}

impl<R: Fn(u32) -> f64, E: Fn(u32) -> f64> Way<'_, R, E> {
    /// What is in its way: where only one is seen, that it is turned away is all that is asked. Another one is that of
    /// all walls of a corner with the first which is most in its way: before a node several triangles are as near.
    /// Behind three there is where they meet: of any two others would count from step to step.
    fn finish(mut self) -> Faced {
        let seen = std::mem::take(&mut self.seen);
        let is_there = |facing: &&Facing| !self.is_behind_another(facing, &seen);
        let seen: SmallVec<[Facing; 4]> = seen.iter().filter(is_there).copied().collect();
        if let [only] = seen[..]
            && self.point.triangle.is_none()
            && !self.surfaces.is_at_rim(self.now, &only, (self.edge)(only.triangle))
            && self.surfaces.all_turned_away(self.now, self.point.nodes[0], only.normal)
        {
            return Faced { first: Some(only), ..Faced::NOTHING };
        }
        let faced: SmallVec<[(Facing, f64); 4]> = seen.into_iter().filter_map(|facing| self.ask(facing)).collect();
        let Some(first) = self.most_in_way(faced.iter().copied()) else { return Faced::NOTHING };
        let is_wall = |(other, _): &(Facing, f64)| {
            let edge = self.of_both(first.triangle, other.triangle);
            self.surfaces.is_corner(self.now.places, self.point, [&first, other], edge)
        };
        let walls: SmallVec<[(Facing, f64); 4]> = faced.into_iter().filter(is_wall).collect();
        let second = self.most_in_way(walls.iter().copied());
        let is_behind = |facing: Facing| facing.gap < 0.0;
        let is_third = |second: Facing| {
            walls.iter().any(|&(other, _)| is_behind(other) && other.normal.dot(second.normal) < CORNER)
        };
        let is_tip = is_behind(first) && second.is_some_and(|second| is_behind(second) && is_third(second));
        let deepest = walls.iter().map(|(other, _)| other.gap).fold(first.gap, f64::min);
        let tip = if is_tip { self.where_they_meet(first, deepest) } else { None };
        Faced { first: Some(first), second, tip, ..Faced::NOTHING }
    }

    /// The place of a wall that is nearest to it, along the way to there, with the depth (m, negative) that it has in
    /// one of those that meet there: so that is not another one where it comes before one of them.
    fn where_they_meet(&self, wall: Facing, deepest: f64) -> Option<Facing> {
        let Self { surfaces, now, at, .. } = *self;
        let found = OnTriangle::nearest(at, surfaces.corners(now.places, wall.triangle));
        let normal = (found.at - at).try_normalize()?;
        Some(Facing { weights: found.weights, at: found.at, normal, gap: deepest, ..wall })
    }

    /// The one of some that is most in its way, each with the cosine between its normal and the point's own.
    fn most_in_way(&self, some: impl Iterator<Item = (Facing, f64)>) -> Option<Facing> {
        let more = |most: (Facing, f64), other: (Facing, f64)| {
            let edge = self.of_both(most.0.triangle, other.0.triangle);
            let [of_most, of_other] = [most, other].map(|(facing, turned)| in_way(&facing, turned, edge));
            if of_other < of_most { other } else { most }
        };
        some.reduce(more).map(|(facing, _)| facing)
    }

    /// What the point faces of something that it sees, with the cosine between its normal and the point's own, if it
    /// faces it.
    fn ask(&mut self, facing: Facing) -> Option<(Facing, f64)> {
        let Self { surfaces, now, point, edge, .. } = *self;
        let own = *self.own.get_or_insert_with(|| surfaces.own_normal(now, point));
        let listed = (self.triangles, ((self.reach)(facing.triangle), edge(facing.triangle)));
        let facing = surfaces.flank(now, (point, || own), listed, facing)?;
        let turned = facing.normal.dot(own);
        (turned < TURNED_AWAY).then_some((facing, turned))
    }

    /// Whether a point that is deep in a face is outside of the body, beyond what is thin behind that: in front of
    /// another face of the same body that is nearer. To what is beside a wall of a corner nothing of the body is nearer
    /// than where walls meet, neither in front of nor behind it.
    fn is_behind_another(&self, facing: &Facing, seen: &[Facing]) -> bool {
        let (deep, bodies) = (ALIKE * (self.edge)(facing.triangle), &self.surfaces.bodies);
        let is_of_body = |other: u32| bodies[other as usize] == bodies[facing.triangle as usize];
        let distance = self.at.distance(facing.at);
        if facing.part == 0 && distance > (1.0 + ALIKE) * facing.gap.abs() {
            let is_nearer = |other: u32, away: f64| is_of_body(other) && away + deep < distance;
            return self.before.iter().any(|&(other, gap)| is_nearer(other, gap))
                || seen.iter().any(|other| is_nearer(other.triangle, self.at.distance(other.at)));
        }
        // an edge where more than two faces meet is as near to all of them
        let nearer = (1.0 + ON_IT) * -facing.gap;
        let is_nearer = |&(other, gap): &(u32, f64)| is_of_body(other) && gap > deep && gap < nearer;
        facing.gap < -deep && self.before.iter().any(is_nearer)
    }

    /// The length of an edge of two bodies' faces, the smaller one, so that neither is favoured (m).
    fn of_both(&self, one: u32, other: u32) -> f64 {
        f64::min((self.edge)(one), (self.edge)(other))
    }
}

#[cfg(test)]
pub(super) mod tests;
