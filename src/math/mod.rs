//! Numbers and small tensors. Everything pointwise in sinew (elements, materials) is written once over [`Real`]:
//! with `f64` it is the reference, with [`F32s`] and [`F64s`] it is what the CPU backend runs, a register at a time.

mod broadcast;
mod eigen;
mod elementary;
mod real;
mod rows;
mod simd;
mod tensor;
mod triangle;
mod trigonometry;

pub use real::refine_inverse_cbrt;
pub use real::{Real, Scalar, Task};
pub use rows::{Rows, Scratch};
pub use simd::{F32s, F64s, LANES, SimdScalar, lane_place};
pub use tensor::{Mat3, Sym3, dot, dot_plus, minor};
pub use triangle::OnTriangle;
