//! What a step needs of the bodies, as plain slices: fetched once a step.

use super::{MeetingColumns, SurfaceContacts};
use crate::backend::cpu::{Foreseen, IntegrationCoefficients};
use crate::components::*;
use crate::math::Scalar;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Columns of a body in the run's precision, a row a node.
pub(super) struct BodySlices<'a, T> {
    pub rest: &'a [DVec3],
    /// Mass that is slow to move (kg).
    pub mass: &'a [T],
    pub damping: Option<&'a [T]>,
    pub axes: &'a [u32],
    pub internal: &'a [T],
    pub external: &'a mut [T],
    pub u: &'a [T],
    pub step: &'a [T],
    pub force: &'a mut [T],
    pub touch: &'a mut [T],
    /// Of points of faces; empty where there are none.
    pub face_touch: &'a mut [T],
}

/// Where the numbers of a point are: of a body, in [`SurfaceTouch`] or [`FaceTouch`], from one on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kept {
    pub body: usize,
    pub of_face: bool,
    pub first: usize,
}

/// The vector of a row.
pub(super) fn vector<T: Scalar>(all: &[T], row: usize) -> DVec3 {
    vector_at(all, 3 * row)
}

/// The vector that begins with a number.
pub(super) fn vector_at<T: Scalar>(all: &[T], at: usize) -> DVec3 {
    DVec3::new(all[at].to_f64(), all[at + 1].to_f64(), all[at + 2].to_f64())
}

/// Writes a vector from a number on, rounded.
pub(super) fn set_vector<T: Scalar>(all: &mut [T], at: usize, value: DVec3) {
    for (place, number) in all[at..at + 3].iter_mut().zip(value.to_array()) {
        *place = T::from_f64(number);
    }
}

/// Of all bodies, in the order of [`SurfaceContacts::bodies`].
pub(super) fn slices<'a, T: Scalar>(
    contacts: &SurfaceContacts,
    bodies: &'a mut Query<'_, '_, (Entity, MeetingColumns)>,
) -> Vec<BodySlices<'a, T>> {
    let numbers = &contacts.surface.numbers;
    let number_of = |body: Entity| {
        numbers.binary_search_by_key(&body, |(entity, _)| *entity).map_or(usize::MAX, |at| numbers[at].1)
    };
    let mut all: Vec<(usize, BodySlices<'a, T>)> = Vec::with_capacity(contacts.bodies.len());
    for (entity, columns) in bodies {
        let mass = columns.fictitious.map_or(&columns.mass.0, |mass| &mass.0);
        let of_body = BodySlices {
            rest: &columns.rest.0,
            mass: mass.slice(),
            damping: columns.damping.map(|damping| damping.slice()),
            axes: &columns.axes.0,
            internal: columns.internal.slice(),
            external: columns.external.into_inner().slice_mut(),
            u: columns.u.slice(),
            step: columns.step.slice(),
            force: columns.force.into_inner().slice_mut(),
            touch: columns.touch.into_inner().slice_mut(),
            face_touch: columns.face_touch.map_or(&mut [], |touch| touch.into_inner().slice_mut()),
        };
        all.push((number_of(entity), of_body));
    }
    all.retain(|(number, _)| *number < contacts.bodies.len());
    all.sort_by_key(|(number, _)| *number);
    all.into_iter().map(|(_, of_body)| of_body).collect()
}

impl<T: Scalar> BodySlices<'_, T> {
    /// Where a node would go.
    pub fn foresee(&self, row: usize, coefficients: &IntegrationCoefficients<f64>) -> Foreseen {
        let mass = self.mass[row].to_f64();
        let damping = self.damping.map_or(0.0, |damping| damping[row].to_f64());
        let force = vector(self.external, row) - vector(self.internal, row);
        coefficients.foresee(mass, damping, self.axes[row], vector(self.step, row), force)
    }

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
