//! Stress at a point of a register full of elements: the law's, with what the material has on top.

use super::{FIBRES, GENERIC, PatchForces, VISCOSITY};
use crate::backend::cpu::in_one_place::{ElasticOfCopies, in_one_place};
use crate::elements::{Element, PressureFrom};
use crate::materials::{Elastic, Fibres, Kinematics};
use crate::math::{LANES, Mat3, Real, SimdScalar, Sym3};
use pulp::{Simd, WithSimd};

/// Numbers of a material, made ready once a patch.
pub(super) struct InRegisters<L, T: SimdScalar, S: Simd> {
    pub(super) elastic: L,
    /// All zero where there are none.
    pub(super) fibres: Fibres<T::Vector<S>>,
    /// a⊗a of a group's fibres where there is viscosity too: made anew for a group where they differ.
    pub(super) along_squared: [[T; LANES]; 6],
}

impl<E: Element, T: SimdScalar, L: Elastic<T>, const EFFECTS: u8> PatchForces<'_, E, T, L, EFFECTS> {
    #[inline(always)]
    pub(super) fn in_registers<S: Simd>(&self, simd: S) -> InRegisters<L::Of<T::Vector<S>>, T, S> {
        let none = Fibres { eta: T::default(), tension_only: T::default() };
        let fibres = self.law.fibres.as_ref().map_or(none, |(fibres, _)| *fibres);
        macro_rules! splat {
            ($law:expr) => {
                $law.map(
                    #[inline(always)]
                    |number: T| T::splat(simd, number),
                )
            };
        }
        InRegisters { elastic: splat!(self.elastic), fibres: splat!(fibres), along_squared: [[T::default(); LANES]; 6] }
    }

    /// Parameters of a register full of elements, where they differ from copy to copy.
    #[inline(always)]
    pub(super) fn take_parameters<S: Simd>(
        &self,
        simd: S,
        group: usize,
        at: usize,
        law: &mut InRegisters<L::Of<T::Vector<S>>, T, S>,
    ) {
        // a constant, so that only the kernel that asks for everything asks for this
        if const { EFFECTS & GENERIC != 0 }
            && let Some(copies) = &self.law.copies
        {
            let group = self.first_group + group;
            let kind = self.elastic;
            law.elastic = in_one_place(simd, ElasticOfCopies { simd, copies, kind, group, at });
            if self.law.fibres.is_some() {
                law.fibres.eta = copies.eta(simd, group, at, self.law.exponential.len());
            }
        }
    }

    /// First Piola-Kirchhoff stress (Pa) at a point, and J there.
    #[inline(always)]
    pub(super) fn stress<S: Simd>(
        &mut self,
        simd: S,
        law: &InRegisters<L::Of<T::Vector<S>>, T, S>,
        group: usize,
        at: usize,
        point: usize,
        gradient: &Mat3<T::Vector<S>>,
        shared: T::Vector<S>,
    ) -> (Mat3<T::Vector<S>>, T::Vector<S>) {
        if const { EFFECTS & GENERIC != 0 } {
            return self.generic_stress(simd, law, group, at, point, gradient, shared);
        }
        let pressure = (E::PRESSURE != PressureFrom::Point).then_some(shared);
        if EFFECTS & VISCOSITY == 0 {
            let fibres = (EFFECTS & FIBRES != 0).then(
                #[inline(always)]
                || (law.fibres, self.along(simd, group, at)),
            );
            return law.elastic.direct_stress(gradient, pressure, fibres);
        }
        let fibres = (EFFECTS & FIBRES != 0).then(
            #[inline(always)]
            || (law.fibres, six_rows(simd, &law.along_squared, at)),
        );
        law.elastic.stress_relaxed(
            gradient,
            pressure,
            fibres,
            #[inline(always)]
            |isochoric, volumetric| self.relax(simd, group, at, point, &isochoric, volumetric),
        )
    }

    /// The same with all that a material can have, by way of S.
    #[inline(always)]
    fn generic_stress<S: Simd>(
        &mut self,
        simd: S,
        law: &InRegisters<L::Of<T::Vector<S>>, T, S>,
        group: usize,
        at: usize,
        point: usize,
        gradient: &Mat3<T::Vector<S>>,
        shared: T::Vector<S>,
    ) -> (Mat3<T::Vector<S>>, T::Vector<S>) {
        let elastic = &law.elastic;
        if E::PRESSURE == PressureFrom::Point
            && self.law.is_elastic()
            && let Some(found) = simd.vectorize(Alone { elastic, gradient })
        {
            return found;
        }
        let k = elastic.kinematics(gradient);
        let mut pressure = match E::PRESSURE {
            PressureFrom::Point => elastic.pressure(elastic.volume_measure(&k)),
            _ => shared,
        };
        if !self.law.volumetric.is_empty() {
            pressure = self.relax_pressure(simd, group, at, point, pressure);
        }
        let mut isochoric = simd.vectorize(Isochoric { elastic, k: &k });
        if self.law.fibres.is_some() {
            isochoric = isochoric.plus(&law.fibres.isochoric(&k, self.along(simd, group, at)));
        }
        if !self.law.exponential.is_empty() {
            isochoric = isochoric.plus(&self.exponential_stress(simd, group, at, &k));
        }
        if !self.law.prony.is_empty() {
            let nothing = Sym3([shared.constant(0.0); 6]);
            isochoric = self.relax(simd, group, at, point, &isochoric, nothing);
        }
        if self.law.reproject {
            isochoric = elastic.without_pressure(&k, isochoric);
        }
        (elastic.first_stress(gradient, &k, &isochoric, pressure), k.true_j)
    }
}

/// S_iso of a law in a function of its own: what all laws come to is too much code to stand in every element's kernel.
struct Isochoric<'a, L, R> {
    elastic: &'a L,
    k: &'a Kinematics<R>,
}

impl<R: Real, L: Elastic<R>> WithSimd for Isochoric<'_, L, R> {
    type Output = Sym3<R>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Sym3<R> {
        self.elastic.isochoric(self.k)
    }
}

/// Stress and J of a law that is all there is, likewise.
struct Alone<'a, L, R> {
    elastic: &'a L,
    gradient: &'a Mat3<R>,
}

impl<R: Real, L: Elastic<R>> WithSimd for Alone<'_, L, R> {
    type Output = Option<(Mat3<R>, R)>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        self.elastic.alone(self.gradient)
    }
}

/// A symmetric matrix from its rows, from lane `at` on.
#[inline(always)]
fn six_rows<T: SimdScalar, S: Simd>(simd: S, rows: &[[T; LANES]; 6], at: usize) -> Sym3<T::Vector<S>> {
    let mut all = Sym3([T::splat(simd, T::default()); 6]);
    for i in 0..6 {
        all.0[i] = T::load(simd, &rows[i][at..]);
    }
    all
}

/// J at a point that has no weight.
#[inline(always)]
pub(super) fn volume_ratio<E: Element, T: SimdScalar, S: Simd>(
    simd: S,
    u: &E::Prepared<T::Vector<S>>,
    rest_shape: &[[T; LANES]],
    point: usize,
    at: usize,
) -> T::Vector<S> {
    let state = E::at_point(
        u,
        point,
        #[inline(always)]
        |row: usize| T::load(simd, &rest_shape[row][at..]),
    );
    state.gradient.volume_change() + state.volume.constant(1.0)
}

/// θ̄ = Σ V_q θ_q / V of elements with several points.
#[inline(always)]
pub(super) fn mean_volume_change<E: Element, T: SimdScalar, L: Elastic<T>, S: Simd>(
    simd: S,
    elastic: &L::Of<T::Vector<S>>,
    u: &E::Prepared<T::Vector<S>>,
    rest_shape: &[[T; LANES]],
    at: usize,
) -> T::Vector<S> {
    let mut change = T::splat(simd, T::default());
    let mut volume = change;
    for point in 0..E::POINTS {
        let state = E::at_point(
            u,
            point,
            #[inline(always)]
            |row: usize| T::load(simd, &rest_shape[row][at..]),
        );
        let k = elastic.kinematics(&state.gradient);
        change = state.volume.mul_add(elastic.volume_measure(&k), change);
        volume += state.volume;
    }
    change / volume
}
