//! What every law starts from: strain measures of a displacement gradient.

use crate::math::{Mat3, Real, Sym3, dot_plus};

/// Below this volume ratio the laws use this value instead, so that no kernel ever makes a NaN. The element is reported
/// as inverted when J ≤ 0 and the run stops; what lies between is far beyond any tissue.
pub const J_FLOOR: f64 = 1e-3;

/// Elements that go when they are turned inside out (`inversion: Remove`) go when J falls below this: squeezed flatter,
/// they need steps so small, and push so hard where a step passes over J = 0, that what they do is no tissue's doing.
pub const FLATTEST: f64 = 0.02;

/// Strain measures at a point, all computed from ∇u: F = I + ∇u would throw away the digits of a small ∇u.
#[derive(Clone, Copy, Debug)]
pub struct Kinematics<R> {
    /// Green strain E = ½(∇u + ∇uᵀ + ∇uᵀ∇u).
    pub green_strain: Sym3<R>,
    /// det C · C⁻¹.
    pub adjugate_c: Sym3<R>,
    /// J − 1, exact to rounding for small ∇u, at least [`J_FLOOR`] − 1 unless made
    /// [`of_any_volume`](Self::of_any_volume).
    pub volume_change: R,
    /// J, at least [`J_FLOOR`].
    pub j: R,
    /// J as it is, for detecting inversion.
    pub true_j: R,
    /// J^(−2/3).
    pub j_m23: R,
}

impl<R: Real> Kinematics<R> {
    /// Strain measures of a displacement gradient (rows: components of u, columns: coordinates).
    #[inline(always)]
    pub fn new(gradient: &Mat3<R>) -> Self {
        let h = &gradient.0;
        let (half, one) = (h[0][0].constant(0.5), h[0][0].constant(1.0));
        let twice = twice_green_strain(gradient);
        let green_strain = Sym3(twice).scaled(half);
        let c = Sym3([one + twice[0], one + twice[1], one + twice[2], twice[3], twice[4], twice[5]]);

        let change = gradient.volume_change();
        let volume_change = change.max(one.constant(J_FLOOR - 1.0));
        let j = one + volume_change;
        let j_m13 = j.inverse_cbrt();
        let j_m23 = j_m13 * j_m13;
        Self { green_strain, adjugate_c: c.adjugate(), volume_change, j, true_j: one + change, j_m23 }
    }

    /// The same for laws that are defined for every F: J − 1 as it is, also below [`J_FLOOR`] − 1. What has a power of
    /// J or C⁻¹ in it keeps its floor.
    #[inline(always)]
    pub fn of_any_volume(gradient: &Mat3<R>) -> Self {
        Self { volume_change: gradient.volume_change(), ..Self::new(gradient) }
    }

    /// Strain measures of the linear theory: ε = ½(∇u + ∇uᵀ) as `green_strain`, tr ε as change of volume, and no
    /// difference between the body at rest and deformed: C = I. Whether an element is inside out it does not know: J as
    /// it is is that of F, as for all laws.
    #[inline(always)]
    pub fn linear(gradient: &Mat3<R>) -> Self {
        let h = &gradient.0;
        let half = h[0][0].constant(0.5);
        let shears = [half * (h[0][1] + h[1][0]), half * (h[1][2] + h[2][1]), half * (h[0][2] + h[2][0])];
        Self::of_small_strain(Sym3([h[0][0], h[1][1], h[2][2], shears[0], shears[1], shears[2]]), gradient)
    }

    /// The same of another small strain, such as one in a frame that turns.
    #[inline(always)]
    pub(super) fn of_small_strain(strain: Sym3<R>, gradient: &Mat3<R>) -> Self {
        let (zero, one) = (gradient.0[0][0].constant(0.0), gradient.0[0][0].constant(1.0));
        Self {
            green_strain: strain,
            adjugate_c: Sym3([one, one, one, zero, zero, zero]),
            volume_change: strain.trace(),
            j: one,
            true_j: one + gradient.volume_change(),
            j_m23: one,
        }
    }

    /// J, but never nearer to 0 than [`J_FLOOR`]: what stresses per deformed area are divided by.
    pub fn divisor(&self) -> R {
        let floor = self.j.constant(J_FLOOR);
        self.true_j.if_positive(self.true_j.max(floor), self.true_j.min(-floor))
    }

    /// J^(−2/3) − 1, exact to rounding for small strains.
    #[inline(always)]
    pub fn j_m23_change(&self) -> R {
        j_m23_change(self.volume_change, self.j_m23)
    }

    /// C⁻¹ m for a symmetric m with the eigenvectors of C.
    #[inline(always)]
    pub fn inverse_c_times(&self, m: &Sym3<R>) -> Sym3<R> {
        self.adjugate_c.times_coaxial(m).scaled(self.j.constant(1.0) / (self.j * self.j))
    }

    /// Ī₁ − 3 with Ī₁ = J^(−2/3) tr C.
    #[inline(always)]
    pub fn i1_change(&self) -> R {
        let w = self.j_m23_change();
        let twice = self.j.constant(2.0) * self.green_strain.trace();
        self.j.constant(3.0).mul_add(w, twice + w * twice)
    }

    /// What a stress is without its part that acts on J: s − (s:C)/3 C⁻¹.
    #[inline(always)]
    pub fn without_pressure(&self, s: &Sym3<R>) -> Sym3<R> {
        // C = I + 2E
        let pressing = s.trace() + self.j.constant(2.0) * s.contracted(&self.green_strain);
        s.plus(&self.adjugate_c.scaled(pressing * self.j.constant(-1.0 / 3.0) / (self.j * self.j)))
    }
}

/// J^(−2/3) − 1 from J − 1 and J^(−2/3).
#[inline(always)]
pub(super) fn j_m23_change<R: Real>(volume_change: R, j_m23: R) -> R {
    let (one, two, three) = (j_m23.constant(1.0), j_m23.constant(2.0), j_m23.constant(3.0));
    // w = J^(−2/3) − 1 solves (1+w)³ J² = 1: one Newton step on the expanded form brings back the lost digits
    let w = j_m23 - one;
    let square = volume_change * (two + volume_change);
    let residual = (w * (one + square)).mul_add(w.mul_add(three + w, three), square);
    residual.mul_add(j_m23 * j_m23.constant(-1.0 / 3.0), w)
}

/// 2E = ∇u + ∇uᵀ + ∇uᵀ∇u: xx, yy, zz, xy, yz, xz.
#[inline(always)]
pub(super) fn twice_green_strain<R: Real>(gradient: &Mat3<R>) -> [R; 6] {
    let h = &gradient.0;
    let column = [[h[0][0], h[1][0], h[2][0]], [h[0][1], h[1][1], h[2][1]], [h[0][2], h[1][2], h[2][2]]];
    let mut twice = [h[0][0]; 6];
    for (entry, (i, j)) in [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)].into_iter().enumerate() {
        twice[entry] = dot_plus(column[i], column[j], h[i][j] + h[j][i]);
    }
    twice
}
