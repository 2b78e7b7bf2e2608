//! What a text of the user's own must be: a law, or a load.

use super::names::{callable_fragments, owners_among};
use crate::backend::kernel::Fragment;
use crate::materials::J_FLOOR;
use crate::shader;
use std::collections::HashMap;

/// A function that a text must declare.
pub(super) struct Function {
    pub(super) name: String,
    /// Types of its argument and of its result.
    pub(super) argument: &'static str,
    pub(super) result: &'static str,
    /// How it is declared.
    pub(super) declared: String,
}

/// What a text must be, and what it may use.
pub(super) struct Form {
    /// What it is, in a word.
    pub(super) word: &'static str,
    pub(super) functions: Vec<Function>,
    /// The one variable that it may have, a `var<uniform>`.
    pub(super) parameters: &'static str,
    /// Who calls the functions.
    pub(super) called_by: &'static str,
    /// What they may depend on.
    pub(super) depends_on: &'static str,
    /// Fragments that it may call, and with which it is compiled.
    pub(super) ours: Vec<Fragment>,
    /// What a text may have in place of all functions.
    pub(super) instead: Option<Function>,
    /// Names that it cannot have, each with the file that has it.
    pub(super) owners: HashMap<String, String>,
}

/// The functions of a law: name, types of the argument and of the result, and what its argument is called.
pub(super) const OF_LAWS: [(&str, &str, &str, &str); 4] = [
    ("elastic_isochoric", "Kinematics", "Sym3", "k"),
    ("elastic_pressure", "f32", "f32", "volume_change"),
    ("elastic_isochoric_energy", "Kinematics", "f32", "k"),
    ("elastic_volumetric_energy", "f32", "f32", "volume_change"),
];

/// The function of an energy.
pub(super) const ENERGY: &str = OF_ENERGIES.0;
const OF_ENERGIES: (&str, &str, &str, &str) = ("elastic_energy", "Invariants", "f32", "s");

fn function((name, argument, result, called): (&str, &'static str, &'static str, &str)) -> Function {
    let declared = format!("fn {name}({called}: {argument}) -> {result}");
    Function { name: name.to_owned(), argument, result, declared }
}

impl Form {
    /// Of an elastic law.
    pub(super) fn law() -> Self {
        let ours = callable_fragments_of_law();
        Self {
            word: "law",
            functions: OF_LAWS.into_iter().map(function).collect(),
            parameters: "elastic",
            called_by: "the element kernel calls the law's functions",
            depends_on: "a stress depends on the deformation and the parameters alone",
            instead: Some(function(OF_ENERGIES)),
            owners: owners_among(&ours),
            ours,
        }
    }

    /// Of an energy that a law is derived from.
    pub(super) fn energy() -> Self {
        Self {
            word: "energy",
            functions: vec![function(OF_ENERGIES)],
            instead: None,
            called_by: "the law is derived from the function",
            depends_on: "an energy depends on the deformation and the parameters alone",
            ..Self::law()
        }
    }

    /// Of a load by the name of its function: the force on a node.
    pub(super) fn load(name: &str) -> Self {
        let ours = callable_fragments_of_load();
        Self {
            word: "system",
            functions: vec![function((name, "Node", "vec3<f32>", "node"))],
            parameters: "parameters",
            called_by: "the kernel of nodes calls the system's function",
            depends_on: "a force depends on the node and the parameters alone",
            instead: None,
            owners: owners_among(&ours),
            ours,
        }
    }
}

/// The fragments of ours that a law's text may call.
pub(super) fn callable_fragments_of_law() -> Vec<Fragment> {
    let floor = Fragment::new("generated: constants", format!("const J_FLOOR: f32 = {J_FLOOR:e};\n"));
    callable_fragments().into_iter().chain([floor]).collect()
}

/// The functions of a law as kernels declare them, each with a body that stands for that of the law.
pub(super) fn stand_ins() -> Fragment {
    let stand_in = |of: (&str, &'static str, &'static str, &str)| {
        let Function { declared, result, .. } = function(of);
        format!("{declared} {{\n    return {result}();\n}}\n")
    };
    Fragment::new("generated: what stands for a law", OF_LAWS.into_iter().map(stand_in).collect::<String>())
}

/// The fragments of ours that a load's text may call.
pub(crate) fn callable_fragments_of_load() -> Vec<Fragment> {
    vec![shader!("node_state"), shader!("elementary")]
}
