//! Every system on the host against its kernels on a GPU (lavapipe suffices), on random fields.
//!
//! Both compute the same formulas in f32 (u = 2⁻²⁴) but may contract products, sum in another order, and divide less
//! exactly (Vulkan allows 2.5 ulp). A value that is the sum of terms tᵢ, each the product of few factors, then differs
//! by at most n u Σ|tᵢ| with n the number of roundings on the longest way through the formula. Each test states Σ|tᵢ|
//! from the fields themselves and counts n; columns that are only copied or summed in a fixed order must agree to the
//! bit.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod attachments;
mod elements;
mod grasps;
#[path = "../kernel_worlds/mod.rs"]
mod kernel_worlds;
mod loads;
mod magnitude;
mod motion;
mod pair;
mod patches;
mod removal;
mod shapes;
mod suction;
mod surfaces;
mod tool_removal;
mod tools;
