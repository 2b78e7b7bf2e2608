//! The four-node tetrahedron with averaged nodal pressure.

use super::{Element, MOST_NODES, MOST_ROWS, PointState, PressureFrom, Stiffness, Tet4};
use crate::math::{Mat3, Real};
use crate::mesh::CellKind;
use glam::DVec3;

/// [`Tet4`] whose pressure is the mean of its nodes' pressures, which come from the volume around each node (Bonet &
/// Burton 1998; Joldes, Wittek & Miller 2009): a bar under gravity at ν = 0.49 with 20×4×4 cells is 8 % too stiff
/// instead of 46 %.
///
/// The volumetric energy is Σ_a V_a U(θ_a) with θ_a the mean of θ over the elements of a's block, each by a quarter of
/// its rest volume. Forces are its exact derivative, so energy is kept; and since U is convex the frequency is at most
/// that of [`Tet4`]. Means are taken within a block, so pressures stay apart where materials meet.
#[derive(Clone, Copy, Debug)]
pub struct Tet4NodalPressure;

impl Element for Tet4NodalPressure {
    const NAME: &'static str = "tet4_nodal_pressure";
    const CELL: CellKind = Tet4::CELL;
    const POINTS: usize = Tet4::POINTS;
    const ROWS: usize = Tet4::ROWS;
    const VOLUME_ROW: usize = Tet4::VOLUME_ROW;
    const FORCE_ROW: Option<usize> = Tet4::FORCE_ROW;
    const PRESSURE: PressureFrom = PressureFrom::Nodes;
    const ELEMENTS_A_PATCH: usize = 1024;
    const SPECIALISED: bool = true;

    type Specialisation = Self;
    type Prepared<R: Real> = <Tet4 as Element>::Prepared<R>;
    type Forces<R: Real> = <Tet4 as Element>::Forces<R>;

    fn rest_shape(points: &[DVec3], young: f64) -> [f64; MOST_ROWS] {
        Tet4::rest_shape(points, young)
    }

    #[inline(always)]
    fn prepare<R: Real>(u: &[[R; 3]; MOST_NODES]) -> Self::Prepared<R> {
        Tet4::prepare(u)
    }

    #[inline(always)]
    fn at_point<R: Real>(u: &Self::Prepared<R>, point: usize, shape: impl Fn(usize) -> R) -> PointState<R> {
        Tet4::at_point(u, point, shape)
    }

    #[inline(always)]
    fn no_forces<R: Real>(like: R) -> Self::Forces<R> {
        Tet4::no_forces(like)
    }

    #[inline(always)]
    fn add_stress<R: Real>(forces: &mut Self::Forces<R>, point: usize, at: &PointState<R>, stress: &Mat3<R>) {
        Tet4::add_stress(forces, point, at, stress);
    }

    #[inline(always)]
    fn store_forces<R: Real>(
        u: &Self::Prepared<R>,
        forces: &Self::Forces<R>,
        shape: impl Fn(usize) -> R,
        store: impl FnMut(usize, usize, R),
    ) {
        Tet4::store_forces(u, forces, shape, store);
    }

    #[inline(always)]
    fn hourglass_energy<R: Real>(u: &Self::Prepared<R>, gradient: &Mat3<R>, shape: impl Fn(usize) -> R) -> R {
        Tet4::hourglass_energy(u, gradient, shape)
    }

    fn frequency_bound(shape: &[f64; MOST_ROWS], stiffness: &Stiffness) -> f64 {
        Tet4::frequency_bound(shape, stiffness)
    }
}
