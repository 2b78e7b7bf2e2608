//! How surfaces have turned in the last step: what friction holds above them by a thickness goes along.

use super::body_slices::{BodySlices, vector};
use super::motion::{fill, place};
use super::{Meeting, Surface, SurfaceContacts};
use crate::backend::cpu::Cpu;
use crate::contact::{Facing, Point};
use crate::math::Scalar;
use glam::DVec3;

/// How all that is near has turned is found beforehand where there are no more triangles than so many for each point
/// that faced something in the last step: a contact asks for some twenty.
const TRIANGLES_A_POINT: usize = 12;

/// How a triangle has turned in the last step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// Twice its area along its normal in the middle of the step (m²), and that normal.
    area: DVec3,
    normal: DVec3,
    /// How that area has changed (m²).
    change: DVec3,
}

impl Turn {
    /// Of a triangle.
    #[inline(always)] // with the instructions of whoever asks
    fn of<T: Scalar>(contacts: &SurfaceContacts, bodies: &[BodySlices<'_, T>], triangle: u32) -> Self {
        let Surface { triangles, nodes, .. } = &contacts.surface;
        let corners = triangles.triangles[triangle as usize];
        // it may be beyond what is near, whose places are not followed
        let [a, b, c] = corners.map(|corner| place(contacts, bodies, corner as usize));
        let [by_a, by_b, by_c] = corners.map(|corner| {
            let (body, row) = nodes[corner as usize];
            vector(bodies[body as usize].step, row as usize)
        });
        // sides in the middle of the step, and how they changed in it
        let [by_b, by_c] = [by_b - by_a, by_c - by_a];
        let [b, c] = [b - a - 0.5 * by_b, c - a - 0.5 * by_c];
        let area = b.cross(c);
        Self { area, normal: area.normalize_or_zero(), change: by_b.cross(c) + b.cross(by_c) }
    }
}

impl Meeting {
    /// Whether points go along with what turns: what nothing holds does not.
    fn goes_along(&self) -> bool {
        self.thickness > 0.0 && self.friction != [0.0; 2]
    }
}

impl SurfaceContacts {
    /// How far the end of a normal as long as the thickness has gone in the last step as the surface turned where a
    /// point faces it (m): a point that stays above the same place goes as far along it. Around each node that bears
    /// the point all triangles count: above nodes and sides several are as near, single ones of them rock as tissue
    /// rings, and what goes along with one of these is pushed aside.
    pub(super) fn turned<T: Scalar>(
        &self,
        meeting: &Meeting,
        (point, facing): (&Point, &Facing),
        bodies: &[BodySlices<'_, T>],
    ) -> DVec3 {
        if !meeting.goes_along() {
            return DVec3::ZERO;
        }
        let (corners, weights) = self.surface.corners_of(point, facing);
        let mut turn = DVec3::ZERO;
        for (node, weight) in corners.into_iter().zip(weights).filter(|(_, weight)| *weight != 0.0) {
            turn += weight * self.turn_around(node, facing.normal, bodies);
        }
        meeting.thickness * turn.cross(facing.normal)
    }

    /// How the surface around a node has turned in the last step (rad), but for turns about its own normal. Triangles
    /// count by their areas, and the more the more they look along `normal`: walls beyond a rim, that turn otherwise,
    /// do not, and none begins to count all at once.
    fn turn_around<T: Scalar>(&self, node: u32, normal: DVec3, bodies: &[BodySlices<'_, T>]) -> DVec3 {
        let Surface { triangles, turns, .. } = &self.surface;
        let [mut across, mut change] = [DVec3::ZERO; 2];
        for &triangle in triangles.around(node) {
            let known = turns.get(triangle as usize).copied().flatten();
            let of_triangle = known.unwrap_or_else(|| Turn::of(self, bodies, triangle));
            let share = normal.dot(of_triangle.normal).max(0.0);
            across += share * of_triangle.area;
            change += share * of_triangle.change;
        }
        let size = across.length();
        if size > 0.0 { (across / size).cross(change / size) } else { DVec3::ZERO }
    }
}

/// Sees how the triangles have turned that are near something, where many will be asked for.
pub(super) fn update<T: Scalar>(contacts: &mut SurfaceContacts, bodies: &[BodySlices<'_, T>], cpu: &Cpu) {
    let mut turns = std::mem::take(&mut contacts.surface.turns);
    let of = &*contacts;
    let Surface { triangles, near, touching, .. } = &of.surface;
    let are_few = near.triangles.len() <= TRIANGLES_A_POINT * touching.len();
    if are_few && of.meetings.iter().flatten().any(Meeting::goes_along) {
        turns.resize(triangles.triangles.len(), None);
        fill(cpu, &near.triangles, &mut turns, |triangle| Some(Turn::of(of, bodies, triangle)));
    } else {
        turns.clear();
    }
    contacts.surface.turns = turns;
}
