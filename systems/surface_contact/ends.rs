//! What points face that are before sides and corners, by where they would end.

use super::SurfaceContacts;
use super::gather::SHARES;
use crate::contact::{Facing, Point};
use glam::DVec3;

impl SurfaceContacts {
    /// What a point faces of what it sees, with its step against that (m). Where it is before a side or a corner and
    /// would end nearer than it may to the plane across the way from there, that may be a face beside it. Springs of
    /// explicit steps do not ask where these end: only where `springs` says so.
    pub(super) fn faced_at_end(
        &self,
        number: u32,
        facing: &Facing,
        springs: bool,
        step: impl FnOnce(&Point, &Facing) -> DVec3,
    ) -> Facing {
        let surface = &self.surface;
        let point = &surface.points[number as usize];
        let body = surface.triangles.bodies[facing.triangle as usize];
        let meeting = self.meeting(point.body, body).filter(|_| facing.part != 0);
        let Some(meeting) = meeting.filter(|meeting| springs || meeting.spring.is_none()) else { return *facing };
        let step = step(point, facing);
        let shares = if point.triangle.is_some() { SHARES * meeting.edge } else { 0.0 };
        let within = meeting.thickness + shares;
        if facing.normal.dot(point.place(&surface.places) + step - facing.at) >= within {
            return *facing;
        }
        let corners = |triangle: u32| surface.triangles.triangles[triangle as usize];
        let is_own = |triangle: u32| point.parts().any(|(node, _)| corners(triangle).contains(&node));
        let may_meet = |triangle: u32| !is_own(triangle) && surface.apart.binary_search(&(number, triangle)).is_err();
        let mut found = surface.triangles.flank_at_end(&surface.places, (point, step, within), *facing, may_meet);
        // of what it has faced up to now it is known
        if point.triangle.is_some() && found.part == 0 {
            found.gap = surface.gap_of_facet(point, &found);
        }
        found
    }
}
