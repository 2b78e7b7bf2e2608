//! Rigid tools: shapes that touch bodies, known by the signed distance to their surface in a frame of their own.

mod form;
mod shape;
mod surface;

pub use form::Form;
pub use shape::{Problem, Shape, Solid};

/// What says the words of scenes here: messages quote it.
pub const TEXTS: &[&str] = &[include_str!("shape.rs")];

#[cfg(test)]
mod tests;
