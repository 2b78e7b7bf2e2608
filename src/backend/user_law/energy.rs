//! Laws of the user's own from an energy: a WGSL function, or a formula in the scene.

use super::form::{ENERGY, Form, OF_LAWS};
use super::names::declared;
use super::reading::Reading;
use super::{Complaint, Read, checks, formula};
use crate::materials::{ElasticLaw, EnergySlopes, IsochoricStress, LawPrograms, MooneyRivlin, NeoHookean, UserLaw};
use std::collections::BTreeMap;

/// How far a modulus from derivatives may be from the same by differences, relative to it: it is the better one unless
/// the energy has a kink at rest.
const ALIKE: f64 = 1e-4;

/// Whether a law's text has its energy alone.
pub(super) fn is_one(text: &str) -> bool {
    let declared = declared(text);
    let has = |name: &str| declared.iter().any(|d| d.kind == "fn" && d.name == name);
    has(ENERGY) && !OF_LAWS.iter().any(|(name, ..)| has(name))
}

/// Reads the law of a text that has its energy.
pub(super) fn read(
    path: &str,
    text: &str,
    parameters: &BTreeMap<String, f64>,
    told: &checks::Told,
) -> Result<Read, Vec<Complaint>> {
    let reading = Reading::of(&Form::energy(), path, text, parameters)?;
    let derived = reading.derived(ENERGY)?;
    let built_in = derived.constants.map(built_in);
    let law = LawPrograms {
        path: path.to_owned(),
        isochoric: IsochoricStress::Slopes(Box::new(EnergySlopes::of(&derived))),
        pressure: derived.pressure,
        isochoric_energy: derived.isochoric_energy,
        volumetric_energy: derived.volumetric_energy,
        text: derived.wgsl,
        moduli: [0.0; 2],
        // the parameters stand in the text
        uniform: Vec::new(),
    };
    let (mut findings, warnings) = checks::check(&law, told)?;
    let moduli = [(derived.moduli[0], findings.shear), (derived.moduli[1], findings.bulk)].map(|(derived, found)| {
        match derived > 0.0 && (derived - found).abs() <= ALIKE * found {
            true => derived,
            false => found,
        }
    });
    [findings.shear, findings.bulk] = moduli;
    Ok(Read { law: UserLaw::new(LawPrograms { moduli, ..law }), built_in, own_kernels: None, findings, warnings })
}

/// The built-in law whose derivatives are constants.
fn built_in([c10, c01, bulk]: [f64; 3]) -> ElasticLaw<f64> {
    match c01 {
        0.0 => ElasticLaw::NeoHookean(NeoHookean { shear: 2.0 * c10, bulk }),
        _ => ElasticLaw::MooneyRivlin(MooneyRivlin { c10, c01, bulk }),
    }
}

/// Reads a law from a formula of its energy (J/m³) and its parameters. Places in complaints are bytes of the formula.
///
/// # Errors
/// All that is wrong with the formula, or with the parameters; if they are sound, with the law itself.
pub fn read_formula(energy: &str, parameters: &BTreeMap<String, f64>) -> Result<Read, Vec<Complaint>> {
    let wrapped = formula::wrap(energy, parameters)?;
    let led_back = |told: Vec<Complaint>| -> Vec<Complaint> { told.into_iter().map(|c| wrapped.led_back(c)).collect() };
    read("energy", &wrapped.text, &wrapped.parameters, &checks::Told::formula()).map_err(led_back)
}
