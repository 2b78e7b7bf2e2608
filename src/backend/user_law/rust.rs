//! Laws of the user's own in Rust.

use super::comparison::largest;
use super::{About, Complaint, Read, checks, deformations};
use crate::backend::cpu::OwnKernels;
use crate::materials::program::{RecordedLaw, Untranslatable, record};
use crate::materials::{Elastic, IsochoricStress, LawPrograms, RustLaw, UserLaw};
use serde::de::Deserialize;
use serde::de::value::{Error, MapDeserializer};
use std::collections::BTreeMap;

/// A law in Rust by the name that scenes have for it.
#[derive(Clone, Debug)]
pub struct NamedLaw {
    /// The name.
    pub name: String,
    read: ReadLaw,
}

type ReadLaw = fn(&str, &BTreeMap<String, f64>) -> Result<Read, Vec<Complaint>>;

impl NamedLaw {
    /// Names a law.
    pub fn of<L: RustLaw>(name: impl Into<String>) -> Self {
        Self { name: name.into(), read: read::<L> }
    }

    /// The law with the parameters that a scene gives.
    ///
    /// # Errors
    /// What is wrong with the parameters, what of the law cannot be recorded; if they are sound, what is wrong with the
    /// law itself.
    pub fn read(&self, parameters: &BTreeMap<String, f64>) -> Result<Read, Vec<Complaint>> {
        (self.read)(&self.name, parameters)
    }
}

/// How far stresses of a law may be from those of its recording, in parts of them: both are in f64, and are sums of the
/// same terms with other roundings.
const ALIKE: f64 = 1e-9;

fn read<L: RustLaw>(name: &str, parameters: &BTreeMap<String, f64>) -> Result<Read, Vec<Complaint>> {
    let wrong = |message: String| vec![Complaint::new(About::Parameters, message)];
    let numbers = MapDeserializer::<_, Error>::new(parameters.iter().map(|(name, number)| (name.as_str(), *number)));
    let parameters = L::Parameters::deserialize(numbers).map_err(|error| wrong(error.to_string()))?;
    let law = L::of(parameters).map_err(wrong)?;
    let RecordedLaw { isochoric, pressure, isochoric_energy, volumetric_energy, wgsl } =
        record(&law).map_err(|Untranslatable { message, notes, .. }| {
            let message = format!("the law `{name}` cannot be recorded: {message}");
            vec![Complaint { notes, ..Complaint::new(About::File, message) }]
        })?;
    let programs = LawPrograms {
        path: format!("law {name}"),
        text: wgsl,
        uniform: Vec::new(),
        isochoric: IsochoricStress::Whole(isochoric),
        pressure,
        isochoric_energy,
        volumetric_energy,
        moduli: [0.0; 2],
    };
    let (findings, warnings) = checks::check(&programs, &checks::Told::rust())?;
    let moduli = [findings.shear, findings.bulk];
    let recorded = UserLaw::new(LawPrograms { moduli, ..programs });
    alike(name, &law, &recorded, findings.finite_up_to)?;
    let own_kernels = Some(OwnKernels::of(law.map(|number| number as f32), law));
    Ok(Read { law: recorded, built_in: None, own_kernels, findings, warnings })
}

/// Kernels may take shorter ways to a stress, which a law can have of its own: they must lead to the same.
fn alike<L: RustLaw>(
    name: &str,
    law: &L,
    recorded: &UserLaw<f64>,
    finite_up_to: Option<f64>,
) -> Result<(), Vec<Complaint>> {
    let all = deformations::all();
    for deformation in all.iter().filter(|d| finite_up_to.is_none_or(|limit| d.size < limit)) {
        let (own, _) = law.direct_stress(&deformation.gradient, None, None);
        let (expected, _) = recorded.direct_stress(&deformation.gradient, None, None);
        let [own, expected] = [own, expected].map(|stress| stress.0);
        let mut differences = [0.0; 9];
        for (difference, (a, b)) in differences.iter_mut().zip(own.as_flattened().iter().zip(expected.as_flattened())) {
            *difference = a - b;
        }
        let size = largest(expected.as_flattened());
        let apart = largest(&differences) / size;
        if apart.is_nan() || apart > ALIKE {
            let message =
                format!("the law `{name}` has a shorter way to its stress that leads elsewhere: by {apart:.1e} of it");
            return Err(vec![Complaint::new(About::File, message).note(
                "`first_stress`, `direct_stress` and `stress_relaxed` must be what they are without being written",
            )]);
        }
    }
    let shown = |[shear, bulk]: [f64; 2]| format!("{shear:.6e} and {bulk:.6e} Pa");
    let (told, found) = (law.small_strain_moduli(), recorded.small_strain_moduli());
    if told.iter().zip(found).all(|(told, found)| (told - found).abs() <= 1e-4 * found) {
        return Ok(());
    }
    let message = format!("`small_strain_moduli` of the law `{name}` are {}", shown(told));
    Err(vec![Complaint::new(About::File, message).note(format!("its stresses say {}", shown(found)))])
}
