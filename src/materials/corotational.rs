//! Hooke's law in the frame that turns with the material.

use super::{Complaints, CorotationalFrame, Elastic, Elasticity, J_FLOOR, Kinematics, Law, Linear, Prerequisite};
use crate::math::{Mat3, Polar, Real, Sym3, Task, dot, dot_plus, minor};
use crate::uniform::uniform;
use bevy_ecs::component::Component;
use serde::{Deserialize, Serialize};

/// Ψ = μ |F − R|² + λ/2 tr²(RᵀF − I) with the rotation R of F = R U (Chao, Pinkall, Sanan & Schröder 2010; with R of an
/// element's edges Müller & Gross 2004; its WGSL twin is `shaders/corotational.wgsl`), so P = 2μ(F − R) + λ tr(RᵀF − I)
/// R: linear in the Biot strain B = U − I, and of it Ψ_iso = μ dev B:dev B, θ = tr B, U = κ/2 θ².
///
/// Stress grows in proportion to stretches for ever, and volume is kept at small strains only. Where det F < 0 the
/// least stretch takes the sign (Irving, Teran & Fedkiw 2004), so that R stays a rotation: the stress is finite and
/// pushes back.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Corotational<T: Send + Sync + 'static> {
    /// Shear modulus μ (Pa).
    pub shear: T,
    /// Bulk modulus κ (Pa).
    pub bulk: T,
}

uniform!(Corotational<f32> { shear, bulk });

/// Moduli of a co-rotational law, as one of two pairs, and which rotation it turns by.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum CorotationalParameters {
    /// Young's modulus (Pa) and Poisson's ratio, both of small strains.
    Young {
        /// Young's modulus (Pa).
        young: f64,
        /// Poisson's ratio, below 1/2.
        poisson: f64,
        /// Which rotation of an element.
        #[serde(default, skip_serializing_if = "Rotation::is_polar")]
        rotation: Rotation,
    },
    /// Shear modulus and bulk modulus.
    Moduli {
        /// Shear modulus μ (Pa).
        shear: f64,
        /// Bulk modulus κ (Pa).
        bulk: f64,
        /// Which rotation of an element.
        #[serde(default, skip_serializing_if = "Rotation::is_polar")]
        rotation: Rotation,
    },
}

/// Which rotation a co-rotational law takes out of a deformation.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
pub enum Rotation {
    /// That of F = R U.
    #[default]
    Polar,
    /// That of a frame of two edges, of tetrahedra with four nodes and hexahedra with eight.
    Frame,
}

impl Rotation {
    fn is_polar(&self) -> bool {
        *self == Self::Polar
    }
}

impl CorotationalParameters {
    fn elasticity(&self) -> Elasticity {
        match *self {
            Self::Young { young, poisson, .. } => Elasticity::Young { young, poisson },
            Self::Moduli { shear, bulk, .. } => Elasticity::Moduli { shear, bulk },
        }
    }

    /// Which rotation.
    pub fn rotation(&mut self) -> &mut Rotation {
        match self {
            Self::Young { rotation, .. } | Self::Moduli { rotation, .. } => rotation,
        }
    }

    /// The law by frames, of no element yet, if it is that.
    pub fn by_frame(mut self) -> Option<CorotationalFrame<f64>> {
        let (shear, bulk) = self.elasticity().moduli();
        let law = CorotationalFrame { linear: Linear { shear, bulk }, along: [1.0, 0.0, 0.0], across: [0.0, 1.0, 0.0] };
        (*self.rotation() == Rotation::Frame).then_some(law)
    }
}

impl Law for Corotational<f64> {
    const PREREQUISITES: &'static [Prerequisite] = &[Prerequisite::Eigen];
    const IS_COMPARED: bool = false;
    type Parameters = CorotationalParameters;

    fn of(parameters: &CorotationalParameters) -> Self {
        let (shear, bulk) = parameters.elasticity().moduli();
        Self { shear, bulk }
    }

    fn check(parameters: &CorotationalParameters, complaints: &mut Complaints) {
        parameters.elasticity().check(complaints);
    }

    fn with_moduli(shear: f64, bulk: f64) -> CorotationalParameters {
        CorotationalParameters::Moduli { shear, bulk, rotation: Rotation::Polar }
    }
}

/// Principal stretches and directions at rest, a right-handed frame; the least stretch is the last and has the sign of
/// J.
struct Principal<R> {
    /// Stretches less 1: exact for small strains.
    biot: [R; 3],
    stretches: [R; 3],
    axes: [[R; 3]; 3],
}

struct FindPrincipal<'a, R>(&'a Kinematics<R>);

impl<R: Real> Task<R> for FindPrincipal<'_, R> {
    type Output = Principal<R>;

    #[inline(always)]
    fn run(self) -> Principal<R> {
        let Self(k) = self;
        let (mut strains, mut axes) = k.green_strain.eigen();
        let (zero, one, two) = (k.j.constant(0.0), k.j.constant(1.0), k.j.constant(2.0));
        for i in 0..2 {
            let less = strains[2] - strains[i];
            (strains[i], strains[2]) = (strains[i].max(strains[2]), strains[i].min(strains[2]));
            for j in 0..3 {
                let (own, last) = (axes[i][j], axes[2][j]);
                axes[i][j] = less.if_positive(last, own);
                axes[2][j] = less.if_positive(own, last);
            }
        }
        axes[2] = cross(axes[0], axes[1]);
        let first = two.mul_add(strains[0], one).max(zero).sqrt();
        let second = two.mul_add(strains[1], one).max(zero).sqrt();
        // C does not know the sign, and where it is nearly singular not even the size
        let tiny = one.constant(f64::from(f32::MIN_POSITIVE));
        let least = first.min(second);
        let last = (k.true_j / (first * second).max(tiny)).max(-least).min(least);
        // s − 1 = 2E/(1 + s)
        let of_last = (last - one.constant(0.5)).if_positive(two * strains[2] / (one + last).max(one), last - one);
        Principal {
            biot: [two * strains[0] / (one + first).max(one), two * strains[1] / (one + second).max(one), of_last],
            stretches: [first, second, last],
            axes,
        }
    }
}

#[inline(always)]
fn cross<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [minor(a[1], a[2], b[1], b[2]), minor(a[2], a[0], b[2], b[0]), minor(a[0], a[1], b[0], b[1])]
}

/// F n of ∇u.
#[inline(always)]
fn deformed<R: Real>(h: &[[R; 3]; 3], n: [R; 3]) -> [R; 3] {
    [dot_plus(h[0], n, n[0]), dot_plus(h[1], n, n[1]), dot_plus(h[2], n, n[2])]
}

/// A vector of length 1; nothing of nothing.
#[inline(always)]
fn unit<R: Real>(a: [R; 3]) -> [R; 3] {
    let per_length = a[0].constant(1.0) / dot(a, a).sqrt().max(a[0].constant(f64::from(f32::MIN_POSITIVE)));
    [a[0] * per_length, a[1] * per_length, a[2] * per_length]
}

impl<R: Real> Principal<R> {
    #[inline(always)]
    fn of(k: &Kinematics<R>) -> Self {
        k.j.outlined(FindPrincipal(k))
    }

    /// θ = tr B.
    #[inline(always)]
    fn theta(&self) -> R {
        self.biot[0] + self.biot[1] + self.biot[2]
    }

    /// Eigenvalues of dev B.
    #[inline(always)]
    fn deviator(&self) -> [R; 3] {
        let mean = self.theta() * self.theta().constant(1.0 / 3.0);
        [self.biot[0] - mean, self.biot[1] - mean, self.biot[2] - mean]
    }

    /// 1/s, bounded: U⁻¹ does not exist where something is flat.
    #[inline(always)]
    fn inverse_stretches(&self) -> [R; 3] {
        let (one, floor) = (self.biot[0].constant(1.0), self.biot[0].constant(J_FLOOR));
        let [first, second, last] = self.stretches;
        [one / first.max(floor), one / second.max(floor), one / last.if_positive(last.max(floor), last.min(-floor))]
    }

    /// Σ aᵢ Nᵢ⊗Nᵢ.
    #[inline(always)]
    fn tensor(&self, values: [R; 3]) -> Sym3<R> {
        let [first, second, last] = self.axes;
        Sym3::square_of(first)
            .scaled(values[0])
            .plus_scaled(values[1], &Sym3::square_of(second))
            .plus_scaled(values[2], &Sym3::square_of(last))
    }

    /// R Σ aᵢ Nᵢ⊗Nᵢ: F N of the two larger stretches span the deformed frame, also where the third is 0.
    #[inline(always)]
    fn turned(&self, gradient: &Mat3<R>, values: [R; 3]) -> Mat3<R> {
        let h = &gradient.0;
        let [n0, n1, n2] = self.axes;
        let first = unit(deformed(h, n0));
        let second = deformed(h, n1);
        let along = dot(first, second);
        let second = unit([
            (-along).mul_add(first[0], second[0]),
            (-along).mul_add(first[1], second[1]),
            (-along).mul_add(first[2], second[2]),
        ]);
        let last = cross(first, second);
        let mut stress = Mat3::zero(values[0]);
        for i in 0..3 {
            stress.add_to_row(i, values[0] * first[i], n0);
            stress.add_to_row(i, values[1] * second[i], n1);
            stress.add_to_row(i, values[2] * last[i], n2);
        }
        stress
    }
}

impl<R: Real> Corotational<R> {
    /// Eigenvalues of 2μ dev B + p I (Pa).
    #[inline(always)]
    fn biot_stresses(&self, principal: &Principal<R>, pressure: R) -> [R; 3] {
        let (deviator, twice) = (principal.deviator(), self.shear + self.shear);
        [
            twice.mul_add(deviator[0], pressure),
            twice.mul_add(deviator[1], pressure),
            twice.mul_add(deviator[2], pressure),
        ]
    }

    /// S_iso (Pa): 2μ U⁻¹ dev B.
    #[inline(always)]
    fn isochoric_of(&self, principal: &Principal<R>) -> Sym3<R> {
        let stresses = self.biot_stresses(principal, self.shear.constant(0.0));
        let inverse = principal.inverse_stretches();
        principal.tensor([stresses[0] * inverse[0], stresses[1] * inverse[1], stresses[2] * inverse[2]])
    }
}

impl<R: Real> Elastic<R> for Corotational<R> {
    type Of<Q: Real> = Corotational<Q>;

    #[inline(always)]
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> Corotational<Q> {
        Corotational { shear: number(self.shear), bulk: number(self.bulk) }
    }

    /// R (2μ dev B + p I). Of `isochoric` counts what effects have made of S_iso, nothing without effects: U⁻¹ does not
    /// exist where something is flat.
    #[inline(always)]
    fn first_stress(&self, gradient: &Mat3<R>, k: &Kinematics<R>, isochoric: &Sym3<R>, pressure: R) -> Mat3<R> {
        let principal = Principal::of(k);
        let effects = isochoric.plus_scaled(pressure.constant(-1.0), &self.isochoric_of(&principal));
        let mut stress = principal.turned(gradient, self.biot_stresses(&principal, pressure));
        let more = gradient.plus_identity_times(&effects);
        for i in 0..3 {
            for j in 0..3 {
                stress.0[i][j] += more.0[i][j];
            }
        }
        stress
    }

    /// From the rotation alone: principal directions, which nothing else asks for here, are found three times by way of
    /// S.
    #[inline(always)]
    fn alone(&self, gradient: &Mat3<R>) -> Option<(Mat3<R>, R)> {
        let polar = Polar::new(gradient);
        let theta = polar.biot.trace();
        let twice = self.shear + self.shear;
        let mean = twice.mul_add(theta * theta.constant(-1.0 / 3.0), self.pressure(theta));
        let stress = polar.turned(&polar.biot.scaled(twice).plus_diagonal(mean));
        Some((stress, theta.constant(1.0) + gradient.volume_change()))
    }

    /// 2μ U⁻¹ dev B.
    #[inline(always)]
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        self.isochoric_of(&Principal::of(k))
    }

    /// tr B.
    #[inline(always)]
    fn volume_measure(&self, k: &Kinematics<R>) -> R {
        Principal::of(k).theta()
    }

    /// p U⁻¹.
    #[inline(always)]
    fn volumetric(&self, k: &Kinematics<R>, pressure: R) -> Sym3<R> {
        let principal = Principal::of(k);
        principal.tensor(principal.inverse_stretches()).scaled(pressure)
    }

    /// s − (s:U)/3 U⁻¹.
    #[inline(always)]
    fn without_pressure(&self, k: &Kinematics<R>, stress: Sym3<R>) -> Sym3<R> {
        let principal = Principal::of(k);
        let pressing = stress.contracted(&principal.tensor(principal.stretches)) * k.j.constant(-1.0 / 3.0);
        stress.plus_scaled(pressing, &principal.tensor(principal.inverse_stretches()))
    }

    /// κ tr B.
    #[inline(always)]
    fn pressure(&self, theta: R) -> R {
        self.bulk * theta
    }

    /// μ dev B:dev B.
    #[inline(always)]
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
        let deviator = Principal::of(k).deviator();
        self.shear * dot(deviator, deviator)
    }

    /// κ/2 (tr B)².
    #[inline(always)]
    fn volumetric_energy(&self, theta: R) -> R {
        self.bulk.constant(0.5) * self.bulk * theta * theta
    }

    fn small_strain_moduli(&self) -> [R; 2] {
        [self.shear, self.bulk]
    }
}
