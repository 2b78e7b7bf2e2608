//! Fibres, both laws.

use super::samples::{FibresBothWays, FibresTensionOnly};
use super::{ETA, largest, matrix, stress, stress_in_f32};
use crate::random::{Random, gradient};
use glam::{DMat3, DVec3};
use sinew::materials::{ExponentialFibre, Fibres, Kinematics};

#[test]
fn fibres_have_no_head_and_no_tail() {
    let mut random = Random(5);
    for _ in 0..100 {
        let (f, a) = (random.deformation(), random.vector().normalize());
        assert_eq!(stress::<FibresBothWays>(f, a), stress::<FibresBothWays>(f, -a));
        assert_eq!(stress_in_f32::<FibresTensionOnly>(f, a), stress_in_f32::<FibresTensionOnly>(f, -a));
    }
}

/// Along fibres stretched to λ at constant volume S = 2η(λ² − 1)·2/3: the paper's Ψ = η/2 (Ī₄ − 1)², with its factor 2.
#[test]
fn fibres_have_the_papers_factor_two() {
    for stretch in [0.7_f64, 1.02, 1.5] {
        let across = stretch.sqrt().recip();
        let f = DMat3::from_diagonal(DVec3::new(stretch, across, across));
        let expected = 2.0 * ETA * (stretch * stretch - 1.0) * 2.0 / 3.0;
        let found = stress::<FibresBothWays>(f, DVec3::X).x_axis.x;
        assert!((found / expected - 1.0).abs() < 1e-12, "λ = {stretch}: {found} instead of {expected}");
    }
}

#[test]
fn tension_only_fibres_pull_like_the_others_and_do_not_push() {
    let mut random = Random(6);
    for _ in 0..100 {
        let (f, a) = (random.deformation(), random.vector().normalize());
        let pulled = (f * a).length_squared() * f.determinant().powf(-2.0 / 3.0) > 1.0;
        let expected = if pulled { stress::<FibresBothWays>(f, a) } else { DMat3::ZERO };
        assert_eq!(stress::<FibresTensionOnly>(f, a), expected);
    }
}

fn exponential(family: ExponentialFibre<f64>, f: DMat3, a: DVec3) -> (DMat3, f64) {
    let k = Kinematics::new(&gradient(f));
    (matrix(&family.isochoric(&k, a.to_array())), family.energy(&k, a.to_array()))
}

/// Along fibres stretched to λ at constant volume, E = λ² − 1: S = 2k₁ E exp(k₂E²)·2/3 along and Ψ = k₁/(2k₂)(exp(k₂E²)
/// − 1).
#[test]
fn exponential_fibres_stiffen_as_their_formula_says() {
    for (k1, k2, stretch) in [(1000.0, 0.8, 1.1_f64), (996.6, 524.6, 1.05), (50.0, 10.0, 1.3)] {
        let across = stretch.sqrt().recip();
        let f = DMat3::from_diagonal(DVec3::new(stretch, across, across));
        let family = ExponentialFibre { k1, k2, dispersion: 0.0, tension_only: 1.0 };
        let strain = stretch * stretch - 1.0;
        let grown = (k2 * strain * strain).exp();
        let (s, energy) = exponential(family, f, DVec3::X);
        let expected = 2.0 * k1 * strain * grown * 2.0 / 3.0;
        assert!((s.x_axis.x / expected - 1.0).abs() < 1e-12, "{} instead of {expected}", s.x_axis.x);
        let expected = k1 / (2.0 * k2) * (grown - 1.0);
        assert!((energy / expected - 1.0).abs() < 1e-10, "{energy} instead of {expected}");
    }
}

/// With k₂ = 0 and no dispersion they are the fibres of η = k₁; a k₂ next to nothing makes next to no difference.
#[test]
fn exponential_fibres_that_do_not_grow_are_the_others() {
    let mut random = Random(7);
    for _ in 0..200 {
        let (f, a) = (random.deformation(), random.vector().normalize());
        for tension_only in [0.0, 1.0] {
            let plain = Fibres { eta: ETA, tension_only };
            let k = Kinematics::new(&gradient(f));
            let expected = (matrix(&plain.isochoric(&k, a.to_array())), plain.energy(&k, a.to_array()));
            for k2 in [0.0, 1e-12] {
                let found = exponential(ExponentialFibre { k1: ETA, k2, dispersion: 0.0, tension_only }, f, a);
                assert!(largest(found.0 - expected.0) < 1e-8 * ETA, "{found:?} instead of {expected:?}");
                assert!((found.1 - expected.1).abs() < 1e-8 * ETA, "{found:?} instead of {expected:?}");
            }
        }
    }
}

/// Dispersed over all directions alike, a family is isotropic: it does not know its direction.
#[test]
fn fully_dispersed_fibres_have_no_direction() {
    let mut random = Random(8);
    let family = ExponentialFibre { k1: ETA, k2: 0.3, dispersion: 1.0 / 3.0, tension_only: 1.0 };
    for _ in 0..100 {
        let f = random.deformation();
        let [one, other] = [0, 1].map(|_| exponential(family, f, random.vector().normalize()));
        assert!(largest(one.0 - other.0) < 1e-9 * (ETA + largest(one.0)), "{one:?}, {other:?}");
    }
}

/// An exponent beyond all numbers makes an enormous stress and no NaN.
#[test]
fn fibres_stretched_beyond_all_numbers_make_no_nan() {
    let f = DMat3::from_diagonal(DVec3::new(9.0, 1.0, 1.0));
    let family = ExponentialFibre { k1: 1e3_f32, k2: 500.0, dispersion: 0.1, tension_only: 1.0 };
    let k = Kinematics::<f32>::new(&gradient(f));
    let s = family.isochoric(&k, [1.0, 0.0, 0.0]);
    assert!(s.0.iter().all(|x| !x.is_nan()) && !family.energy(&k, [1.0, 0.0, 0.0]).is_nan(), "{s:?}");
}
