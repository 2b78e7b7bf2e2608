//! The neo-Hookean law's short ways, P straight from ∇u without viscosity and S_iso and P from 2E with it, against the
//! way by S that any law can go. M = 1.5e4 Pa is the sum of all moduli.

use super::{ALL_MODULI, BULK, ETA, SHEAR};
use crate::random::{Random, gradient};
use sinew::materials::{Elastic, Fibres, Kinematics, NeoHookean};
use sinew::math::{Mat3, Scalar, Sym3};

/// S_iso, P with a share of S_iso taken away as viscosity does, and P without viscosity.
struct Found<R>(Sym3<R>, Mat3<R>, Mat3<R>);

const REST: f64 = 0.7;

fn law<R: Scalar>() -> (NeoHookean<R>, Fibres<R>) {
    let number = R::from_f64;
    (NeoHookean { shear: number(SHEAR), bulk: number(BULK) }, Fibres { eta: number(ETA), tension_only: number(0.0) })
}

fn short<R: Scalar>(h: &Mat3<R>, a: [R; 3]) -> Found<R> {
    let (elastic, fibres) = law::<R>();
    let mut seen = None;
    let relax = |isochoric: Sym3<R>, volumetric: Sym3<R>| {
        seen = Some(isochoric);
        isochoric.scaled(R::from_f64(REST)).plus(&volumetric)
    };
    let relaxed = elastic.stress_relaxed(h, None, Some((fibres, Sym3::square_of(a))), relax).0;
    Found(seen.unwrap(), relaxed, elastic.direct_stress(h, None, Some((fibres, a))).0)
}

fn long<R: Scalar>(h: &Mat3<R>, a: [R; 3]) -> Found<R> {
    let (elastic, fibres) = law::<R>();
    let k = Kinematics::new(h);
    let isochoric = elastic.isochoric(&k).plus(&fibres.isochoric(&k, a));
    let pressure = elastic.pressure(elastic.volume_measure(&k));
    let of = |isochoric: &Sym3<R>| elastic.first_stress(h, &k, isochoric, pressure);
    Found(isochoric, of(&isochoric.scaled(R::from_f64(REST))), of(&isochoric))
}

/// The largest differences of entries (Pa): of S_iso and of both P.
fn differences<R: Scalar>(found: &Found<R>, expected: &Found<f64>) -> [f64; 3] {
    let largest = |found: &[R], expected: &[f64]| {
        let pairs = found.iter().zip(expected);
        pairs.fold(0.0, |worst: f64, (found, expected)| worst.max((found.to_f64() - expected).abs()))
    };
    [
        largest(&found.0.0, &expected.0.0),
        largest(found.1.0.as_flattened(), expected.1.0.as_flattened()),
        largest(found.2.0.as_flattened(), expected.2.0.as_flattened()),
    ]
}

/// For J in [.5, 2] and |∇u| < .6 C⁻¹ is below (1.6²)²·3/J² = 80, S below 80 M and P below 3 times that; some 30
/// roundings of terms of that size stay below 1e4 eps M = 2e-12 M.
#[test]
fn short_ways_give_what_the_long_way_gives() {
    let mut random = Random(11);
    let mut worst = [0.0_f64; 3];
    for _ in 0..2000 {
        let (h, a) = (gradient(random.deformation()), random.vector().normalize().to_array());
        let found = differences(&short::<f64>(&h, a), &long(&h, a));
        worst = std::array::from_fn(|i| worst[i].max(found[i] / ALL_MODULI));
    }
    println!("short ways: {:?} of the moduli", worst.map(|worst| format!("{worst:.1e}")));
    assert!(worst.iter().all(|&worst| worst < 2e-12), "{worst:?}");
}

/// Without rotation every term that does not cancel exactly is of the size of ∇u, so that rounding is in proportion to
/// it: 30 roundings of terms up to M |∇u|, half an eps each, where strains stay below a tenth. ∇u has f32's numbers in
/// both precisions.
#[test]
fn small_strains_keep_their_digits_in_f32() {
    let mut random = Random(12);
    for size in [1e-9, 1e-7, 1e-5, 1e-3, 1e-1] {
        let mut worst = [0.0_f64; 3];
        for _ in 0..500 {
            let h = Mat3([(); 3].map(|()| (random.vector() * size).as_vec3().to_array()));
            let exact = Mat3(h.0.map(|row| row.map(f64::from)));
            let a = random.vector().normalize().as_vec3();
            let expected = long(&exact, a.to_array().map(f64::from));
            let found = differences(&short::<f32>(&h, a.to_array()), &expected);
            worst = std::array::from_fn(|i| worst[i].max(found[i] / (ALL_MODULI * size)));
        }
        let roundings = worst.map(|worst| worst / f64::from(f32::EPSILON));
        println!("strains of {size:.0e}: {roundings:.1?} eps M of the strain");
        assert!(roundings.iter().all(|&roundings| roundings < 15.0), "{size:e}: {roundings:?}");
    }
}

/// Flat and inside out there is no right stress; it must be finite.
#[test]
fn short_ways_stay_finite_when_elements_are_flat_or_inside_out() {
    let mut random = Random(13);
    for _ in 0..500 {
        let mut f = random.matrix() * 2.0;
        if random.number() > 0.0 {
            f.z_axis = f.x_axis - f.y_axis;
        }
        let a = random.vector().normalize().as_vec3();
        let Found(isochoric, relaxed, at_once) = short::<f32>(&gradient(f), a.to_array());
        let all = isochoric.0.iter().chain(relaxed.0.as_flattened()).chain(at_once.0.as_flattened());
        assert!(all.into_iter().all(|number| number.is_finite()), "{f}");
    }
}
