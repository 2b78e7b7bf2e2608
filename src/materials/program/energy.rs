//! Laws from an energy: its derivatives by the invariants, as programs for the CPU and as WGSL for a GPU.

use super::graph::{Binary, Graph, Id};
use super::tape::Program;
use super::translate::{self, Translator};
use super::value::Value;
use super::{Source, Untranslatable};
use naga::Span;
use std::collections::BTreeMap;

/// What an energy is a function of: the members of `Invariants` in `shaders/invariants.wgsl`, in order.
pub const INVARIANTS: [&str; 6] = ["I1bar_minus_3", "I2bar_minus_3", "J_minus_1", "I1bar", "I2bar", "J"];
/// Those that the others follow from.
const INDEPENDENT: u16 = 3;
/// The number among these of J − 1.
const VOLUME: u16 = 2;

/// An energy Ψ(Ī₁, Ī₂, J) = Ψ_iso(Ī₁, Ī₂) + U(J), differentiated. The two parts are 0 at rest.
#[derive(Clone, Debug)]
pub struct DerivedLaw {
    /// ∂Ψ/∂Ī₁ and ∂Ψ/∂Ī₂ (Pa) of Ī₁ − 3 and Ī₂ − 3.
    pub slopes: Program,
    /// Whether the slopes depend on Ī₁, and on Ī₂.
    pub depends_on: [bool; 2],
    /// Whether Ψ depends on Ī₂ at all.
    pub has_second: bool,
    /// U' (Pa) of J − 1.
    pub pressure: Program,
    /// Ψ_iso (J/m³) of Ī₁ − 3 and Ī₂ − 3.
    pub isochoric_energy: Program,
    /// U (J/m³) of J − 1.
    pub volumetric_energy: Program,
    /// ∂Ψ/∂Ī₁, ∂Ψ/∂Ī₂ and U'' (Pa), where they are the same at every deformation and U' is 0 at rest.
    pub constants: Option<[f64; 3]>,
    /// Shear and bulk modulus (Pa) at small strains: 2 (∂Ψ/∂Ī₁ + ∂Ψ/∂Ī₂) and U'' at rest.
    pub moduli: [f64; 2],
    /// The same as a law in WGSL, with a uniform of the parameters.
    pub wgsl: String,
}

/// The graph of an energy and its derivatives, with the parameters as inputs that come after the invariants.
struct Derived {
    graph: Graph,
    /// ∂Ψ/∂Ī₁, ∂Ψ/∂Ī₂, U', Ψ_iso, U, U''.
    values: [Id; 6],
}

impl Source {
    /// Differentiates the function `name`, an energy of `Invariants`. `uniform` is the variable of the parameters, which
    /// are given in the order of its members.
    ///
    /// # Errors
    /// What cannot be translated, and an energy that is no sum of an isochoric and a volumetric one.
    pub fn derive(&self, name: &str, uniform: &str, given: &[(String, f64)]) -> Result<DerivedLaw, Untranslatable> {
        self.derived(name, uniform, given).map_err(|mut error| {
            error.at = error.at.map(|range| self.twin.original(range));
            error
        })
    }

    fn derived(&self, name: &str, uniform: &str, given: &[(String, f64)]) -> Result<DerivedLaw, Untranslatable> {
        let (graph, energy, at) = self.symbolic(name, uniform, given.len())?;
        let place = |mut error: Untranslatable| {
            error.at = error.at.or(at.to_range());
            error
        };
        let derived = Derived::of(&graph, energy, at)?;
        let wgsl = derived.wgsl(uniform, given).map_err(place)?;
        let numbers: Vec<f64> = given.iter().map(|(_, value)| *value).collect();
        // the constants put in: much of it is known then
        let (graph, values) =
            derived.graph.tidied(&derived.values, |graph, number| match number.checked_sub(INDEPENDENT) {
                Some(parameter) => graph.constant(numbers.get(usize::from(parameter)).copied().unwrap_or(f64::NAN)),
                None => graph.input(number),
            });
        let [first, second, pressure, isochoric, volumetric, stiffness] = six(&values, at)?;
        let slopes = Program::new(&graph, 2, &[first, second]).map_err(place)?;
        let depends_on = [0, 1].map(|input| [first, second].iter().any(|id| graph.inputs_of(*id).contains(&input)));
        // of J − 1 alone, as the only input
        let (of_volume, ids) = graph.tidied(&[pressure, volumetric, stiffness], |graph, _| graph.input(0));
        let bulk = Program::new(&of_volume, 1, &ids[2..]).map_err(place)?.run::<f64, 1, 1>([0.0])[0];
        let at_rest = slopes.run::<f64, 2, 2>([0.0; 2]);
        let pressure = Program::new(&of_volume, 1, &ids[..1]).map_err(place)?;
        let constants = match (graph.constant_of(first), graph.constant_of(second), of_volume.constant_of(ids[2])) {
            (Some(first), Some(second), Some(bulk)) if pressure.run::<f64, 1, 1>([0.0]) == [0.0] => {
                Some([first, second, bulk])
            }
            _ => None,
        };
        Ok(DerivedLaw {
            depends_on,
            has_second: graph.constant_of(second) != Some(0.0),
            pressure,
            constants,
            isochoric_energy: Program::new(&graph, 2, &[isochoric]).map_err(place)?,
            volumetric_energy: Program::new(&of_volume, 1, &ids[1..2]).map_err(place)?,
            moduli: [2.0 * (at_rest[0] + at_rest[1]), bulk],
            slopes,
            wgsl,
        })
    }

    /// The energy in terms of the invariants and the parameters.
    fn symbolic(&self, name: &str, uniform: &str, parameters: usize) -> Result<(Graph, Id, Span), Untranslatable> {
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
        let inputs: Vec<Id> = (0..parameters as u16).map(|number| graph.input(INDEPENDENT + number)).collect();
        translator.globals = self.of_uniforms(&BTreeMap::from([(uniform.to_owned(), inputs)]));
        match translator.call(function, vec![Value::vector(invariants)], at)? {
            Value::Float(energy) => Ok((translator.graph, energy, at)),
            _ => Err(Untranslatable::new(at, translate::VARYING)),
        }
    }
}

fn six(values: &[Id], at: Span) -> Result<[Id; 6], Untranslatable> {
    values.try_into().map_err(|_| Untranslatable::new(at, translate::VARYING))
}

impl Derived {
    fn of(energy: &Graph, psi: Id, at: Span) -> Result<Self, Untranslatable> {
        let (mut graph, found) = energy.tidied(&[psi], Graph::input);
        let Some(&psi) = found.first() else { return Err(Untranslatable::new(at, translate::VARYING)) };
        let slopes = [0, 1, VOLUME].map(|input| graph.derivative(psi, input));
        let stiffness = graph.derivative(slopes[2], VOLUME);
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
        // Ψ_iso = Ψ(Ī₁, Ī₂, 1) − Ψ(3, 3, 1), U = Ψ(3, 3, J) − Ψ(3, 3, 1)
        let without = |graph: &Graph, rest: &'static [u16]| {
            graph.tidied(&[psi], |graph, number| match rest.contains(&number) {
                true => graph.constant(0.0),
                false => graph.input(number),
            })
        };
        let parts = [without(&graph, &[VOLUME]), without(&graph, &[0, 1]), without(&graph, &[0, 1, VOLUME])];
        let [isochoric, volumetric, rest] = parts.map(|(part, ids)| ids.first().map(|id| part.copied(*id, &mut graph)));
        let (Some(isochoric), Some(volumetric), Some(rest)) = (isochoric, volumetric, rest) else {
            return Err(Untranslatable::new(at, translate::VARYING));
        };
        let isochoric = graph.tidy(Binary::Subtract, isochoric, rest);
        let volumetric = graph.tidy(Binary::Subtract, volumetric, rest);
        let values = [slopes[0], slopes[1], slopes[2], isochoric, volumetric, stiffness];
        Ok(Self { graph, values })
    }

    /// The law as a text of its own: what a user could have written.
    fn wgsl(&self, uniform: &str, given: &[(String, f64)]) -> Result<String, Untranslatable> {
        let [first, second, pressure, isochoric, volumetric, _] = self.values;
        let inputs = |invariants: [&str; 3]| -> Vec<String> {
            let parameters = given.iter().map(|(name, _)| format!("{uniform}.{name}"));
            invariants.into_iter().map(str::to_owned).chain(parameters).collect()
        };
        let of_k = inputs(["I1bar_minus_3", "I2bar_minus_3", "0.0"]);
        let of_j = inputs(["0.0", "0.0", "volume_change"]);
        let mut text = String::from("// Derived from an energy.\n");
        if !given.is_empty() {
            let members: String = given.iter().map(|(name, _)| format!("    {name}: f32,\n")).collect();
            text += &format!(
                "struct EnergyParameters {{\n{members}}}\n@group(0) @binding(0) var<uniform> {uniform}: EnergyParameters;\n"
            );
        }
        let invariants = |ids: &[Id]| -> String {
            let used = |input: u16| ids.iter().any(|id| self.graph.inputs_of(*id).contains(&input));
            let lines = [("I1bar_minus_3", "i1_change(k)"), ("I2bar_minus_3", "i2_change(k)")];
            let used = lines.into_iter().zip([used(0), used(1)]).filter(|(_, used)| *used);
            used.map(|((name, value), _)| format!("    let {name} = {value};\n")).collect()
        };
        let (lines, names) = self.graph.wgsl(&[first, second], &of_k)?;
        let stress = match self.graph.constant_of(second) {
            Some(0.0) => format!("stress_of_slope(k, {})", names[0]),
            _ => format!("stress_of_slopes(k, {}, {})", names[0], names[1]),
        };
        let before = invariants(&[first, second]);
        text += &format!("\nfn elastic_isochoric(k: Kinematics) -> Sym3 {{\n{before}{lines}    return {stress};\n}}\n");
        let (lines, names) = self.graph.wgsl(&[pressure], &of_j)?;
        text += &function("elastic_pressure(volume_change: f32)", &lines, &names[0]);
        let (lines, names) = self.graph.wgsl(&[isochoric], &of_k)?;
        let before = invariants(&[isochoric]);
        text += &function("elastic_isochoric_energy(k: Kinematics)", &(before + &lines), &names[0]);
        let (lines, names) = self.graph.wgsl(&[volumetric], &of_j)?;
        text += &function("elastic_volumetric_energy(volume_change: f32)", &lines, &names[0]);
        Ok(text)
    }
}

fn function(head: &str, lines: &str, result: &str) -> String {
    format!("\nfn {head} -> f32 {{\n{lines}    return {result};\n}}\n")
}
