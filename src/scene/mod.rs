//! Scene files: their words, how they are read, and what is said when they are wrong.

pub mod schema;
