//! Every law with plausible moduli.

use super::{BULK, ETA, Law, SHEAR};
use glam::{DMat3, DVec3};
use sinew::materials::{self, Elastic, ExponentialFibre, Kinematics};
use sinew::math::{Mat3, Real, Sym3};

/// λ and 2μ at small strains.
fn hooke(shear: f64) -> (f64, f64, f64) {
    (BULK - 2.0 / 3.0 * shear, 2.0 * shear, 0.0)
}

macro_rules! elastic {
    ($($name:ident: $law:expr, $shear:expr;)*) => {$(
        pub struct $name;

        impl $name {
            pub fn law() -> materials::$name<f64> {
                $law
            }

            fn of<R: Real>(like: R) -> materials::$name<R> {
                Self::law().map(|modulus| like.constant(modulus))
            }
        }

        impl Law for $name {
            fn kinematics<R: Real>(gradient: &Mat3<R>) -> Kinematics<R> {
                Self::of(gradient.0[0][0]).kinematics(gradient)
            }
            fn first_stress<R: Real>(gradient: &Mat3<R>, _: [R; 3]) -> Mat3<R> {
                let law = Self::of(gradient.0[0][0]);
                let k = law.kinematics(gradient);
                law.first_stress(gradient, &k, &law.isochoric(&k), law.pressure(law.volume_measure(&k)))
            }
            fn stress<R: Real>(k: &Kinematics<R>, _: [R; 3]) -> Sym3<R> {
                let law = Self::of(k.j);
                let pressure = law.pressure(law.volume_measure(k));
                law.isochoric(k).plus(&law.volumetric(k, pressure))
            }
            fn energy<R: Real>(k: &Kinematics<R>, _: [R; 3]) -> R {
                let law = Self::of(k.j);
                let theta = law.volume_measure(k);
                law.isochoric_energy(k) + law.volumetric_energy(theta)
            }
            // from the sources' formulas, not from the law's own
            fn small() -> (f64, f64, f64) {
                hooke($shear)
            }
        }
    )*};
}

/// λ_m.
pub const LOCKING: f64 = 1.6;
/// μ and α of Ogden's terms; the shape of his fit to rubber.
pub const OGDEN: [(f64, f64); 3] = [(1400.0, 1.3), (3.0, 5.0), (-30.0, -2.0)];

elastic! {
    Linear: materials::Linear { shear: SHEAR, bulk: BULK }, SHEAR;
    StVenantKirchhoff: materials::StVenantKirchhoff { shear: SHEAR, bulk: BULK }, SHEAR;
    Corotational: materials::Corotational { shear: SHEAR, bulk: BULK }, SHEAR;
    NeoHookean: materials::NeoHookean { shear: SHEAR, bulk: BULK }, SHEAR;
    StableNeoHookean: materials::StableNeoHookean { shear: SHEAR, bulk: BULK }, SHEAR;
    MooneyRivlin: materials::MooneyRivlin { c10: 300.0, c01: 200.0, bulk: BULK }, 2.0 * (300.0 + 200.0);
    Ogden: materials::Ogden::new(&OGDEN, BULK), 0.5 * (1400.0 * 1.3 + 3.0 * 5.0 + 30.0 * 2.0);
    ArrudaBoyce: materials::ArrudaBoyce { shear: 600.0, locking_stretch: LOCKING, bulk: BULK },
        600.0 * (1.0 + 3.0 / (5.0 * LOCKING.powi(2)) + 99.0 / (175.0 * LOCKING.powi(4))
            + 513.0 / (875.0 * LOCKING.powi(6)) + 42039.0 / (67375.0 * LOCKING.powi(8)));
}

macro_rules! fibres {
    ($($name:ident: $law:expr, $eta:expr, $strain:expr;)*) => {$(
        pub struct $name;

        impl Law for $name {
            fn stress<R: Real>(k: &Kinematics<R>, a: [R; 3]) -> Sym3<R> {
                $law.map(|modulus| k.j.constant(modulus)).isochoric(k, a)
            }
            fn energy<R: Real>(k: &Kinematics<R>, a: [R; 3]) -> R {
                $law.map(|modulus| k.j.constant(modulus)).energy(k, a)
            }
            fn small() -> (f64, f64, f64) {
                (0.0, 0.0, 4.0 * $eta)
            }
            fn kink(f: DMat3, a: DVec3) -> f64 {
                $strain(f, a)
            }
        }
    )*};
}

/// Ī₄ − 1.
fn stretched(f: DMat3, a: DVec3) -> f64 {
    (f * a).length_squared() * f.determinant().powf(-2.0 / 3.0) - 1.0
}

/// Ē for a dispersion of 0.2.
fn stretched_on_average(f: DMat3, a: DVec3) -> f64 {
    let c = f.transpose() * f;
    let i1 = (c.x_axis.x + c.y_axis.y + c.z_axis.z) * f.determinant().powf(-2.0 / 3.0);
    0.2 * (i1 - 3.0) + 0.4 * stretched(f, a)
}

const GROWING: ExponentialFibre<f64> = ExponentialFibre { k1: ETA, k2: 0.1, dispersion: 0.0, tension_only: 1.0 };

fibres! {
    FibresBothWays: materials::Fibres { eta: ETA, tension_only: 0.0 }, ETA, |_, _| 1.0;
    FibresTensionOnly: materials::Fibres { eta: ETA, tension_only: 1.0 }, ETA, stretched;
    ExponentialFibres: GROWING, ETA, stretched;
    DispersedExponentialFibres: ExponentialFibre { k2: 0.7, dispersion: 0.2, ..GROWING },
        ETA * 0.4 * 0.4, stretched_on_average;
}
