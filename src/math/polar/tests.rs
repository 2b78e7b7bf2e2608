use super::super::Scalar;
use super::*;
use glam::{DMat3, DQuat, DVec3};

/// Largest errors of R U and of U, U − I being given, relative to U and to U − I.
fn errors<T: Scalar>(rotation: DQuat, stretches: DVec3, axes: DQuat) -> (f64, f64) {
    let (rotation, axes) = (DMat3::from_quat(rotation), DMat3::from_quat(axes));
    let strain = axes * DMat3::from_diagonal(stretches - 1.0) * axes.transpose();
    let gradient = rotation * strain + (rotation - DMat3::IDENTITY);
    let rows = |m: DMat3| [0, 1, 2].map(|i| [0, 1, 2].map(|j| m.col(j)[i]));
    let given = Mat3(rows(gradient).map(|row| row.map(T::from_f64)));
    let polar = Polar::new(&given);
    // F again from both; and U − I, turned over again
    let biot = polar.biot;
    let whole = polar.turned(&biot.plus_diagonal(T::from_f64(1.0)));
    let (mut worst, mut strains) = (0.0_f64, 0.0_f64);
    let [f, e, b] = [rows(gradient + DMat3::IDENTITY), rows(strain), biot.rows().map(|row| row.map(T::to_f64))];
    for i in 0..3 {
        for j in 0..3 {
            worst = worst.max((whole.0[i][j].to_f64() - f[i][j]).abs());
            let signs = polar.half_turn[i].to_f64() * polar.half_turn[j].to_f64();
            strains = strains.max((signs * b[i][j] - e[i][j]).abs());
        }
    }
    let (largest, strain) = (stretches.abs().max_element(), (stretches - 1.0).abs().max_element());
    assert!(worst.is_finite() && strains.is_finite(), "{stretches}");
    (worst / largest, strains / strain.max(1e-300))
}

fn turned(dice: &mut fastrand::Rng) -> DQuat {
    let mut way = || 2.0 * dice.f64() - 1.0;
    DQuat::from_xyzw(way(), way(), way(), way()).normalize()
}

#[test]
fn rotation_and_stretch_make_the_deformation_again() {
    let mut dice = fastrand::Rng::with_seed(3);
    for (least, most) in [(0.5, 2.0), (0.05, 5.0), (0.9, 1.1)] {
        for i in 0..20_000 {
            let size = |dice: &mut fastrand::Rng| least + (most - least) * dice.f64();
            let stretches = DVec3::from_array([0; 3].map(|_| size(&mut dice)));
            let rotation = match i % 3 {
                0 => DQuat::from_axis_angle([DVec3::X, DVec3::Y, DVec3::Z][i % 9 / 3], std::f64::consts::PI),
                _ => turned(&mut dice),
            };
            let axes = turned(&mut dice);
            // a rotation that is wrong by δ makes an error of δ times what is lost of the stretches: ε over the gap
            let gap = (stretches.element_sum() - stretches.max_element()) / stretches.max_element();
            let (single, double) = (errors::<f32>(rotation, stretches, axes), errors::<f64>(rotation, stretches, axes));
            assert!(single.0 < 32.0 * f64::from(f32::EPSILON) / gap, "{stretches}: {single:?}");
            assert!(double.0 < 64.0 * f64::EPSILON / gap, "{stretches}: {double:?}");
        }
    }
}

#[test]
fn small_strains_keep_their_digits() {
    let mut dice = fastrand::Rng::with_seed(4);
    for size in [1e-2, 1e-4, 1e-6] {
        for _ in 0..2000 {
            let stretches = DVec3::from_array([0; 3].map(|_| 1.0 + size * (2.0 * dice.f64() - 1.0)));
            let (_, single) = errors::<f32>(DQuat::IDENTITY, stretches, turned(&mut dice));
            let (_, double) = errors::<f64>(DQuat::IDENTITY, stretches, turned(&mut dice));
            assert!(single < 8.0 * f64::from(f32::EPSILON) && double < 8.0 * f64::EPSILON + 2e-16 / size, "{size}");
        }
    }
}

#[test]
fn what_is_inside_out_has_a_least_stretch_below_0() {
    let mut dice = fastrand::Rng::with_seed(5);
    for _ in 0..20_000 {
        let [a, b] = [0.5 + dice.f64(), 0.5 + dice.f64()];
        let stretches = DVec3::new(a, b, -0.7 * dice.f64() * a.min(b));
        let (rotation, axes) = (turned(&mut dice), turned(&mut dice));
        // the further, the more of λ's other roots are near
        let gap = (stretches.min_element() + a.min(b)) / stretches.element_sum();
        let (single, strain) = errors::<f32>(rotation, stretches, axes);
        assert!(
            single.max(strain) < 64.0 * f64::from(f32::EPSILON) / gap.powi(2),
            "{stretches}: {single:e} {strain:e}"
        );
        let (double, strain) = errors::<f64>(rotation, stretches, axes);
        assert!(double.max(strain) < 64.0 * f64::EPSILON / gap.powi(2), "{stretches}: {double:e} {strain:e}");
    }
}

#[test]
fn what_is_flat_a_line_a_point_or_no_number_has_a_rotation_or_none() {
    let mut dice = fastrand::Rng::with_seed(6);
    for stretches in [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, -1.0), DVec3::splat(1e8)] {
        for _ in 0..200 {
            let (rotation, axes) = (DMat3::from_quat(turned(&mut dice)), DMat3::from_quat(turned(&mut dice)));
            let f = rotation * axes * DMat3::from_diagonal(stretches) * axes.transpose() - DMat3::IDENTITY;
            let polar = Polar::new(&Mat3([0, 1, 2].map(|i| [0, 1, 2].map(|j| f.col(j)[i] as f32))));
            let r = polar.turned(&Sym3([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])).0;
            let r = DMat3::from_cols_array_2d(&r.map(|row| row.map(f64::from)));
            assert!(
                (r.transpose() * r - DMat3::IDENTITY).to_cols_array().iter().all(|e| e.abs() < 1e-5),
                "{stretches}: {r}"
            );
            assert!((r.determinant() - 1.0).abs() < 1e-5, "{stretches}: {r}");
        }
    }
    let none = Polar::new(&Mat3([[f32::NAN, 0.0, 0.0], [0.0; 3], [0.0; 3]])).biot.0;
    assert!(none.iter().any(|e| e.is_nan()), "{none:?}");
}
