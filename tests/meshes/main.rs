//! Meshes: generators, readers, soundness, placement and surface.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod cells;
mod generators;
mod gltf;
mod hostile;
mod placement;
mod readers;
mod samples;
mod samples_vtk;
mod shared;
mod shipped;
mod skins;
mod soundness;
mod topology;
mod written;
