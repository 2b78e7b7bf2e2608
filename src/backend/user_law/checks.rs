//! Whether what has the form of a law is one: finite, without stress at rest, isotropic and stiff at small strains, and
//! with stresses that are the derivatives of its energies.

use super::comparison::{Comparison, largest};
use super::deformations::{self, Deformation, shown};
use super::form::{ENERGY, OF_LAWS};
use super::names::declared;
use super::{About, Complaint};
use crate::materials::{Kinematics, LawPrograms};
use crate::math::{Mat3, Real, Scalar, Sym3};
use bevy_ecs::component::Component;

/// What was found of a law when it was tried.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct LawCheck {
    /// Shear modulus at small strains (Pa).
    pub shear: f64,
    /// Bulk modulus at small strains (Pa).
    pub bulk: f64,
    /// How far stresses are from the derivatives of the energies, relative to the stresses.
    pub derivative_error: f64,
    /// Largest error of a stress in f32 at strains around 1e-4, relative to it.
    pub single_precision_error: f64,
    /// Largest error of an energy in f32 there, relative to it.
    pub single_precision_energy_error: f64,
    /// Deformations tried.
    pub tried: usize,
    /// The size of ∇u up to which the law was finite in all of them; none where it was everywhere.
    pub finite_up_to: Option<f64>,
}

/// Every law must be finite up to here.
const MUST_BE_FINITE: f64 = 0.01;
/// Stress at rest that is allowed, in parts of the moduli.
const REST: f64 = 1e-9;
/// Volume changes that pressures are tried at.
const CHANGES: [f64; 9] = [-0.3, -0.1, -0.03, -0.01, 0.003, 0.01, 0.03, 0.1, 0.3];

/// What messages call the four parts of a law, and where they mark them.
pub(super) struct Told {
    parts: [(String, About); 4],
    /// What to write in place of differences that lose digits.
    exact: &'static str,
    /// What they call the change of volume.
    volume: &'static str,
    /// What makes a law isotropic.
    isotropic: &'static str,
}

impl Told {
    /// Of a text with all four functions.
    pub(super) fn law(text: &str) -> Self {
        Self {
            parts: OF_LAWS.map(|(name, ..)| (format!("`{name}`"), place(text, name))),
            exact: "compute from `k.green_strain` and `k.volume_change`, which are exact for small strains",
            volume: "volume_change",
            isotropic: "use the strains in `k` as a whole, by sym_trace and sym_times_coaxial; directions come with a \
                        material's `fibres`",
        }
    }

    /// Of a text with an energy.
    pub(super) fn energy(text: &str) -> Self {
        Self::derived(&place(text, ENERGY))
    }

    /// Of a formula.
    pub(super) fn formula() -> Self {
        Self::derived(&About::File)
    }

    /// Of a law in Rust.
    pub(super) fn rust() -> Self {
        Self {
            parts: ["isochoric", "pressure", "isochoric_energy", "volumetric_energy"]
                .map(|name| (format!("`{name}`"), About::File)),
            exact: "compute from `k.green_strain` and `k.volume_change`, which are exact for small strains",
            volume: "theta",
            isotropic: "use the strains in `k` as a whole; directions come with a material's `fibres`",
        }
    }

    fn derived(about: &About) -> Self {
        let parts =
            ["the energy's isochoric stress", "the energy's pressure", "the isochoric energy", "the volumetric energy"];
        Self {
            parts: parts.map(|part| (part.to_owned(), about.clone())),
            exact: "compute from `I1bar_minus_3`, `I2bar_minus_3` and `J_minus_1`, which are exact for small strains",
            volume: "J_minus_1",
            isotropic: "the slopes of the energy at rest must be finite, and the same on all sides",
        }
    }
}

/// Where a text declares a function.
fn place(text: &str, name: &str) -> About {
    declared(text).into_iter().find(|d| d.name == name).map_or(About::File, |d| About::Bytes(d.at))
}

/// Tries a law.
pub(super) fn check(law: &LawPrograms, told: &Told) -> Result<(LawCheck, Vec<Complaint>), Vec<Complaint>> {
    let trial = Trial { law, told };
    let deformations = deformations::all();
    let finite_up_to = trial.finite(&deformations)?;
    let [shear, bulk] = trial.moduli()?;
    let within: Vec<&Deformation> =
        deformations.iter().filter(|d| finite_up_to.is_none_or(|limit| d.size < limit)).collect();
    let (isochoric, volumetric) = (trial.isochoric_derivative(&within, shear), trial.volumetric_derivative(bulk));
    let mut complaints = Vec::new();
    let mut derivative_error: f64 = 0.0;
    for outcome in [isochoric, volumetric] {
        match outcome {
            Ok(error) => derivative_error = derivative_error.max(error),
            Err(complaint) => complaints.push(*complaint),
        }
    }
    if !complaints.is_empty() {
        return Err(complaints);
    }
    let [single_precision_error, single_precision_energy_error] = trial.single_precision_errors();
    let tried = deformations.len();
    let findings = LawCheck {
        shear,
        bulk,
        derivative_error,
        single_precision_error,
        single_precision_energy_error,
        tried,
        finite_up_to,
    };
    Ok((findings, trial.warnings(&within, &findings)))
}

struct Trial<'a> {
    law: &'a LawPrograms,
    told: &'a Told,
}

fn inner(a: &Sym3<f64>, b: &Sym3<f64>) -> f64 {
    (0..6).map(|i| a.0[i] * b.0[i] * if i < 3 { 1.0 } else { 2.0 }).sum()
}

impl Trial<'_> {
    /// A complaint about one of the four parts.
    fn about(&self, part: usize, message: String) -> Complaint {
        Complaint::new(self.told.parts[part].1.clone(), message)
    }

    /// What messages call one of them.
    fn name(&self, part: usize) -> &str {
        &self.told.parts[part].0
    }

    /// The second Piola-Kirchhoff stress as a whole (Pa).
    fn stress(&self, gradient: &Mat3<f64>) -> Sym3<f64> {
        let k = Kinematics::new(gradient);
        let pressure = self.law.pressure_at(k.volume_change);
        self.law.isochoric_stress(&k).plus(&k.adjugate_c.scaled(pressure / k.j))
    }

    /// The size of deformation from which on the law is not finite everywhere.
    fn finite(&self, deformations: &[Deformation]) -> Result<Option<f64>, Vec<Complaint>> {
        let rest = Deformation { size: 0.0, gradient: Mat3([[0.0; 3]; 3]), plain: true };
        for deformation in std::iter::once(&rest).chain(deformations) {
            let k = Kinematics::new(&deformation.gradient);
            let (law, change) = (self.law, k.volume_change);
            let stress = law.isochoric_stress(&k).0;
            let numbers = [
                largest(&stress),
                law.pressure_at(change),
                law.isochoric_energy_at(&k),
                law.volumetric_energy_at(change),
            ];
            let Some(function) = numbers.iter().position(|number| !number.is_finite()) else { continue };
            if deformation.size > MUST_BE_FINITE {
                return Ok(Some(deformation.size));
            }
            let at = match deformation.size {
                0.0 => "at rest".to_owned(),
                _ => format!("at {}", shown(&deformation.gradient)),
            };
            let message = format!("{} is {} {at}", self.name(function), numbers[function]);
            return Err(vec![self.about(function, message).note(
                "a law must be finite at rest and around it: 0/0 and ln 0 there need a series or another form",
            )]);
        }
        Ok(None)
    }

    /// Shear and bulk modulus (Pa), from the law's own tangent at rest.
    fn moduli(&self) -> Result<[f64; 2], Vec<Complaint>> {
        const STEP: f64 = 1e-6;
        let tangent = |strain: [f64; 6]| {
            let [xx, yy, zz, xy, yz, xz] = strain.map(|e| e * STEP);
            let gradient = Mat3([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
            let (ahead, behind) = (self.stress(&gradient), self.stress(&gradient.scaled(-1.0)));
            std::array::from_fn::<f64, 6, _>(|i| (ahead.0[i] - behind.0[i]) / (2.0 * STEP))
        };
        let volume = tangent([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
        let bulk = (volume[0] + volume[1] + volume[2]) / 9.0;
        let shears: [f64; 3] = std::array::from_fn(|i| {
            let mut strain = [0.0; 6];
            strain[3 + i] = 1.0;
            tangent(strain)[3 + i] / 2.0
        });
        let shear = shears.iter().sum::<f64>() / 3.0;
        let scale = shear.abs() + bulk.abs();
        // first: a pressure at rest would look like a modulus
        let (rest, pressure) = (self.stress(&Mat3([[0.0; 3]; 3])), self.law.pressure_at(0.0));
        if largest(&rest.0) > REST * scale {
            let function = usize::from(pressure.abs() > REST * scale);
            let message = format!("{} is not 0 at rest: {:.4e} Pa", self.name(function), largest(&rest.0));
            return Err(vec![self.about(function, message).note("an undeformed body has no stress")]);
        }
        for (function, name, modulus) in [(0, "shear", shear), (1, "bulk", bulk)] {
            if modulus.is_nan() || modulus <= 1e-12 * scale {
                let message = format!("the {name} modulus at small strains is {modulus:.4} Pa: it must be above 0");
                return Err(vec![self.about(function, message).note(match function {
                    0 => "2 μ is what the stress grows by with the shear strain at rest".to_owned(),
                    _ => format!("κ is what the pressure grows by with `{}` at rest", self.told.volume),
                })]);
            }
        }
        for strain in [[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.3, 0.0, 0.0], [0.2, 0.0, -1.0, 0.0, 0.5, 0.7]]
        {
            let (found, trace) = (tangent(strain), strain[0] + strain[1] + strain[2]);
            let spherical = (bulk - 2.0 / 3.0 * shear) * trace;
            let error: [f64; 6] =
                std::array::from_fn(|i| found[i] - 2.0 * shear * strain[i] - if i < 3 { spherical } else { 0.0 });
            if largest(&error) > 1e-4 * scale {
                let moduli = shears.map(|shear| format!("{shear:.4}")).join(", ");
                let message = format!("the law is not isotropic: its shear moduli in xy, yz, xz are {moduli} Pa");
                return Err(vec![self.about(0, message).note(self.told.isotropic)]);
            }
        }
        Ok([shear, bulk])
    }

    /// Compares F S_iso with ∂Ψ_iso/∂F.
    fn isochoric_derivative(&self, deformations: &[&Deformation], shear: f64) -> Result<f64, Box<Complaint>> {
        const STEP: f64 = 1e-5;
        let energy = |gradient: &Mat3<f64>| self.law.isochoric_energy_at(&Kinematics::new(gradient));
        let mut comparison = Comparison::default();
        for Deformation { size, gradient, .. } in deformations {
            let stress = gradient.plus_identity_times(&self.law.isochoric_stress(&Kinematics::new(gradient)));
            let mut derivative = Mat3([[0.0; 3]; 3]);
            for i in 0..3 {
                for j in 0..3 {
                    let moved = |by: f64| {
                        let mut gradient = *gradient;
                        gradient.0[i][j] += by;
                        energy(&gradient)
                    };
                    derivative.0[i][j] = (moved(STEP) - moved(-STEP)) / (2.0 * STEP);
                }
            }
            let (stress, derivative) = (stress.0.as_flattened(), derivative.0.as_flattened());
            comparison.add(stress, derivative, shear * size, || shown(gradient));
        }
        comparison.outcome(|what| {
            self.about(0, format!("{} is not the derivative of {}: {what}", self.name(0), self.name(2)))
        })
    }

    /// Compares U'(θ) with the derivative of U(θ).
    fn volumetric_derivative(&self, bulk: f64) -> Result<f64, Box<Complaint>> {
        const STEP: f64 = 1e-5;
        let energy = |change: f64| self.law.volumetric_energy_at(change);
        let mut comparison = Comparison::default();
        for change in CHANGES {
            let derivative = (energy(change + STEP) - energy(change - STEP)) / (2.0 * STEP);
            let pressure = self.law.pressure_at(change);
            // where the law ends is told elsewhere
            if derivative.is_finite() && pressure.is_finite() {
                let at = || format!("{} = {change}", self.told.volume);
                comparison.add(&[pressure], &[derivative], bulk * change.abs(), at);
            }
        }
        comparison.outcome(|what| {
            self.about(1, format!("{} is not the derivative of {}: {what}", self.name(1), self.name(3)))
        })
    }

    /// Largest relative errors of stresses and of energies in f32 at strains around 1e-4.
    fn single_precision_errors(&self) -> [f64; 2] {
        let (mut worst, mut of_energies): (f64, f64) = (0.0, 0.0);
        for deformation in deformations::all().iter().filter(|d| d.size <= 1e-3 && !d.plain) {
            let single = Mat3(deformation.gradient.0.map(|row| row.map(|x| f32::from_f64(x * 0.1))));
            let double = Mat3(single.0.map(|row| row.map(Scalar::to_f64)));
            let (k, exact) = (Kinematics::new(&single), Kinematics::new(&double));
            let found = self.law.isochoric_stress(&k).0.map(f64::from);
            let expected = self.law.isochoric_stress(&exact).0;
            let error: [f64; 6] = std::array::from_fn(|i| found[i] - expected[i]);
            let pressure = self.law.pressure_at(exact.volume_change);
            let pressure_error = f64::from(self.law.pressure_at(k.volume_change)) - pressure;
            worst = worst
                .max(largest(&error) / largest(&expected))
                .max(pressure_error.abs() / pressure.abs().max(Real::abs(expected[0])));
            let exact = self.law.isochoric_energy_at(&exact) + self.law.volumetric_energy_at(exact.volume_change);
            let found = self.law.isochoric_energy_at(&k) + self.law.volumetric_energy_at(k.volume_change);
            of_energies = of_energies.max((f64::from(found) - exact).abs() / exact.abs());
        }
        [worst, of_energies]
    }

    fn warnings(&self, deformations: &[&Deformation], findings: &LawCheck) -> Vec<Complaint> {
        let mut warnings = Vec::new();
        let mut warn = |complaint: Complaint| warnings.push(Complaint { warning: true, ..complaint });
        let note = format!("differences of large numbers, such as Ī₁ − 3, lose them: {}", self.told.exact);
        if findings.single_precision_error > 1e-2 {
            let message = format!(
                "in f32 the stress errs by {:.1} % at strains of 1e-4: digits are lost",
                100.0 * findings.single_precision_error
            );
            warn(self.about(0, message).note(note.clone()));
        }
        if findings.single_precision_energy_error > 1e-2 {
            let message = format!(
                "in f32 the energy errs by {:.1} % at strains of 1e-4: digits are lost",
                100.0 * findings.single_precision_energy_error
            );
            let note = format!("the guards compare it with the work done: they may stop a sound run; {note}");
            warn(self.about(2, message).note(note));
        }
        let share = |d: &&Deformation| {
            let k = Kinematics::new(&d.gradient);
            let (stress, e) = (self.law.isochoric_stress(&k), k.green_strain.0);
            let c = Sym3([1.0 + 2.0 * e[0], 1.0 + 2.0 * e[1], 1.0 + 2.0 * e[2], 2.0 * e[3], 2.0 * e[4], 2.0 * e[5]]);
            let size = (inner(&stress, &stress) * inner(&c, &c)).sqrt();
            // what rounding leaves of none has any direction
            if size > 1e-9 * findings.shear * d.size { (inner(&stress, &c) / size).abs() } else { 0.0 }
        };
        let share = deformations.iter().map(share).fold(0.0, f64::max);
        if share > 1e-6 {
            let message = format!("{} has a pressure in it: up to {share:.2} of the stress", self.name(0));
            warn(self.about(0, message).note(
                "elements that average the pressure, and viscosity, take it for a part of the isochoric stress: give it \
                 by `elastic_pressure`",
            ));
        }
        warnings
    }
}
