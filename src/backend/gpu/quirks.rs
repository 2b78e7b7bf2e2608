//! What drivers get wrong, and how kernels get round it.

use naga::{AddressSpace, Module, StorageAccess};

use super::AdapterReport;
use crate::backend::kernel::STEP_VARIABLE;

/// Uniform buffers that a kernel may have on Mesa's software GPU before 23.2: it spoils memory when a condition reads a
/// fourth.
///
/// What conditions read from uniform buffers it compiles in, from 22.3 on, and notes the places in an array: 4 for each
/// of 32 buffers, of which the first is not ours. `nir_collect_src_uniforms` took those of buffer i to begin at 32 i,
/// not at 4 i.
const SAFE_UNIFORMS: usize = 3;

/// How many uniform buffers a kernel may have before the driver spoils memory, if it does.
pub(super) fn safe_uniforms(report: &AdapterReport) -> Option<usize> {
    let (_, version) = report.driver.split_once("llvmpipe")?;
    let mut numbers = version.split(|c: char| !c.is_ascii_digit()).filter_map(|digits| digits.parse::<u32>().ok());
    let mended = numbers.next().zip(numbers.next()).is_some_and(|version| version >= (23, 2));
    (!mended).then_some(SAFE_UNIFORMS)
}

/// Has all uniforms of a module but the step's record and the first few read from storage buffers; gives the names of
/// those. The same bytes are at the same places.
pub(super) fn read_from_storage(module: &mut Module, uniforms_left: usize) -> Vec<String> {
    let of_uniforms = module.global_variables.iter_mut().filter(|(_, v)| v.space == AddressSpace::Uniform);
    let others = of_uniforms.filter(|(_, variable)| variable.name.as_deref() != Some(STEP_VARIABLE));
    let moved = others.skip(uniforms_left.saturating_sub(1)).map(|(_, variable)| {
        variable.space = AddressSpace::Storage { access: StorageAccess::LOAD };
        variable.name.clone().unwrap_or_default()
    });
    moved.collect()
}

#[cfg(test)]
mod tests;
