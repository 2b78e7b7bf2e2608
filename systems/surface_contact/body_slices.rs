//! What a step needs of the bodies, as plain slices: fetched once a step.

use super::{MeetingColumns, SurfaceContacts};
use crate::components::*;
use crate::math::Scalar;
pub(super) use crate::math::vector_at;
use crate::systems::grasp::Grip;
use crate::systems::node_slices::NodeSlices;
pub(super) use crate::systems::node_slices::{set_vector, vector};
use bevy_ecs::prelude::*;
use std::ops::{Deref, DerefMut};

/// Columns of a body in the run's precision, a row a node, and what is kept of its surface.
pub(super) struct BodySlices<'a, T> {
    nodes: NodeSlices<'a, T>,
    pub force: &'a mut [T],
    pub touch: &'a mut [T],
    /// Of points of faces; empty where there are none.
    pub face_touch: &'a mut [T],
    /// Where tools may hold its nodes.
    pub grip: Option<Grip<'a, T>>,
}

impl<'a, T> Deref for BodySlices<'a, T> {
    type Target = NodeSlices<'a, T>;
    fn deref(&self) -> &NodeSlices<'a, T> {
        &self.nodes
    }
}

impl<'a, T> DerefMut for BodySlices<'a, T> {
    fn deref_mut(&mut self) -> &mut NodeSlices<'a, T> {
        &mut self.nodes
    }
}

/// Where the numbers of a point are: of a body, in [`SurfaceTouch`] or [`FaceTouch`], from one on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kept {
    pub body: usize,
    pub of_face: bool,
    pub first: usize,
}

/// Of all bodies, in the order of [`SurfaceContacts::bodies`].
pub(super) fn slices<'a, T: Scalar>(
    contacts: &SurfaceContacts,
    bodies: &'a mut Query<'_, '_, (Entity, MeetingColumns)>,
) -> Vec<BodySlices<'a, T>> {
    let mut all: Vec<(usize, BodySlices<'a, T>)> = Vec::with_capacity(contacts.bodies.len());
    for (entity, columns) in bodies {
        let of_body = BodySlices {
            nodes: NodeSlices::of(columns.nodes),
            force: columns.force.into_inner().slice_mut(),
            touch: columns.touch.into_inner().slice_mut(),
            face_touch: columns.face_touch.map_or(&mut [], |touch| touch.into_inner().slice_mut()),
            grip: columns.grip.map(Grip::of),
        };
        all.push((contacts.surface.number_of(entity), of_body));
    }
    all.retain(|(number, _)| *number < contacts.bodies.len());
    all.sort_by_key(|(number, _)| *number);
    all.into_iter().map(|(_, of_body)| of_body).collect()
}

impl<T: Scalar> BodySlices<'_, T> {
    /// The numbers of a point.
    pub fn kept(&self, at: Kept) -> &[T] {
        let all = if at.of_face { &*self.face_touch } else { &*self.touch };
        &all[at.first..at.first + MEETING_NUMBERS]
    }

    /// The same, to write.
    pub fn kept_mut(&mut self, at: Kept) -> &mut [T] {
        let all = if at.of_face { &mut *self.face_touch } else { &mut *self.touch };
        &mut all[at.first..at.first + MEETING_NUMBERS]
    }
}
