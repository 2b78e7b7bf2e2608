//! The one way tests come by a GPU.

use super::{Choice, Gpu};

/// Opens a GPU for a test, or says on the error stream why the test is left out. `SINEW_GPU` chooses the device
/// (`best`, `hardware`, `software` or a part of a name).
///
/// # Panics
/// When there is none and the variable `SINEW_REQUIRE_GPU` is set: a machine that is meant to have a GPU must not pass
/// its tests by leaving them out.
#[allow(clippy::panic, reason = "only tests call this, and they fail by panicking")]
pub fn gpu_or_reason() -> Option<Gpu> {
    let choice = Choice::parse(&std::env::var("SINEW_GPU").unwrap_or_default());
    match Gpu::open(&choice) {
        Ok(gpu) => Some(gpu),
        Err(reason) if std::env::var_os("SINEW_REQUIRE_GPU").is_some() => panic!("SINEW_REQUIRE_GPU is set: {reason}"),
        Err(reason) => {
            eprintln!("GPU test left out: {reason}");
            None
        }
    }
}
