//! Rigid tools: shapes that touch bodies, known by the signed distance to their surface in a frame of their own.

mod form;
mod shape;
mod surface;

pub use form::Form;
pub use shape::{Problem, Shape, Solid};

#[cfg(test)]
mod tests;
