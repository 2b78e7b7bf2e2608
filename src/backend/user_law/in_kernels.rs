//! A law of the user's own in kernels: a unit, which names things as it likes whatever kernels call theirs.

use super::form::{OF_LAWS, callable_fragments_of_law, stand_ins};
use crate::backend::kernel::{Fragment, Kernel, Link, Unit, UnitId};
use crate::materials::LawPrograms;

/// Has a kernel call a law.
pub(crate) fn with_law(kernel: Kernel, law: &LawPrograms) -> Kernel {
    let mut kernel = kernel.fragment(stand_ins());
    let unit = UnitId(kernel.units.len());
    let own = callable_fragments_of_law().into_iter().chain([Fragment::new(law.path.as_str(), law.text.clone())]);
    let variables = vec![("elastic".into(), "elastic".into())];
    kernel.units.push(Unit { own: own.collect(), variables, ..Unit::default() });
    kernel.links.extend(OF_LAWS.map(|(name, ..)| Link { function: name.into(), calls: vec![(unit, name.into())] }));
    kernel
}
