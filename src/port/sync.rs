//! What threads share in [`buffer`](super::buffer). By itself, so that a test can put a model of it in its place.

pub use std::sync::Arc;
pub use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};
