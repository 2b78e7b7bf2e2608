//! Where the kernels of elements are compiled.

use super::{GENERIC, OfPatch};
use crate::backend::cpu::Cpu;
use crate::elements::Element;
use crate::materials::Elastic;
use crate::math::SimdScalar;

/// Where kernels are compiled: the compiler keeps a method of a trait with the type it is for, and takes what is in
/// different modules to different cores. Else all of them were in one piece, most of the time that compiling takes.
pub(super) trait InOwnModule: Element {
    #[inline(never)]
    fn run_patch<T: SimdScalar, L: Elastic<T>, const EFFECTS: u8>(
        cpu: &Cpu,
        task: OfPatch<'_, '_, '_, Self, T, L, EFFECTS>,
    ) -> bool {
        // constants, so that no code is made of the other ways
        if const { EFFECTS == GENERIC } {
            return cpu.dispatch(task);
        }
        let is_inverted = if const { EFFECTS & GENERIC == 0 } {
            cpu.dispatch_vectors(task)
        } else {
            cpu.dispatch_narrow_vectors(task)
        };
        debug_assert!(is_inverted.is_some(), "a kernel for vector registers on a machine without");
        is_inverted.unwrap_or(true)
    }
}
impl<E: Element> InOwnModule for E {}
