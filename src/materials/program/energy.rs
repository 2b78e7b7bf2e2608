//! Laws from an energy: its derivatives by the invariants, as programs for the CPU and as WGSL for a GPU.

use super::graph::{Binary, Graph, Id};
use super::tape::Program;
use super::translate::{self, MOST_VALUES, Translator};
use super::value::Value;
use super::{ProgramSource, Untranslatable};
use naga::Span;
use std::collections::BTreeMap;

/// What an energy is a function of: the members of `Invariants` in `shaders/invariants.wgsl`, in order.
pub const INVARIANTS: [&str; 6] = ["I1bar_minus_3", "I2bar_minus_3", "J_minus_1", "I1bar", "I2bar", "J"];
/// Those that the others follow from.
const INDEPENDENT: u16 = 3;
/// The number among these of J − 1.
const VOLUME: u16 = 2;
/// J − 1 down to which polynomials keep all digits; Ī₁ − 3 and Ī₂ − 3 are not below 0.
const SQUEEZED: f64 = -0.5;

/// An energy Ψ(Ī₁, Ī₂, J) = Ψ_iso(Ī₁, Ī₂) + U(J), differentiated, its parameters put in. The two parts are 0 at rest.
#[derive(Clone, Debug)]
pub struct DerivedLaw {
    /// ∂Ψ/∂Ī₁ and ∂Ψ/∂Ī₂ (Pa) of Ī₁ − 3 and Ī₂ − 3.
    pub slopes: Program,
    /// ∂²Ψ/∂Ī₁², ∂²Ψ/∂Ī₁∂Ī₂ and ∂²Ψ/∂Ī₂² (Pa) of Ī₁ − 3 and Ī₂ − 3.
    pub curvatures: Program,
    /// Whether the slopes depend on Ī₁, and on Ī₂.
    pub depends_on: [bool; 2],
    /// Whether Ψ depends on Ī₂ at all.
    pub has_second: bool,
    /// U' (Pa) of J − 1.
    pub pressure: Program,
    /// U'' (Pa) of J − 1.
    pub volumetric_stiffness: Program,
    /// Ψ_iso (J/m³) of Ī₁ − 3 and Ī₂ − 3.
    pub isochoric_energy: Program,
    /// U (J/m³) of J − 1.
    pub volumetric_energy: Program,
    /// ∂Ψ/∂Ī₁, ∂Ψ/∂Ī₂ and U'' (Pa), where they are the same at every deformation and U' is 0 at rest.
    pub constants: Option<[f64; 3]>,
    /// Shear and bulk modulus (Pa) at small strains: 2 (∂Ψ/∂Ī₁ + ∂Ψ/∂Ī₂) and U'' at rest.
    pub moduli: [f64; 2],
    /// The same as a law in WGSL, from the same values; it has no uniform.
    pub wgsl: String,
}

/// An energy and its derivatives.
struct Derived {
    /// Of Ī₁ − 3 and Ī₂ − 3.
    isochoric: Graph,
    /// ∂Ψ/∂Ī₁ and ∂Ψ/∂Ī₂.
    slopes: [Id; 2],
    /// Their derivatives by Ī₁, Ī₂ and by Ī₂.
    curvatures: [Id; 3],
    isochoric_energy: Id,
    /// Of J − 1.
    volumetric: Graph,
    pressure: Id,
    stiffness: Id,
    volumetric_energy: Id,
}

impl ProgramSource {
    /// Differentiates the function `name`, an energy of `Invariants`; `uniforms` as for
    /// [`translate`](Self::translate).
    ///
    /// # Errors
    /// What cannot be translated, an energy that is no sum of an isochoric and a volumetric one, and derivatives that
    /// are too long.
    pub fn derive(&self, name: &str, uniforms: &BTreeMap<String, Vec<f64>>) -> Result<DerivedLaw, Untranslatable> {
        self.derived(name, uniforms).map_err(|mut error| {
            error.at = error.at.map(|range| self.twin.original(range));
            error
        })
    }

    fn derived(&self, name: &str, uniforms: &BTreeMap<String, Vec<f64>>) -> Result<DerivedLaw, Untranslatable> {
        let (graph, energy, at) = self.symbolic(name, uniforms)?;
        let derived = Derived::of(&graph, energy, at)?;
        derived.law().map_err(|mut error| {
            error.at = error.at.or(at.to_range());
            error
        })
    }

    /// The energy in terms of the invariants.
    fn symbolic(&self, name: &str, uniforms: &BTreeMap<String, Vec<f64>>) -> Result<(Graph, Id, Span), Untranslatable> {
        let function = self.module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(name));
        let Some((handle, function)) = function else {
            return Err(Untranslatable::new(Span::UNDEFINED, format!("there is no function `{name}`")));
        };
        let at = self.module.functions.get_span(handle);
        let mut translator = Translator::new(&self.module, Vec::new());
        let graph = &mut translator.graph;
        let mut invariants: Vec<Id> = (0..INDEPENDENT).map(|number| graph.input(number)).collect();
        for (number, rest) in [3.0, 3.0, 1.0].into_iter().enumerate() {
            let rest = graph.constant(rest);
            invariants.push(graph.binary(Binary::Add, invariants[number], rest));
        }
        translator.globals = self.globals(&mut translator.graph, uniforms);
        match translator.call(function, vec![Value::vector(invariants)], at)? {
            Value::Float(energy) => Ok((translator.graph, energy, at)),
            _ => Err(Untranslatable::new(at, translate::VARYING)),
        }
    }
}

impl Derived {
    fn of(energy: &Graph, psi: Id, at: Span) -> Result<Self, Untranslatable> {
        let (mut graph, found) = energy.tidied(&[psi], Graph::input);
        let [psi] = some(&found, at)?;
        let slopes = [0, 1, VOLUME].map(|input| graph.derivative(psi, input));
        bearable(&graph, &slopes, at)?;
        let mixed = slopes.iter().zip([&[VOLUME][..], &[VOLUME], &[0, 1]]).any(|(slope, others)| {
            let inputs = graph.inputs_of(*slope);
            others.iter().any(|other| inputs.contains(other))
        });
        if mixed {
            let message = "the energy is no sum of one of `I1bar` and `I2bar` and one of `J`";
            return Err(Untranslatable::new(at, message).note(
                "elements that do not lock take the pressure from means of the volume change: it cannot depend on \
                       the rest of the deformation",
            ));
        }
        // Ψ_iso = Ψ(Ī₁, Ī₂, 1) − Ψ(3, 3, 1)
        let (mut isochoric, found) = graph.tidied(&[slopes[0], slopes[1], psi], |graph, number| match number {
            VOLUME => graph.constant(0.0),
            _ => graph.input(number),
        });
        let [first, second, of_both] = some(&found, at)?;
        let curvatures = [(first, 0), (first, 1), (second, 1)].map(|(slope, by)| isochoric.derivative(slope, by));
        let isochoric_energy = isochoric.difference(of_both).map_or(of_both, |difference| difference.first);
        bearable(&isochoric, &[&[first, second, isochoric_energy][..], &curvatures].concat(), at)?;
        // U = Ψ(3, 3, J) − Ψ(3, 3, 1), of J − 1 as the only input
        let (mut volumetric, found) = graph.tidied(&[slopes[2], psi], |graph, number| match number {
            VOLUME => graph.input(0),
            _ => graph.constant(0.0),
        });
        let [slope, of_volume] = some(&found, at)?;
        let stiffness = volumetric.derivative(slope, 0);
        let pressure = match volumetric.difference(slope) {
            Some(difference) => volumetric.plus_number(difference.first, difference.at_rest),
            None => slope,
        };
        // what is of first order is 0 but for rounding, and is known without any
        let volumetric_energy = match volumetric.difference(of_volume) {
            Some(difference) => {
                let linear = volumetric.linear(difference.slopes);
                volumetric.tidy(Binary::Add, difference.second, linear)
            }
            None => of_volume,
        };
        bearable(&volumetric, &[pressure, stiffness, volumetric_energy], at)?;
        let slopes = [first, second];
        Ok(Self { isochoric, slopes, curvatures, isochoric_energy, volumetric, pressure, stiffness, volumetric_energy })
    }

    fn law(&self) -> Result<DerivedLaw, Untranslatable> {
        let [first, second] = self.slopes;
        let of_isochoric = |ids: &[Id]| Program::of_energy(&self.isochoric, 2, ids, 0.0);
        let of_volume = |id: Id| Program::of_energy(&self.volumetric, 1, &[id], SQUEEZED);
        let (slopes, pressure) = (of_isochoric(&self.slopes)?, of_volume(self.pressure)?);
        let volumetric_stiffness = of_volume(self.stiffness)?;
        let at_rest = slopes.run::<f64, 2, 2>([0.0; 2]);
        let [bulk] = volumetric_stiffness.run([0.0]);
        let known = [(&self.isochoric, first), (&self.isochoric, second), (&self.volumetric, self.stiffness)]
            .map(|(graph, id)| graph.constant_of(id));
        let constants = match known {
            [Some(first), Some(second), Some(bulk)] if pressure.run([0.0]) == [0.0] => Some([first, second, bulk]),
            _ => None,
        };
        let depends_on =
            [0, 1].map(|input| self.slopes.iter().any(|id| self.isochoric.inputs_of(*id).contains(&input)));
        Ok(DerivedLaw {
            curvatures: of_isochoric(&self.curvatures)?,
            depends_on,
            has_second: known[1] != Some(0.0),
            pressure,
            volumetric_stiffness,
            constants,
            isochoric_energy: of_isochoric(&[self.isochoric_energy])?,
            volumetric_energy: of_volume(self.volumetric_energy)?,
            moduli: [2.0 * (at_rest[0] + at_rest[1]), bulk],
            slopes,
            wgsl: self.wgsl()?,
        })
    }

    /// The law as a text of its own: what a user could have written.
    fn wgsl(&self) -> Result<String, Untranslatable> {
        let isochoric = |ids: &[Id]| -> Result<(String, Vec<String>), Untranslatable> {
            // what rounding takes below 0 has no place in a power
            let lines = [("I1bar_minus_3", "max(i1_change(k), 0.0)"), ("I2bar_minus_3", "max(i2_change(k), 0.0)")];
            let used = |input: u16| ids.iter().any(|id| self.isochoric.inputs_of(*id).contains(&input));
            let used = lines.iter().zip([used(0), used(1)]).filter(|(_, used)| *used);
            let before: String = used.map(|((name, value), _)| format!("    let {name} = {value};\n")).collect();
            let (lines, names) = self.isochoric.wgsl(ids, &lines.map(|(name, _)| name.to_owned()))?;
            Ok((before + &lines, names))
        };
        let volumetric = |id: Id| self.volumetric.wgsl(&[id], &["volume_change".to_owned()]);
        let mut text = String::from("// Derived from an energy.\n");
        let (lines, names) = isochoric(&self.slopes)?;
        let stress = match self.isochoric.constant_of(self.slopes[1]) {
            Some(0.0) => format!("stress_of_slope(k, {})", names[0]),
            _ => format!("stress_of_slopes(k, {}, {})", names[0], names[1]),
        };
        text += &function("elastic_isochoric(k: Kinematics)", "Sym3", &lines, &stress);
        let (lines, names) = volumetric(self.pressure)?;
        text += &function("elastic_pressure(volume_change: f32)", "f32", &lines, &names[0]);
        let (lines, names) = isochoric(&[self.isochoric_energy])?;
        text += &function("elastic_isochoric_energy(k: Kinematics)", "f32", &lines, &names[0]);
        let (lines, names) = volumetric(self.volumetric_energy)?;
        text += &function("elastic_volumetric_energy(volume_change: f32)", "f32", &lines, &names[0]);
        Ok(text)
    }
}

fn some<const COUNT: usize>(values: &[Id], at: Span) -> Result<[Id; COUNT], Untranslatable> {
    values.try_into().map_err(|_| Untranslatable::new(at, translate::VARYING))
}

/// Whether values are made of no more than an element can be asked to compute.
pub(super) fn bearable(graph: &Graph, values: &[Id], at: Span) -> Result<(), Untranslatable> {
    let count = graph.wanted(values).into_iter().filter(|wanted| *wanted).count();
    if count <= MOST_VALUES {
        return Ok(());
    }
    let message = format!("the derivatives of this have {count} values: more than {MOST_VALUES}");
    Err(Untranslatable::new(at, message).note("a shorter formula, or fewer rounds of its loops"))
}

pub(super) fn function(head: &str, result: &str, lines: &str, value: &str) -> String {
    format!("\nfn {head} -> {result} {{\n{lines}    return {value};\n}}\n")
}
