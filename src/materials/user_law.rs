//! A law of the user's own, from one WGSL file.

use super::program::Program;
use super::{Elastic, Kinematics};
use crate::math::{Real, Sym3};
use bevy_ecs::component::Component;
use std::fmt;
use std::sync::{Mutex, PoisonError};

/// A law that somebody wrote as one WGSL file: the GPU runs the text as it stands, the CPU runs it as [`Program`]s.
#[derive(Component, Clone, Copy)]
pub struct UserLaw<T: Send + Sync + 'static> {
    law: &'static LawPrograms,
    /// Any number of the kind that the law is over.
    like: T,
}

/// What a [`UserLaw`] is made of, its parameters put in.
#[derive(Clone, Debug)]
pub struct LawPrograms {
    /// The file, as messages name it.
    pub path: String,
    /// Its text.
    pub text: String,
    /// The bytes of `var<uniform> elastic`; empty for a law without parameters.
    pub uniform: Vec<u8>,
    /// `elastic_isochoric`.
    pub isochoric: Program,
    /// `elastic_pressure`.
    pub pressure: Program,
    /// `elastic_isochoric_energy`.
    pub isochoric_energy: Program,
    /// `elastic_volumetric_energy`.
    pub volumetric_energy: Program,
    /// Shear and bulk modulus (Pa) at small strains.
    pub moduli: [f64; 2],
}

impl LawPrograms {
    /// Runs [`isochoric`](Self::isochoric) (Pa).
    #[inline(always)]
    pub fn isochoric_stress<R: Real>(&self, k: &Kinematics<R>) -> Sym3<R> {
        Sym3(self.isochoric.run(numbers(k)))
    }

    /// Runs [`pressure`](Self::pressure) (Pa).
    #[inline(always)]
    pub fn pressure_at<R: Real>(&self, volume_change: R) -> R {
        self.pressure.run::<R, 1, 1>([volume_change])[0]
    }

    /// Runs [`isochoric_energy`](Self::isochoric_energy) (J/m³).
    #[inline(always)]
    pub fn isochoric_energy_at<R: Real>(&self, k: &Kinematics<R>) -> R {
        self.isochoric_energy.run::<R, 16, 1>(numbers(k))[0]
    }

    /// Runs [`volumetric_energy`](Self::volumetric_energy) (J/m³).
    #[inline(always)]
    pub fn volumetric_energy_at<R: Real>(&self, volume_change: R) -> R {
        self.volumetric_energy.run::<R, 1, 1>([volume_change])[0]
    }

    fn is(&self, other: &Self) -> bool {
        // what is made from the same text and numbers is the same
        (&self.path, &self.text, &self.uniform) == (&other.path, &other.text, &other.uniform)
            && self.isochoric.is(&other.isochoric)
            && self.pressure.is(&other.pressure)
            && self.isochoric_energy.is(&other.isochoric_energy)
            && self.volumetric_energy.is(&other.volumetric_energy)
    }
}

/// Laws are kept for as long as the program runs, each once: kernels pass them around like numbers.
static KEPT: Mutex<Vec<&'static LawPrograms>> = Mutex::new(Vec::new());

impl UserLaw<f64> {
    /// A law from its parts.
    pub fn new(law: LawPrograms) -> Self {
        let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
        let found = kept.iter().find(|known| known.is(&law)).copied();
        let law = found.unwrap_or_else(|| {
            let law: &'static LawPrograms = Box::leak(Box::new(law));
            kept.push(law);
            law
        });
        Self { law, like: 0.0 }
    }
}

impl<T: Send + Sync + 'static> UserLaw<T> {
    /// What it is made of.
    pub fn parts(&self) -> &'static LawPrograms {
        self.law
    }
}

impl<T: Send + Sync + 'static> fmt::Debug for UserLaw<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "UserLaw({})", self.law.path)
    }
}

/// The numbers of `Kinematics` in the order of its WGSL twin.
#[inline(always)]
fn numbers<R: Real>(k: &Kinematics<R>) -> [R; 16] {
    let (e, a) = (&k.green_strain.0, &k.adjugate_c.0);
    let rest = [k.volume_change, k.j, k.true_j, k.j_m23];
    let mut numbers = [k.j; 16];
    numbers[..6].copy_from_slice(e);
    numbers[6..12].copy_from_slice(a);
    numbers[12..].copy_from_slice(&rest);
    numbers
}

impl<R: Real> Elastic<R> for UserLaw<R> {
    type Of<Q: Real> = UserLaw<Q>;

    #[inline(always)]
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> UserLaw<Q> {
        UserLaw { law: self.law, like: number(self.like) }
    }

    #[inline(always)]
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
        self.law.isochoric_stress(k)
    }

    #[inline(always)]
    fn pressure(&self, theta: R) -> R {
        self.law.pressure_at(theta)
    }

    #[inline(always)]
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
        self.law.isochoric_energy_at(k)
    }

    #[inline(always)]
    fn volumetric_energy(&self, theta: R) -> R {
        self.law.volumetric_energy_at(theta)
    }

    fn small_strain_moduli(&self) -> [R; 2] {
        self.law.moduli.map(|modulus| self.like.constant(modulus))
    }
}
