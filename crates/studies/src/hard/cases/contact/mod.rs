//! Contact: the catalogue of closed forms, C01 to C35, as hard cases H36 to H70.

pub mod free;
pub mod friction;
pub mod holding;
pub mod indentation;
mod measures;
pub mod patch;
pub mod rest;
pub mod shapes;
pub mod springs;
pub mod start;
pub mod taking;
pub mod waves;
