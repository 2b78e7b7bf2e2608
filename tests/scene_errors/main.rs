//! What a scene author is told about mistakes: where, what, what is allowed.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod attachments;
mod complaints;
mod constraints;
mod deep_laws;
mod energies;
mod good;
mod laws;
mod limits;
mod materials;
mod memory;
mod mutations;
mod outside;
mod own_systems;
mod parts;
mod parts_of_parts;
mod per_copy;
mod set;
mod several;
mod suction;
mod surfaces;
mod tools;
mod values;
mod words;
