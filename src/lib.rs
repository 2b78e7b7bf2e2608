//! Sinew: a data-oriented soft-tissue engine.

pub mod backend;
pub mod mesh;
pub mod output;
pub mod render;
pub mod scene;
