//! The co-rotational law against closed forms, from known principal stretches: F = U diag(s) Vᵀ with rotations U and V,
//! so that R = U Vᵀ whatever the sign of the last stretch, and P = U diag(2μ(s − 1) + λ t) Vᵀ with t = Σ s − 3.

use super::samples::Corotational;
use super::{BULK, ENTRIES, ETA, Law, SHEAR, by_entry, energy, first_stress, largest};
use crate::random::{Random, gradient};
use glam::{DMat3, DVec3};
use sinew::materials::{Elastic, Fibres};

const LAME: f64 = BULK - 2.0 / 3.0 * SHEAR;

fn pull(f: DMat3) -> DMat3 {
    first_stress::<Corotational>(f, DVec3::X)
}

fn pull_in_f32(f: DMat3) -> DMat3 {
    let rows = Corotational::first_stress::<f32>(&gradient(f), [1.0, 0.0, 0.0]).0;
    let column = |j: usize| DVec3::from_array([0, 1, 2].map(|i| f64::from(rows[i][j])));
    DMat3::from_cols(column(0), column(1), column(2))
}

/// Descending stretches, the last of any sign, whose sums in pairs stay away from 0, and F of them.
struct Known {
    u: DMat3,
    v: DMat3,
    stretches: DVec3,
}

impl Known {
    fn random(random: &mut Random, sign: f64) -> Self {
        let mut stretches = [1.3, 1.0, 0.6].map(|middle| middle + 0.15 * random.number());
        stretches[2] *= sign;
        Self { u: random.rotation(), v: random.rotation(), stretches: DVec3::from_array(stretches) }
    }

    fn f(&self) -> DMat3 {
        self.u * DMat3::from_diagonal(self.stretches) * self.v.transpose()
    }

    fn trace(&self) -> f64 {
        self.stretches.element_sum() - 3.0
    }

    fn stress(&self) -> DMat3 {
        let along = (self.stretches - 1.0) * (2.0 * SHEAR) + DVec3::splat(LAME * self.trace());
        self.u * DMat3::from_diagonal(along) * self.v.transpose()
    }

    /// (uᵢ vⱼᵀ ± uⱼ vᵢᵀ)/√2.
    fn mode(&self, i: usize, j: usize, sign: f64) -> DMat3 {
        let mut inner = DMat3::ZERO;
        inner.col_mut(j)[i] = 0.5_f64.sqrt();
        inner.col_mut(i)[j] = sign * 0.5_f64.sqrt();
        self.u * inner * self.v.transpose()
    }
}

const PAIRS: [(usize, usize); 3] = [(0, 1), (1, 2), (0, 2)];

/// P = E(λ − 1) where the width is 1 − ν(λ − 1), up to λ = 1 + 1/ν, where the volume ends. Entries of 3 (λ + 2μ) |F|
/// cancel across the axis: a few roundings of these.
#[test]
fn uniaxial_stress_is_linear_for_ever() {
    let young = 9.0 * BULK * SHEAR / (3.0 * BULK + SHEAR);
    let poisson = (3.0 * BULK - 2.0 * SHEAR) / (6.0 * BULK + 2.0 * SHEAR);
    let mut random = Random(21);
    for stretch in [0.3, 0.7, 1.0 - 1e-6, 1.2, 2.0, 3.0] {
        let across = 1.0 - poisson * (stretch - 1.0);
        let turn = random.rotation();
        let p = turn.transpose() * pull(turn * DMat3::from_diagonal(DVec3::new(stretch, across, across)));
        let expected = DMat3::from_diagonal(DVec3::new(young * (stretch - 1.0), 0.0, 0.0));
        assert!(largest(p - expected) < 1e-12 * BULK, "{stretch}: {p}");
    }
}

/// Sheared by γ: R turns by atan(γ/2), t = 2√(1 + γ²/4) − 2, P = 2μ(F − R) + λ t R.
#[test]
fn simple_shear_has_its_closed_form() {
    for shear in [1e-3_f64, 0.1, 0.5, 1.0, 2.0] {
        let f = DMat3::from_cols(DVec3::X, DVec3::new(shear, 1.0, 0.0), DVec3::Z);
        let r = DMat3::from_rotation_z(-(0.5 * shear).atan());
        let trace = 2.0 * (1.0 + 0.25 * shear * shear).sqrt() - 2.0;
        let expected = (f - r) * (2.0 * SHEAR) + r * (LAME * trace);
        assert!(largest(pull(f) - expected) < 1e-13 * BULK * (1.0 + shear), "γ {shear}: {}", pull(f));
    }
}

/// Also inside out and nearly flat. Roundings of E, of the size of |F|² ε, come to stretches as |F|²/(2s): some
/// fifteen of them times 2μ + 3λ for the second stretch, which is .85 at least.
#[test]
fn stress_is_that_of_the_principal_stretches_on_both_sides_of_flat() {
    let mut random = Random(22);
    for sign in [1.0, 1e-3, 0.0, -1e-3, -1.0] {
        let (mut worst64, mut worst32) = (0.0_f64, 0.0_f64);
        for _ in 0..300 {
            let known = Known::random(&mut random, sign);
            worst64 = worst64.max(largest(pull(known.f()) - known.stress()));
            worst32 = worst32.max(largest(pull_in_f32(known.f()) - known.stress()));
        }
        let scale = 2.0 * SHEAR + 3.0 * LAME;
        let roundings = [worst64 / (scale * f64::EPSILON), worst32 / (scale * f64::from(f32::EPSILON))];
        println!("last stretch times {sign}: {roundings:.1?} ε of the largest modulus");
        assert!(roundings.iter().all(|&roundings| roundings < 15.0), "{sign}: {roundings:?}");
    }
}

/// Turned by any angle, rest stays without stress, to the roundings of E from a ∇u of the size of 2 to 4.
#[test]
fn rotations_are_without_stress() {
    let mut random = Random(23);
    let (mut worst64, mut worst32) = (0.0_f64, 0.0_f64);
    for _ in 0..300 {
        let r = random.rotation();
        worst64 = worst64.max(largest(pull(r)) / BULK);
        // rounded to f32, a rotation is none: the stretches of what is left are half an ε
        worst32 = worst32.max(largest(pull_in_f32(r)) / BULK);
    }
    println!("rotated: f64 {:.1} ε, f32 {:.1} ε of κ", worst64 / f64::EPSILON, worst32 / f64::from(f32::EPSILON));
    assert!(worst64 < 15.0 * f64::EPSILON && worst32 < 15.0 * f64::from(f32::EPSILON), "{worst64:e} {worst32:e}");
}

/// P Fᵀ is symmetric: no torque, at any deformation, inside out too.
#[test]
fn stress_makes_no_torque() {
    let mut random = Random(24);
    for sign in [1.0, -1.0] {
        for _ in 0..300 {
            let f = Known::random(&mut random, sign).f();
            let moment = pull(f) * f.transpose();
            let torque = largest(moment - moment.transpose());
            assert!(torque < 100.0 * f64::EPSILON * BULK, "{f}: {torque:e}");
        }
    }
}

/// Inside out and close to flat, where the energy of two mirrored states meets that of the others smoothly.
#[test]
fn stress_is_the_derivative_of_energy_inside_out_too() {
    let mut random = Random(25);
    for sign in [1e-2, 0.0, -1e-2, -1.0] {
        for _ in 0..50 {
            let f = Known::random(&mut random, sign).f();
            for (i, j) in ENTRIES {
                let slope = by_entry(f, (i, j), |f| energy::<Corotational>(f, DVec3::X));
                let found = pull(f).col(j)[i];
                assert!((slope - found).abs() < 1e-6 * super::ALL_MODULI, "{sign}, {f}: {slope} {found}");
            }
        }
    }
}

/// δR = Σ 2/(sᵢ + sⱼ) q (q : δF) with q = (uᵢ vⱼᵀ − uⱼ vᵢᵀ)/√2, δP = 2μ(δF − δR) + λ(R : δF)R + λ t δR: so 2μ + 3λ
/// along R, 2μ five times, and 2μ + 2(λ t − 2μ)/(sᵢ + sⱼ) for each q. Central differences of 1e-6 err by eps P/h.
#[test]
fn tangent_has_its_eigenvalues() {
    let mut random = Random(26);
    let h = 1e-6;
    for sign in [1.0, -0.5] {
        for _ in 0..50 {
            let known = Known::random(&mut random, sign);
            let f = known.f();
            let r = known.u * known.v.transpose();
            let turn = |values: DVec3| known.u * DMat3::from_diagonal(values) * known.v.transpose();
            let mut modes = vec![
                (r, 2.0 * SHEAR + 3.0 * LAME),
                (turn(DVec3::new(1.0, -1.0, 0.0)), 2.0 * SHEAR),
                (turn(DVec3::new(0.5, 0.5, -1.0)), 2.0 * SHEAR),
            ];
            for (i, j) in PAIRS {
                let sum = known.stretches[i] + known.stretches[j];
                let twist = 2.0 * SHEAR + 2.0 * (LAME * known.trace() - 2.0 * SHEAR) / sum;
                modes.push((known.mode(i, j, 1.0), 2.0 * SHEAR));
                modes.push((known.mode(i, j, -1.0), twist));
            }
            for (mode, eigenvalue) in modes {
                let change = (pull(f + mode * h) - pull(f - mode * h)) * (0.5 / h);
                let error = largest(change - mode * eigenvalue);
                assert!(error < 1e-6 * super::ALL_MODULI * 10.0, "{sign}: {eigenvalue}: {error:e}");
            }
        }
    }
}

/// The way that finds stretches once, with fibres and with a pressure of the element's, against that by S.
#[test]
fn short_way_gives_what_the_long_way_gives() {
    let law = Corotational::law();
    let fibres = Fibres { eta: ETA, tension_only: 0.0 };
    let mut random = Random(27);
    for _ in 0..300 {
        let (h, a) = (gradient::<f64>(random.deformation()), random.vector().normalize().to_array());
        let k = law.kinematics(&h);
        let isochoric = law.isochoric(&k).plus(&fibres.isochoric(&k, a));
        let own = law.pressure(law.volume_measure(&k));
        for pressure in [None, Some(0.3 * BULK)] {
            let long = law.first_stress(&h, &k, &isochoric, pressure.unwrap_or(own));
            let (short, j) = law.direct_stress(&h, pressure, Some((fibres, a)));
            let pairs = long.0.as_flattened().iter().zip(short.0.as_flattened());
            let worst = pairs.fold(0.0_f64, |worst, (long, short)| worst.max((long - short).abs()));
            assert!(worst < 2e-12 * super::ALL_MODULI && j == k.true_j, "{worst:e}");
        }
    }
}

/// Flat in two directions no digit tells how the frame stands around the third axis; but it is a frame: the stress is
/// as large as it must be. Stretches below the root of ε = 1.2e-7 are known to that root.
#[test]
fn what_is_a_thread_is_pushed_apart() {
    let mut random = Random(28);
    for _ in 0..300 {
        let stretches = DVec3::new(1.3, 1e-5 * random.number().abs(), 1e-6 * random.number());
        let known = Known { u: random.rotation(), v: random.rotation(), stretches };
        let size = |m: DMat3| m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
        let (found, expected) = (size(pull_in_f32(known.f())), size(known.stress()));
        assert!((found / expected - 1.0).abs() < 1e-2, "{found} instead of {expected}");
    }
}

/// F = 0, flat in two directions, mirrored in all: no right answer in some, numbers in all, in f32 too.
#[test]
fn nothing_makes_a_nan() {
    for stretches in [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [-1.0; 3], [1.0, -1.0, 1.0], [1e-4, 1e-4, 1e4]] {
        let f = DMat3::from_diagonal(DVec3::from_array(stretches));
        for p in [pull(f), pull_in_f32(f)] {
            assert!(p.is_finite(), "{stretches:?}: {p}");
        }
    }
}
