//! Numbers and small tensors. Everything pointwise in sinew (elements, materials) is written once over [`Real`]:
//! with `f64` it is the reference, with [`F32s`] and [`F64s`] it is what the CPU backend runs, a register at a time.

mod broadcast;
mod coordinates;
mod eigen;
mod elementary;
mod extremes;
mod noise;
mod polar;
mod real;
mod rows;
mod simd;
mod tensor;
mod trigonometry;
mod turn;

pub use real::{Real, Scalar};
pub use simd::SimdScalar;
pub use tensor::{Mat3, Sym3};

// what the engine, the crates on top and tests see beside: no version keeps their names and types
pub(crate) use coordinates::{coordinates, digits_beside};
pub(crate) use extremes::{Extremes, ROUNDING, See};
pub(crate) use noise::noise;
pub(crate) use polar::Polar;
pub(crate) use real::vector_at;
#[doc(hidden)]
pub use real::{Task, refine_inverse_cbrt};
#[doc(hidden)]
pub use rows::{Rows, Scratch};
#[doc(hidden)]
pub use simd::{F32s, F64s, LANES, lane_place};
#[doc(hidden)]
pub use tensor::{dot, dot_plus, minor};
pub(crate) use turn::{degrees, radians, shorter, turned};
