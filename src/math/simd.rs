//! Vector registers as [`Real`] numbers, of the width that the machine turns out to have at run time.

use super::broadcast::{broadcast3_f32s, broadcast3_f64s};
use super::real::{
    GUESS_F32, GUESS_F64, ONE_F32, ONE_F64, ROOT_HALF_F32, ROOT_HALF_F64, STEPS_F32, STEPS_F64, refine_inverse_cbrt,
};
use super::rows::{Rows, Scratch, add_f32s, add_f64s, load_f32s, load_f64s};
use super::{Real, Scalar, Task};
use pulp::{Simd, WithSimd};
use std::cell::{Cell, RefCell};
use std::fmt::{Debug, Formatter, Result};
use std::marker::PhantomData;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// How many elements are stored side by side: the widest register's number of `f32` (AVX-512), half a GPU's subgroup.
/// Narrower registers take a group in several parts.
pub const LANES: usize = 16;

/// Place of number `k` of `numbers` of an element in a column of groups.
pub fn lane_place(row: usize, numbers: usize, k: usize) -> usize {
    (row / LANES * numbers + k) * LANES + row % LANES
}

/// A task where the compiler may use the instructions of a kind of register.
struct WithInstructions<R, T>(T, PhantomData<R>);

impl<R, T: Task<R>> WithSimd for WithInstructions<R, T> {
    type Output = T::Output;
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> T::Output {
        self.0.run()
    }
}

/// A scalar with a vector register of its kind.
pub trait SimdScalar: Scalar {
    /// The register.
    type Vector<S: Simd>: Real;
    /// Numbers in a register; divides [`LANES`].
    #[doc(hidden)]
    fn width<S: Simd>() -> usize;
    /// Reads a register full from the start of a slice that is long enough.
    #[doc(hidden)]
    fn load<S: Simd>(simd: S, from: &[Self]) -> Self::Vector<S>;
    /// Writes a register to the start of a slice that is long enough.
    #[doc(hidden)]
    fn store<S: Simd>(vector: Self::Vector<S>, to: &mut [Self]);
    /// Reads what a slice has, at most a register full; zeros in the other places.
    #[doc(hidden)]
    fn load_part<S: Simd>(simd: S, from: &[Self]) -> Self::Vector<S>;
    /// Writes as much of a register as a slice has room for.
    #[doc(hidden)]
    fn store_part<S: Simd>(vector: Self::Vector<S>, to: &mut [Self]);
    /// The same number in all places.
    #[doc(hidden)]
    fn splat<S: Simd>(simd: S, value: Self) -> Self::Vector<S>;
    /// Each number three times, over three registers.
    #[doc(hidden)]
    fn broadcast3<S: Simd>(numbers: Self::Vector<S>) -> [Self::Vector<S>; 3];
    /// The four columns of rows, a row a lane.
    #[doc(hidden)]
    fn load_rows<S: Simd>(simd: S, rows: &Rows<Self>, at: &[u16]) -> [Self::Vector<S>; 4];
    /// Adds vectors to rows, one lane after the other.
    #[doc(hidden)]
    fn add_to_rows<S: Simd>(simd: S, rows: &mut Rows<Self>, at: &[u16], vectors: [Self::Vector<S>; 3]);
    /// Lends the thread's rows to a task, which must not ask for them again.
    #[doc(hidden)]
    fn with_scratch<O>(task: impl FnOnce(&mut Scratch<Self>) -> O) -> O;
    /// Lends so many numbers of the thread's own, whatever they are.
    #[doc(hidden)]
    fn with_spare<O>(count: usize, task: impl FnOnce(&mut [Self]) -> O) -> O;
}

macro_rules! vector {
    ($name:ident, $scalar:ty, $raw:ident, $lanes:ident, $load:ident, $store:ident, $splat:ident, $add:ident, $sub:ident,
     $mul:ident, $div:ident, $xor:ident, $max:ident, $mul_add:ident, $guess:ident, $steps:expr, $min:ident, $sqrt:ident,
     $above:ident, $select:ident, $to_bits:ident, $from_bits:ident, $power:ident, $split:ident, $load_rows:ident, $add_rows:ident,
     $load_part:ident, $store_part:ident, $broadcast3:ident) => {
        #[doc = concat!("A register of `", stringify!($scalar), "`.")]
        #[derive(Clone, Copy)]
        pub struct $name<S: Simd> {
            simd: S,
            value: S::$raw,
        }

        impl<S: Simd> Debug for $name<S> {
            fn fmt(&self, f: &mut Formatter<'_>) -> Result {
                self.value.fmt(f)
            }
        }

        impl<S: Simd> $name<S> {
            #[inline(always)]
            fn with(self, value: S::$raw) -> Self {
                Self { simd: self.simd, value }
            }
        }

        impl<S: Simd> Add for $name<S> {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                self.with(self.simd.$add(self.value, other.value))
            }
        }
        impl<S: Simd> Sub for $name<S> {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                self.with(self.simd.$sub(self.value, other.value))
            }
        }
        impl<S: Simd> Mul for $name<S> {
            type Output = Self;
            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                self.with(self.simd.$mul(self.value, other.value))
            }
        }
        impl<S: Simd> Div for $name<S> {
            type Output = Self;
            #[inline(always)]
            fn div(self, other: Self) -> Self {
                self.with(self.simd.$div(self.value, other.value))
            }
        }
        impl<S: Simd> Neg for $name<S> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                // its sign; pulp's own negation is a call, which no compiler puts in place
                self.with(self.simd.$xor(self.value, self.simd.$splat(-0.0)))
            }
        }
        impl<S: Simd> AddAssign for $name<S> {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }
        impl<S: Simd> SubAssign for $name<S> {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }
        impl<S: Simd> Real for $name<S> {
            const EPSILON: f64 = <$scalar>::EPSILON as f64;

            #[inline(always)]
            fn constant(self, value: f64) -> Self {
                self.with(self.simd.$splat(value as $scalar))
            }
            #[inline(always)]
            fn mul_add(self, factor: Self, summand: Self) -> Self {
                self.with(self.simd.$mul_add(self.value, factor.value, summand.value))
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                self.with(self.simd.$max(self.value, other.value))
            }
            #[inline(always)]
            fn inverse_cbrt(self) -> Self {
                let guess = self.with($guess(self.simd, self.value));
                refine_inverse_cbrt(self, guess, $steps)
            }
            #[inline(never)]
            fn outlined<T: Task<Self>>(self, task: T) -> T::Output {
                self.simd.vectorize(WithInstructions::<Self, T>(task, PhantomData))
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                self.with(self.simd.$min(self.value, other.value))
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.with(self.simd.$sqrt(self.value))
            }
            #[inline(always)]
            fn if_positive(self, then: Self, otherwise: Self) -> Self {
                let simd = self.simd;
                let mask = simd.$above(self.value, simd.$splat(0.0));
                let chosen = simd.$select(mask, simd.$to_bits(then.value), simd.$to_bits(otherwise.value));
                self.with(simd.$from_bits(chosen))
            }
            #[inline(always)]
            fn power_of_two(self) -> Self {
                self.with($power(self.simd, self.value))
            }
            #[inline(always)]
            fn mantissa_and_exponent(self) -> (Self, Self) {
                let (mantissa, exponent) = $split(self.simd, self.value);
                (self.with(mantissa), self.with(exponent))
            }
        }
        impl SimdScalar for $scalar {
            type Vector<S: Simd> = $name<S>;
            #[inline(always)]
            fn width<S: Simd>() -> usize {
                S::$lanes
            }
            #[inline(always)]
            fn load<S: Simd>(simd: S, from: &[Self]) -> $name<S> {
                $name { simd, value: S::$load(&from[..S::$lanes]).0[0] }
            }
            #[inline(always)]
            fn store<S: Simd>(vector: $name<S>, to: &mut [Self]) {
                S::$store(&mut to[..S::$lanes]).0[0] = vector.value;
            }
            #[inline(always)]
            fn load_part<S: Simd>(simd: S, from: &[Self]) -> $name<S> {
                if from.len() < S::$lanes {
                    return $name { simd, value: simd.$load_part(from) };
                }
                Self::load(simd, from)
            }
            #[inline(always)]
            fn store_part<S: Simd>(vector: $name<S>, to: &mut [Self]) {
                if to.len() < S::$lanes {
                    return vector.simd.$store_part(to, vector.value);
                }
                Self::store(vector, to);
            }
            #[inline(always)]
            fn splat<S: Simd>(simd: S, value: Self) -> $name<S> {
                $name { simd, value: simd.$splat(value) }
            }
            #[inline(always)]
            fn load_rows<S: Simd>(simd: S, rows: &Rows<Self>, at: &[u16]) -> [$name<S>; 4] {
                let [x, y, z, more] = $load_rows(simd, rows, &at[..S::$lanes]);
                [
                    $name { simd, value: x },
                    $name { simd, value: y },
                    $name { simd, value: z },
                    $name { simd, value: more },
                ]
            }
            #[inline(always)]
            fn add_to_rows<S: Simd>(simd: S, rows: &mut Rows<Self>, at: &[u16], [x, y, z]: [$name<S>; 3]) {
                $add_rows(simd, rows, &at[..S::$lanes], [x.value, y.value, z.value]);
            }
            #[inline(always)]
            fn broadcast3<S: Simd>(numbers: $name<S>) -> [$name<S>; 3] {
                let [a, b, c] = $broadcast3(numbers.simd, numbers.value);
                [numbers.with(a), numbers.with(b), numbers.with(c)]
            }
            fn with_scratch<O>(task: impl FnOnce(&mut Scratch<Self>) -> O) -> O {
                thread_local! {
                    static SCRATCH: RefCell<Scratch<$scalar>> = RefCell::default();
                }
                SCRATCH.with_borrow_mut(task)
            }
            fn with_spare<O>(count: usize, task: impl FnOnce(&mut [Self]) -> O) -> O {
                thread_local! {
                    static SPARE: Cell<Vec<$scalar>> = const { Cell::new(Vec::new()) };
                }
                let mut spare = SPARE.take();
                if spare.len() < count {
                    spare.resize(count, 0.0);
                }
                let output = task(&mut spare[..count]);
                SPARE.set(spare);
                output
            }
        }
    };
}

/// Guess − bits/3 in every place; bits/3 is the high word of bits · 0xAAAAAAAB, halved.
#[inline(always)]
fn guess_f32s<S: Simd>(simd: S, x: S::f32s) -> S::f32s {
    let (_, high) = simd.widening_mul_u32s(simd.transmute_u32s_f32s(x), simd.splat_u32s(0xaaaa_aaab));
    let third = simd.wrapping_dyn_shr_u32s(high, simd.splat_u32s(1));
    simd.transmute_f32s_u32s(simd.sub_u32s(simd.splat_u32s(GUESS_F32), third))
}

#[inline(always)]
fn guess_f64s<S: Simd>(_: S, mut x: S::f64s) -> S::f64s {
    for bits in bytemuck::cast_slice_mut::<S::f64s, u64>(std::slice::from_mut(&mut x)) {
        *bits = GUESS_F64.wrapping_sub(*bits / 3);
    }
    x
}

/// 2^k: k + bias in the last bits of a large number, moved to where the exponent stands.
#[inline(always)]
fn power_f32s<S: Simd>(simd: S, k: S::f32s) -> S::f32s {
    let large = simd.add_f32s(k, simd.splat_f32s(1.5 / f32::EPSILON + 127.0));
    let bits = simd.transmute_u32s_f32s(large);
    simd.transmute_f32s_u32s(simd.wrapping_dyn_shl_u32s(bits, simd.splat_u32s(23)))
}

// pulp knows no shifts of 64 bits: compilers find the vector instruction for such a loop
#[inline(always)]
fn power_f64s<S: Simd>(_: S, mut k: S::f64s) -> S::f64s {
    for k in bytemuck::cast_slice_mut::<S::f64s, f64>(std::slice::from_mut(&mut k)) {
        *k = Real::power_of_two(*k);
    }
    k
}

/// Mantissa in [√½, √2) and exponent.
#[inline(always)]
fn split_f32s<S: Simd>(simd: S, x: S::f32s) -> (S::f32s, S::f32s) {
    // 2²³ with the exponent and its bias in the last bits
    const LARGE: f32 = 8_388_608.0;
    let shifted = simd.add_u32s(simd.transmute_u32s_f32s(x), simd.splat_u32s(ONE_F32 - ROOT_HALF_F32));
    let mantissa = simd.add_u32s(simd.and_u32s(shifted, simd.splat_u32s(0x007f_ffff)), simd.splat_u32s(ROOT_HALF_F32));
    let places = simd.wrapping_dyn_shr_u32s(shifted, simd.splat_u32s(23));
    let exponent = simd.transmute_f32s_u32s(simd.or_u32s(places, simd.splat_u32s(LARGE.to_bits())));
    (simd.transmute_f32s_u32s(mantissa), simd.sub_f32s(exponent, simd.splat_f32s(LARGE + 127.0)))
}

#[inline(always)]
fn split_f64s<S: Simd>(simd: S, x: S::f64s) -> (S::f64s, S::f64s) {
    const LARGE: f64 = 4_503_599_627_370_496.0;
    let (mut mantissa, mut exponent) = (x, x);
    for bits in bytemuck::cast_slice_mut::<S::f64s, u64>(std::slice::from_mut(&mut mantissa)) {
        *bits = ((*bits).wrapping_add(ONE_F64 - ROOT_HALF_F64) & 0x000f_ffff_ffff_ffff) + ROOT_HALF_F64;
    }
    for bits in bytemuck::cast_slice_mut::<S::f64s, u64>(std::slice::from_mut(&mut exponent)) {
        *bits = (*bits).wrapping_add(ONE_F64 - ROOT_HALF_F64) >> 52 | LARGE.to_bits();
    }
    (mantissa, simd.sub_f64s(exponent, simd.splat_f64s(LARGE + 1023.0)))
}

vector!(
    F32s,
    f32,
    f32s,
    F32_LANES,
    as_simd_f32s,
    as_mut_simd_f32s,
    splat_f32s,
    add_f32s,
    sub_f32s,
    mul_f32s,
    div_f32s,
    xor_f32s,
    max_f32s,
    mul_add_e_f32s,
    guess_f32s,
    STEPS_F32,
    min_f32s,
    sqrt_f32s,
    greater_than_f32s,
    select_u32s,
    transmute_u32s_f32s,
    transmute_f32s_u32s,
    power_f32s,
    split_f32s,
    load_f32s,
    add_f32s,
    partial_load_f32s,
    partial_store_f32s,
    broadcast3_f32s
);
vector!(
    F64s,
    f64,
    f64s,
    F64_LANES,
    as_simd_f64s,
    as_mut_simd_f64s,
    splat_f64s,
    add_f64s,
    sub_f64s,
    mul_f64s,
    div_f64s,
    xor_f64s,
    max_f64s,
    mul_add_e_f64s,
    guess_f64s,
    STEPS_F64,
    min_f64s,
    sqrt_f64s,
    greater_than_f64s,
    select_u64s,
    transmute_u64s_f64s,
    transmute_f64s_u64s,
    power_f64s,
    split_f64s,
    load_f64s,
    add_f64s,
    partial_load_f64s,
    partial_store_f64s,
    broadcast3_f64s
);
