//! Every law, one macro.
//!
//! Ψ energy per rest volume, P = F S = ∂Ψ/∂F, S unchanged for Q F, ∂P/∂F symmetric, S = λ tr ε + 2μ ε at small strains.
//! Bounds: M = 1.5e4 Pa is the sum of all moduli. Central differences with h = 1e-6 err by h²Ψ''' and by eps Ψ/h, both
//! below 1e-6 M; at Ī₄ = 1 the tension-only fibres have a kink in P that errs by hΨ'' = 1e-6 M. Objectivity: E errs by
//! some 10 eps |F|², S = ∂Ψ/∂E by |∂S/∂E| ≤ 20 M of that for |F⁻¹| ≤ 4: 1e3 eps M covers it.

mod closed_forms;
mod fibres;
mod polar_rotation;
mod samples;
mod short_ways;

use crate::random::{Random, gradient};
use glam::{DMat3, DVec3};
use sinew::materials::Kinematics;
use sinew::math::{Mat3, Real, Sym3};

const SHEAR: f64 = 3000.0 / 2.9;
const BULK: f64 = 1e4;
const ETA: f64 = 2000.0;
const ALL_MODULI: f64 = 1.5e4;

/// A law with its moduli; `a` is the fibres' direction.
trait Law {
    fn kinematics<R: Real>(gradient: &Mat3<R>) -> Kinematics<R> {
        Kinematics::new(gradient)
    }
    fn first_stress<R: Real>(gradient: &Mat3<R>, a: [R; 3]) -> Mat3<R> {
        gradient.plus_identity_times(&Self::stress(&Self::kinematics(gradient), a))
    }
    fn stress<R: Real>(k: &Kinematics<R>, a: [R; 3]) -> Sym3<R>;
    fn energy<R: Real>(k: &Kinematics<R>, a: [R; 3]) -> R;
    /// λ and 2μ at small strains, and 8η/3·(a⊗a deviator) as the factor of fibres.
    fn small() -> (f64, f64, f64);
    /// What is 0 where there is a kink in the stress.
    fn kink(_: DMat3, _: DVec3) -> f64 {
        1.0
    }
}

fn matrix(s: &Sym3<f64>) -> DMat3 {
    let [xx, yy, zz, xy, yz, xz] = s.0;
    DMat3::from_cols(DVec3::new(xx, xy, xz), DVec3::new(xy, yy, yz), DVec3::new(xz, yz, zz))
}

fn stress<L: Law>(f: DMat3, a: DVec3) -> DMat3 {
    matrix(&L::stress(&L::kinematics(&gradient(f)), a.to_array()))
}

fn stress_in_f32<L: Law>(f: DMat3, a: DVec3) -> DMat3 {
    let s = L::stress(&L::kinematics::<f32>(&gradient(f)), a.as_vec3().to_array());
    matrix(&Sym3(s.0.map(f64::from)))
}

fn first_stress<L: Law>(f: DMat3, a: DVec3) -> DMat3 {
    let first = L::first_stress(&gradient(f), a.to_array()).0;
    DMat3::from_cols(first[0].into(), first[1].into(), first[2].into()).transpose()
}

fn energy<L: Law>(f: DMat3, a: DVec3) -> f64 {
    L::energy(&L::kinematics(&gradient(f)), a.to_array())
}

fn largest(m: DMat3) -> f64 {
    m.to_cols_array().into_iter().fold(0.0, |largest, x| largest.max(x.abs()))
}

/// Central difference of `of` by entry (i, j) of F.
fn by_entry<T: std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T>>(
    f: DMat3,
    (i, j): (usize, usize),
    of: impl Fn(DMat3) -> T,
) -> T {
    let h = 1e-6;
    let moved = |by: f64| {
        let mut f = f;
        f.col_mut(j)[i] += by;
        of(f)
    };
    (moved(h) - moved(-h)) * (0.5 / h)
}

const ENTRIES: [(usize, usize); 9] = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1), (0, 2), (1, 2), (2, 2)];

fn stress_is_the_derivative_of_energy<L: Law>() {
    let mut random = Random(1);
    let mut worst: f64 = 0.0;
    for _ in 0..200 {
        let (f, a) = (random.deformation(), random.vector().normalize());
        let first = first_stress::<L>(f, a);
        for (i, j) in ENTRIES {
            let error = (by_entry(f, (i, j), |f| energy::<L>(f, a)) - first.col(j)[i]).abs();
            worst = worst.max(error / (ALL_MODULI + largest(first)));
        }
    }
    println!("derivative of energy: {worst:.2e}");
    assert!(worst < 1e-6, "error {worst:e}");
}

fn stress_does_not_see_rotations<L: Law>() {
    let mut random = Random(2);
    let (mut worst64, mut worst32): (f64, f64) = (0.0, 0.0);
    for _ in 0..500 {
        let (f, a, q) = (random.deformation(), random.vector().normalize(), random.rotation());
        if largest(f.inverse()) > 3.0 {
            continue;
        }
        let s = stress::<L>(f, a);
        worst64 = worst64.max(largest(stress::<L>(q * f, a) - s) / ALL_MODULI);
        worst32 = worst32.max(largest(stress_in_f32::<L>(q * f, a) - s) / ALL_MODULI);
    }
    println!("objectivity: f64 {worst64:.2e}, f32 {worst32:.2e}");
    assert!(worst64 < 1e3 * f64::EPSILON, "f64: {worst64:e}");
    assert!(worst32 < 1e3 * f64::from(f32::EPSILON), "f32: {worst32:e}");
}

/// A strain of 1e-6 is right to 1e-5 in both precisions: what is left out is of the order of the strain, and f32 keeps
/// its digits because nothing is computed from F.
fn small_strains_obey_hooke<L: Law>() {
    let mut random = Random(3);
    for _ in 0..100 {
        let m = random.matrix();
        let strain = (m + m.transpose()) * 0.5e-6;
        let mut a = random.vector().normalize();
        // tension-only fibres are asked in tension
        let deviator = |e: DMat3| e - DMat3::from_diagonal(DVec3::splat((e.x_axis.x + e.y_axis.y + e.z_axis.z) / 3.0));
        let mut turns = 0;
        while a.dot(deviator(strain) * a) < 1e-7 && turns < 100 {
            a = random.vector().normalize();
            turns += 1;
        }
        if turns == 100 {
            continue;
        }
        let (lambda, twice_shear, fibre) = L::small();
        let trace = strain.x_axis.x + strain.y_axis.y + strain.z_axis.z;
        let aa = DMat3::from_cols(a * a.x, a * a.y, a * a.z);
        let hooke = DMat3::from_diagonal(DVec3::splat(lambda * trace))
            + strain * twice_shear
            + deviator(aa) * (fibre * a.dot(deviator(strain) * a));
        let f = DMat3::IDENTITY + strain;
        let scale = (lambda + twice_shear + fibre) * 1e-6;
        for (name, found) in [("f64", stress::<L>(f, a)), ("f32", stress_in_f32::<L>(f, a))] {
            let error = largest(found - hooke) / scale;
            assert!(error < 1e-5, "{name}: {found} instead of {hooke}: {error:e}");
        }
    }
}

/// ∂P_ij/∂F_kl = ∂P_kl/∂F_ij. Away from the kink of tension-only fibres, where there is no tangent.
fn tangent_is_symmetric<L: Law>() {
    let mut random = Random(4);
    let mut worst: f64 = 0.0;
    for _ in 0..60 {
        let (f, a) = (random.deformation(), random.vector().normalize());
        if L::kink(f, a).abs() < 1e-3 {
            continue;
        }
        let tangent = ENTRIES.map(|entry| by_entry(f, entry, |f| first_stress::<L>(f, a)));
        let scale = ALL_MODULI + tangent.iter().fold(0.0, |scale: f64, m| scale.max(largest(*m)));
        for (p, &(i, j)) in ENTRIES.iter().enumerate() {
            for (q, &(k, l)) in ENTRIES.iter().enumerate() {
                worst = worst.max((tangent[q].col(j)[i] - tangent[p].col(l)[k]).abs() / scale);
            }
        }
    }
    println!("asymmetry of the tangent: {worst:.2e}");
    assert!(worst < 1e-6, "{worst:e}");
}

macro_rules! laws {
    ($($name:ident: $law:ty $(, $objective:ident)?;)*) => {
        $(mod $name {
            use super::*;
            #[test]
            fn stress_is_the_derivative_of_energy() {
                super::stress_is_the_derivative_of_energy::<$law>();
            }
            $(#[doc = stringify!($objective)]
            #[test]
            fn stress_does_not_see_rotations() {
                super::stress_does_not_see_rotations::<$law>();
            })?
            #[test]
            fn small_strains_obey_hooke() {
                super::small_strains_obey_hooke::<$law>();
            }
            #[test]
            fn tangent_is_symmetric() {
                super::tangent_is_symmetric::<$law>();
            }
        })*
    };
}

laws! {
    // the linear theory sees rotations
    linear: samples::Linear;
    st_venant_kirchhoff: samples::StVenantKirchhoff, objective;
    corotational: samples::Corotational, objective;
    neo_hookean: samples::NeoHookean, objective;
    stable_neo_hookean: samples::StableNeoHookean, objective;
    mooney_rivlin: samples::MooneyRivlin, objective;
    ogden: samples::Ogden, objective;
    arruda_boyce: samples::ArrudaBoyce, objective;
    fibres_both_ways: samples::FibresBothWays, objective;
    fibres_tension_only: samples::FibresTensionOnly, objective;
    exponential_fibres: samples::ExponentialFibres, objective;
    dispersed_exponential_fibres: samples::DispersedExponentialFibres, objective;
}
