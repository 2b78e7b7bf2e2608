//! Sinew: a data-oriented soft-tissue engine.

pub mod backend;
pub mod components;
pub mod elements;
pub mod materials;
pub mod math;
pub mod mesh;
pub mod output;
pub mod render;
pub mod scene;
