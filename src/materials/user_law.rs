//! A law of the user's own: from one WGSL file, or from an energy.

use super::program::{DerivedLaw, Program};
use super::{Elastic, Kinematics};
use crate::math::{Real, Sym3};
use bevy_ecs::component::Component;
use std::fmt;
use std::sync::{Mutex, PoisonError};

/// A law that somebody wrote as one WGSL file: the GPU runs the text as it stands, the CPU runs it as [`Program`]s. Of
/// an energy the GPU runs the WGSL that was derived from it, the CPU its derivatives by the invariants as programs, and
/// compiled code around them.
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
    /// The text that a GPU runs.
    pub text: String,
    /// The bytes of `var<uniform> elastic`; empty for a law without parameters.
    pub uniform: Vec<u8>,
    /// S_iso.
    pub isochoric: IsochoricStress,
    /// `elastic_pressure`.
    pub pressure: Program,
    /// `elastic_isochoric_energy`, of `Kinematics`; of an energy, of Ī₁ − 3 and Ī₂ − 3.
    pub isochoric_energy: Program,
    /// `elastic_volumetric_energy`.
    pub volumetric_energy: Program,
    /// Shear and bulk modulus (Pa) at small strains.
    pub moduli: [f64; 2],
}

/// How a law's S_iso is found.
#[derive(Clone, Debug)]
pub enum IsochoricStress {
    /// By `elastic_isochoric`.
    Whole(Program),
    /// From the derivatives of an energy by its invariants.
    Slopes(Box<EnergySlopes>),
}

/// The derivatives of an energy by its invariants.
#[derive(Clone, Debug)]
pub struct EnergySlopes {
    /// ∂Ψ/∂Ī₁ and ∂Ψ/∂Ī₂ (Pa) of Ī₁ − 3 and Ī₂ − 3.
    program: Program,
    /// Their values (Pa), where they are the same at every deformation.
    constant: Option<[f64; 2]>,
    /// Whether they depend on Ī₂.
    depends_on_second: bool,
    /// Whether the energy does.
    has_second: bool,
    /// ∂²Ψ/∂Ī₁², ∂²Ψ/∂Ī₁∂Ī₂ and ∂²Ψ/∂Ī₂² (Pa) of Ī₁ − 3 and Ī₂ − 3.
    curvatures: Program,
    /// U'' (Pa) of J − 1.
    volumetric_stiffness: Program,
}

impl IsochoricStress {
    /// Instructions that the CPU goes through for it at each point, constants, and slots in use at the same time.
    pub fn size(&self) -> (usize, usize, usize) {
        match self {
            Self::Whole(program) => program.size(),
            Self::Slopes(slopes) if slopes.constant.is_some() => (0, 0, 0),
            Self::Slopes(slopes) => slopes.program.size(),
        }
    }
}

impl EnergySlopes {
    /// Of a derived law.
    pub fn of(law: &DerivedLaw) -> Self {
        Self {
            program: law.slopes.clone(),
            constant: (law.depends_on == [false; 2]).then(|| law.slopes.run::<f64, 2, 2>([0.0; 2])),
            depends_on_second: law.depends_on[1],
            has_second: law.has_second,
            curvatures: law.curvatures.clone(),
            volumetric_stiffness: law.volumetric_stiffness.clone(),
        }
    }

    /// ∂²Ψ/∂Ī₁², ∂²Ψ/∂Ī₁∂Ī₂ and ∂²Ψ/∂Ī₂² (Pa).
    pub(super) fn curvatures_at<R: Real>(&self, k: &Kinematics<R>) -> [R; 3] {
        self.curvatures.run([not_below_zero(k.i1_change()), not_below_zero(k.i2_change())])
    }

    /// U'' (Pa).
    pub(super) fn volumetric_stiffness_at<R: Real>(&self, volume_change: R) -> R {
        self.volumetric_stiffness.run::<R, 1, 1>([volume_change])[0]
    }

    /// ∂Ψ/∂Ī₁ and ∂Ψ/∂Ī₂ (Pa).
    #[inline(always)]
    pub(super) fn at<R: Real>(&self, k: &Kinematics<R>) -> [R; 2] {
        if let Some(constant) = self.constant {
            return constant.map(|slope| k.j.constant(slope));
        }
        let second = if self.depends_on_second { not_below_zero(k.i2_change()) } else { k.j.constant(0.0) };
        self.program.run([not_below_zero(k.i1_change()), second])
    }

    /// S_iso (Pa).
    #[inline(always)]
    fn stress<R: Real>(&self, k: &Kinematics<R>) -> Sym3<R> {
        let [first, second] = self.at(k);
        if self.has_second { k.stress_of_slopes(first, second) } else { k.stress_of_slope(first) }
    }
}

/// Ī₁ − 3 or Ī₂ − 3 without what rounding takes below 0, which has no place in a power.
#[inline(always)]
fn not_below_zero<R: Real>(change: R) -> R {
    change.max(change.constant(0.0))
}

impl LawPrograms {
    /// S_iso (Pa).
    #[inline(always)]
    pub fn isochoric_stress<R: Real>(&self, k: &Kinematics<R>) -> Sym3<R> {
        match &self.isochoric {
            IsochoricStress::Whole(program) => Sym3(program.run(numbers(k))),
            IsochoricStress::Slopes(slopes) => slopes.stress(k),
        }
    }

    /// Runs [`pressure`](Self::pressure) (Pa).
    #[inline(always)]
    pub fn pressure_at<R: Real>(&self, volume_change: R) -> R {
        self.pressure.run::<R, 1, 1>([volume_change])[0]
    }

    /// Runs [`isochoric_energy`](Self::isochoric_energy) (J/m³).
    #[inline(always)]
    pub fn isochoric_energy_at<R: Real>(&self, k: &Kinematics<R>) -> R {
        match &self.isochoric {
            IsochoricStress::Whole(_) => self.isochoric_energy.run::<R, 16, 1>(numbers(k))[0],
            IsochoricStress::Slopes(_) => {
                let invariants = [not_below_zero(k.i1_change()), not_below_zero(k.i2_change())];
                self.isochoric_energy.run::<R, 2, 1>(invariants)[0]
            }
        }
    }

    /// Runs [`volumetric_energy`](Self::volumetric_energy) (J/m³).
    #[inline(always)]
    pub fn volumetric_energy_at<R: Real>(&self, volume_change: R) -> R {
        self.volumetric_energy.run::<R, 1, 1>([volume_change])[0]
    }

    fn is(&self, other: &Self) -> bool {
        // what is made from the same text and numbers is the same
        (&self.path, &self.text, &self.uniform) == (&other.path, &other.text, &other.uniform)
            && match (&self.isochoric, &other.isochoric) {
                (IsochoricStress::Whole(a), IsochoricStress::Whole(b)) => a.is(b),
                (IsochoricStress::Slopes(a), IsochoricStress::Slopes(b)) => a.program.is(&b.program),
                _ => false,
            }
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

/// Laws made of the same are the same: see [`UserLaw::new`].
impl<T: Send + Sync + 'static> PartialEq for UserLaw<T> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.law, other.law)
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
