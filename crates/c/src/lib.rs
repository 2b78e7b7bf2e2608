//! The C interface of sinew: `libsinew_c` and `include/sinew.h`, for whoever calls C: engines, haptic loops, other
//! languages. How it is used stands in `docs/c.md`; the rules that all functions keep, at the top of the header.
//!
//! It is the one crate in which Rust cannot prove what pointers are: what callers owe is in the header, what can be
//! checked of it (NULL, sizes, ranges, UTF-8) is checked in [`memory`], and no panic passes [`status::entry`].
// reading and writing what a C program points to is what this crate is for
#![allow(unsafe_code)]
// what callers owe is the same everywhere and stands once, at the top of the header
#![allow(clippy::missing_safety_doc)]

mod field;
mod geometry;
mod handle;
mod inputs;
mod keep;
mod memory;
mod observe;
mod options;
mod pick;
mod port;
mod status;
mod steps;
mod tool;

pub use field::*;
pub use geometry::*;
pub use handle::*;
pub use inputs::*;
pub use keep::*;
pub use observe::*;
pub use options::*;
pub use pick::*;
pub use port::*;
pub use status::*;
pub use steps::*;
pub use tool::*;

use std::ffi::c_char;

/// The version of this interface. Another number means that programs have to be compiled anew; structures may grow at
/// their ends and functions may be added without one.
pub const SINEW_ABI_VERSION: u32 = 1;

/// The `SINEW_ABI_VERSION` of the library that is loaded: compare it with that of the header before anything else.
#[unsafe(no_mangle)]
pub extern "C" fn sinew_abi_version() -> u32 {
    SINEW_ABI_VERSION
}

/// The version of sinew, a text that stays.
#[unsafe(no_mangle)]
pub extern "C" fn sinew_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}
