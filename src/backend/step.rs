//! The step's record, as kernels see it.

use crate::components::{Clock, Signals};

/// One step's record for the device (see `shaders/step.wgsl`).
pub fn record(_clock: &Clock, _signals: &Signals) -> Vec<u8> {
    Vec::new()
}
