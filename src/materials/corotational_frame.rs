//! Hooke's law in a frame of two edges of each element, as SOFA's method `large` has it.

use super::{Elastic, Kinematics, Linear};
use crate::math::{Mat3, Real, Sym3, Task, dot, dot_plus, minor};
use bevy_ecs::prelude::Component;

/// P = R (2μ ε + λ tr ε I), ε = sym(RᵀF − I), R = D(F) D(I)ᵀ with the frame D of two edges of the element: the first,
/// and what of the second is across it (Nesme, Payan & Faure 2005; its WGSL twin is `shaders/corotational_frame.wgsl`).
/// Each element has edges of its own.
///
/// Objective, but P Fᵀ is not symmetric, so that elements are turned by their own forces, and it is the derivative of
/// no energy: what is told as such is μ dev ε:dev ε + κ/2 tr² ε, which the work of P is not.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct CorotationalFrame<T: Send + Sync + 'static> {
    /// The law in the frame.
    pub linear: Linear<T>,
    /// The unit vector along the first edge at rest.
    pub along: [T; 3],
    /// That across it towards the second.
    pub across: [T; 3],
}

impl CorotationalFrame<f64> {
    /// The law of an element with these edges at rest, which are not parallel, in any unit.
    pub fn with_edges(&self, first: glam::DVec3, second: glam::DVec3) -> Self {
        let along = first.normalize_or_zero();
        let across = second.reject_from_normalized(along).normalize_or_zero();
        Self { along: along.to_array(), across: across.to_array(), ..*self }
    }
}

/// R − I, and ε.
#[derive(Clone, Copy)]
struct Turned<R> {
    turn: Mat3<R>,
    strain: Sym3<R>,
}

struct FindTurned<'a, R: Real>(&'a CorotationalFrame<R>, &'a Mat3<R>);

impl<R: Real> Task<R> for FindTurned<'_, R> {
    type Output = Turned<R>;

    /// From what deformed unit vectors are more than those at rest, which keeps the digits of small strains.
    #[inline(always)]
    fn run(self) -> Turned<R> {
        let Self(law, Mat3(h)) = self;
        let (zero, half) = (h[0][0].constant(0.0), h[0][0].constant(0.5));
        let (a, b) = (law.along, law.across);
        let first = more_of_unit(a, [dot(h[0], a), dot(h[1], a), dot(h[2], a)]);
        let d = [a[0] + first[0], a[1] + first[1], a[2] + first[2]];
        let moved = [dot(h[0], b), dot(h[1], b), dot(h[2], b)];
        let along = dot_plus(moved, d, dot(b, first));
        let minus = -along;
        let second = more_of_unit(
            b,
            [minus.mul_add(d[0], moved[0]), minus.mul_add(d[1], moved[1]), minus.mul_add(d[2], moved[2])],
        );
        let e = [b[0] + second[0], b[1] + second[1], b[2] + second[2]];
        let (left, right) = (cross(first, e), cross(a, second));
        let third = [left[0] + right[0], left[1] + right[1], left[2] + right[2]];
        let c = cross(a, b);
        let mut turn = Mat3::zero(zero);
        for i in 0..3 {
            turn.add_to_row(i, first[i], a);
            turn.add_to_row(i, second[i], b);
            turn.add_to_row(i, third[i], c);
        }
        let t = &turn.0;
        // RᵀF − I with F − I and R − I
        let mut rest = [[zero; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                rest[i][j] =
                    t[2][i].mul_add(h[2][j], t[1][i].mul_add(h[1][j], t[0][i].mul_add(h[0][j], h[i][j] + t[j][i])));
            }
        }
        let strain = Sym3([
            rest[0][0],
            rest[1][1],
            rest[2][2],
            half * (rest[0][1] + rest[1][0]),
            half * (rest[1][2] + rest[2][1]),
            half * (rest[0][2] + rest[2][0]),
        ]);
        Turned { turn, strain }
    }
}

/// (n + m)/|n + m| − n of a unit vector n.
#[inline(always)]
fn more_of_unit<R: Real>(n: [R; 3], m: [R; 3]) -> [R; 3] {
    let (one, two) = (m[0].constant(1.0), m[0].constant(2.0));
    let square = dot_plus(m, m, two * dot(n, m));
    let length = (one + square).max(one.constant(f64::from(f32::MIN_POSITIVE))).sqrt();
    let (grown, per_length) = (-(square / (one + length)), one / length);
    [
        grown.mul_add(n[0], m[0]) * per_length,
        grown.mul_add(n[1], m[1]) * per_length,
        grown.mul_add(n[2], m[2]) * per_length,
    ]
}

#[inline(always)]
fn cross<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [minor(a[1], a[2], b[1], b[2]), minor(a[2], a[0], b[2], b[0]), minor(a[0], a[1], b[0], b[1])]
}

impl<R: Real> Elastic<R> for CorotationalFrame<R> {
    type Of<Q: Real> = CorotationalFrame<Q>;

    #[inline(always)]
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> CorotationalFrame<Q> {
        let (a, b) = (self.along, self.across);
        CorotationalFrame {
            linear: Linear { shear: number(self.linear.shear), bulk: number(self.linear.bulk) },
            along: [number(a[0]), number(a[1]), number(a[2])],
            across: [number(b[0]), number(b[1]), number(b[2])],
        }
    }

    /// Of ε, as the linear theory has them.
    #[inline(always)]
    fn kinematics(&self, gradient: &Mat3<R>) -> Kinematics<R> {
        let Turned { strain, .. } = self.linear.shear.outlined(FindTurned(self, gradient));
        Kinematics::of_small_strain(strain, gradient)
    }

    /// R (S_iso + p I).
    #[inline(always)]
    fn first_stress(&self, gradient: &Mat3<R>, k: &Kinematics<R>, isochoric: &Sym3<R>, pressure: R) -> Mat3<R> {
        let Turned { turn, .. } = self.linear.shear.outlined(FindTurned(self, gradient));
        turn.plus_identity_times(&isochoric.plus(&self.volumetric(k, pressure)))
    }

    /// The symmetric part of P Fᵀ/J.
    fn cauchy(&self, gradient: &Mat3<R>, j: R, first: &Mat3<R>) -> Sym3<R> {
        let (h, p) = (&gradient.0, &first.0);
        let half = j.constant(0.5);
        let entry = |i: usize, k: usize| dot_plus(p[i], h[k], p[i][k]) / j;
        let mean = |i: usize, k: usize| half * (entry(i, k) + entry(k, i));
        Sym3([entry(0, 0), entry(1, 1), entry(2, 2), mean(0, 1), mean(1, 2), mean(0, 2)])
    }

    /// 2μ dev ε.
    #[inline(always)]
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        self.linear.isochoric(k)
    }

    /// p I.
    #[inline(always)]
    fn volumetric(&self, k: &Kinematics<R>, pressure: R) -> Sym3<R> {
        self.linear.volumetric(k, pressure)
    }

    #[inline(always)]
    fn without_pressure(&self, k: &Kinematics<R>, stress: Sym3<R>) -> Sym3<R> {
        self.linear.without_pressure(k, stress)
    }

    /// κ tr ε.
    #[inline(always)]
    fn pressure(&self, theta: R) -> R {
        self.linear.pressure(theta)
    }

    /// μ dev ε:dev ε.
    #[inline(always)]
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
        self.linear.isochoric_energy(k)
    }

    /// κ/2 (tr ε)².
    #[inline(always)]
    fn volumetric_energy(&self, theta: R) -> R {
        self.linear.volumetric_energy(theta)
    }

    fn small_strain_moduli(&self) -> [R; 2] {
        self.linear.small_strain_moduli()
    }
}
