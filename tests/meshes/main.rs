//! Meshes: generators, readers, soundness, placement and surface.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod generators;
mod shared;
mod soundness;
