//! Vectors over all axes, in the numbers of the run. What is added up of them is in f64.

use crate::components::{Precision, Reals};
use crate::math::Scalar;

/// Runs the same expression with a name for the type of a column's numbers.
macro_rules! with_numbers {
    ($reals:expr, $number:ident => $body:expr) => {
        match $reals.precision() {
            $crate::components::Precision::F32 => {
                type $number = f32;
                $body
            }
            $crate::components::Precision::F64 => {
                type $number = f64;
                $body
            }
        }
    };
}
pub(super) use with_numbers;

/// One of no length.
pub(super) fn none(precision: Precision) -> Reals {
    Reals::zeros(precision, 0)
}

/// Makes it as long, with zeros where it was not.
pub(super) fn resize(vector: &mut Reals, length: usize) {
    match vector {
        Reals::F32(numbers) => numbers.resize(length, 0.0),
        Reals::F64(numbers) => numbers.resize(length, 0.0),
    }
}

/// Fills it with zeros.
pub(super) fn clear(vector: &mut Reals) {
    match vector {
        Reals::F32(numbers) => numbers.fill(0.0),
        Reals::F64(numbers) => numbers.fill(0.0),
    }
}

/// Copies one of the same numbers to where it begins in a longer one.
pub(super) fn copy_to(into: &mut Reals, first: usize, from: &Reals) {
    let range = first..first + from.len();
    with_numbers!(into, T => into.slice_mut::<T>()[range].copy_from_slice(from.slice::<T>()));
}

/// Copies one that is as long.
pub(super) fn copy(into: &mut Reals, from: &Reals) {
    copy_to(into, 0, from);
}

/// x = what a number of it becomes at each axis.
pub(super) fn update(x: &mut Reals, becomes: impl Fn(usize, f64) -> f64) {
    with_numbers!(x, T => {
        let all = x.slice_mut::<T>().iter_mut().enumerate();
        all.for_each(|(axis, x)| *x = T::from_f64(becomes(axis, x.to_f64())));
    });
}

/// x = what is told of x and y.
pub(super) fn combine(x: &mut Reals, y: &Reals, becomes: impl Fn(f64, f64) -> f64) {
    with_numbers!(x, T => {
        let all = x.slice_mut::<T>().iter_mut().zip(y.slice::<T>());
        all.for_each(|(x, y)| *x = T::from_f64(becomes(x.to_f64(), y.to_f64())));
    });
}
