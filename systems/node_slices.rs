//! What a step needs of the nodes of a body, as plain slices: for systems that go over what ties nodes of several
//! bodies together.

use crate::backend::cpu::{Foreseen, IntegrationCoefficients};
use crate::components::*;
use crate::math::{Scalar, vector_at};
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use glam::DVec3;

/// What is known of the nodes of a body.
#[derive(QueryData)]
#[query_data(mutable)]
pub(super) struct SlicedColumns {
    pub rest: &'static RestPosition,
    pub mass: &'static Mass,
    pub inertial: Option<&'static InertialMass>,
    pub damping: Option<&'static DampingCoefficient>,
    pub axes: &'static ConstrainedAxes,
    pub internal: &'static InternalForce,
    pub external: &'static mut ExternalForce,
    pub u: &'static Displacement,
    pub step: &'static DisplacementIncrement,
    pub previous: Option<&'static PreviousPrescribedIncrement>,
    pub compensation: Option<&'static DisplacementCompensation>,
}

/// Columns of a body in the run's precision, a row a node.
pub(super) struct NodeSlices<'a, T> {
    pub rest: &'a [DVec3],
    /// Mass that is slow to move (kg).
    pub mass: &'a [T],
    /// Mass that weighs (kg).
    pub weighs: &'a [T],
    pub damping: Option<&'a [T]>,
    pub axes: &'a [u32],
    pub internal: &'a [T],
    pub external: &'a mut [T],
    pub u: &'a [T],
    pub step: &'a [T],
    /// The last steps (m) along axes that are told, where they are kept.
    previous: Option<&'a [f32]>,
    /// What displacements have too much of by rounding (m), and behind it what steps have.
    pub compensation: Option<&'a [T]>,
}

impl<'a, T: Scalar> NodeSlices<'a, T> {
    /// Of columns in that precision.
    pub fn of(columns: SlicedColumnsItem<'a, '_>) -> Self {
        let mass = columns.inertial.map_or(&columns.mass.0, |mass| &mass.0);
        Self {
            rest: &columns.rest.0,
            mass: mass.slice(),
            weighs: columns.mass.slice(),
            damping: columns.damping.map(|damping| damping.slice()),
            axes: &columns.axes.0,
            internal: columns.internal.slice(),
            external: columns.external.into_inner().slice_mut(),
            u: columns.u.slice(),
            step: columns.step.slice(),
            previous: columns.previous.map(|previous| &previous.0[..]),
            compensation: columns.compensation.map(|compensation| compensation.slice()),
        }
    }

    /// Displacement of a node (m), without what rounding has made of the sum of its steps: who corrects steps by where
    /// nodes are would push by that, m ulp(u)/Δt².
    #[inline(always)] // with the instructions of whoever asks
    pub fn displacement(&self, row: usize) -> DVec3 {
        vector(self.u, row) - self.compensation.map_or(DVec3::ZERO, |compensation| vector(compensation, row))
    }

    /// Where a node would go.
    #[inline(always)] // likewise
    pub fn foresee(&self, row: usize, coefficients: &IntegrationCoefficients<f64>) -> Foreseen {
        let mass = self.mass[row].to_f64();
        let damping = self.damping.map_or(0.0, |damping| damping[row].to_f64());
        let force = vector(self.external, row) - vector(self.internal, row);
        coefficients.foresee(mass, damping, self.axes[row], vector(self.step, row), force)
    }

    /// The last step of a node (m), for work that is counted: see [`last_step`].
    pub fn last_step(&self, row: usize) -> DVec3 {
        if self.mass[row] <= T::default() {
            return DVec3::ZERO;
        }
        last_step(vector(self.step, row), (self.axes[row], row), self.previous)
    }
}

/// The last step of a node (m) whose axes are constrained so: along those that are told `boundary` has written over it
/// what the next one is, and has kept it where work is counted.
pub(super) fn last_step(step: DVec3, (axes, row): (u32, usize), previous: Option<&[f32]>) -> DVec3 {
    let Some(previous) = previous else { return step };
    let along = |i: usize| if axes >> i & 1 == 1 { f64::from(previous[3 * row + i]) } else { step[i] };
    DVec3::from_array([0, 1, 2].map(along))
}

/// What contact between surfaces does to the nodes of a body, where these may meet others.
pub(super) type MetColumns = Option<(&'static ContactForce, &'static mut SurfaceTouch)>;

/// Notes that a node goes farther (m) than contact between surfaces has foreseen when it counted what it takes, with
/// `work_factor` for each joule; see [`NodeColumns::note_farther`](crate::backend::cpu::NodeColumns).
pub(super) fn note_farther(
    met: &mut Option<(&ContactForce, Mut<'_, SurfaceTouch>)>,
    row: usize,
    farther: DVec3,
    work_factor: f64,
) {
    if let Some((force, touch)) = met {
        // what contact goes on from stays as it is
        let (touch, at) = (touch.bypass_change_detection(), MEETING_NUMBERS * row + 7);
        let loss = touch.get(at) - 0.5 * work_factor * force.vector(row).dot(farther);
        touch.set(at, loss);
    }
}

/// The vector of a row.
#[inline(always)] // likewise
pub(super) fn vector<T: Scalar>(all: &[T], row: usize) -> DVec3 {
    vector_at(all, 3 * row)
}

/// Writes a vector from a number on, rounded.
pub(super) fn set_vector<T: Scalar>(all: &mut [T], at: usize, value: DVec3) {
    for (place, number) in all[at..at + 3].iter_mut().zip(value.to_array()) {
        *place = T::from_f64(number);
    }
}

/// Whether no element of some bodies can go.
pub(super) fn elements_stay(bodies: impl IntoIterator<Item = Entity>, world: &World) -> bool {
    // columns that nobody has are not known
    let Some(mut blocks) = world.try_query_filtered::<&Block, With<Alive>>() else { return true };
    let going: Vec<Entity> = blocks.iter(world).map(|block| block.body).collect();
    !bodies.into_iter().any(|body| going.contains(&body))
}
