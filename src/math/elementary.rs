//! Exponential and logarithm over any [`Real`], without a branch: arithmetic and a few moved bits, so that a register
//! of numbers costs what one does, and the GPU's twin (`shaders/elementary.wgsl`) makes the same digits.

use super::Real;

/// Taylor terms 1/(n+2)! of (e^r − 1 − r)/r²: for |r| ≤ ½ ln 2 six leave an error of 2e-8 of r (f32), twelve of 1e-17.
const EXPONENTIAL: [f64; 12] = [
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5040.0,
    1.0 / 40320.0,
    1.0 / 362880.0,
    1.0 / 3628800.0,
    1.0 / 39916800.0,
    1.0 / 479001600.0,
    1.0 / 6227020800.0,
];

const fn is_single<R: Real>() -> bool {
    R::EPSILON > 1e-10
}

/// ln 2 as a sum: the first has so many zeros at its end that its product with an exponent is exact.
#[inline(always)]
fn ln_2<R: Real>(like: R) -> (R, R) {
    let (high, low) = if is_single::<R>() {
        (6.931_381_225_6e-1, 9.058_000_614_5e-6)
    } else {
        (6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10)
    };
    (like.constant(high), like.constant(low))
}

/// 2^k and e^r − 1 with x = k ln 2 + r, |r| ≤ ½ ln 2.
#[inline(always)]
fn reduced<R: Real>(x: R) -> (R, R) {
    let (lowest, highest, terms) = if is_single::<R>() { (-87.0, 88.0, 6) } else { (-708.0, 709.0, 12) };
    let x = x.max(x.constant(lowest)).min(x.constant(highest));
    let k = (x * x.constant(std::f64::consts::LOG2_E)).round();
    let (high, low) = ln_2(x);
    let r = (x - k * high) - k * low;
    let mut q = x.constant(EXPONENTIAL[terms - 1]);
    for n in (0..terms - 1).rev() {
        q = q.mul_add(r, x.constant(EXPONENTIAL[n]));
    }
    (k.power_of_two(), (r * r).mul_add(q, r))
}

#[inline(always)]
pub(super) fn exp<R: Real>(x: R) -> R {
    let (scale, p) = reduced(x);
    scale.mul_add(p, scale)
}

#[inline(always)]
pub(super) fn exp_m1<R: Real>(x: R) -> R {
    let (scale, p) = reduced(x);
    scale.mul_add(p, scale - x.constant(1.0))
}

/// k ln 2 + ln(1 + f), 1 + f in [√½, √2): ln(1 + f) = 2 artanh s, s = f/(2 + f), |s| ≤ .172, by its series in s².
/// Five terms leave an error of 2e-9 of it (f32), eleven of 1e-18.
#[inline(always)]
fn logarithm<R: Real>(k: R, f: R) -> R {
    let terms = if is_single::<R>() { 5 } else { 11 };
    let s = f / (f.constant(2.0) + f);
    let square = s * s;
    let mut q = f.constant(2.0 / (2 * terms - 1) as f64);
    for n in (1..terms - 1).rev() {
        q = q.mul_add(square, f.constant(2.0 / (2 * n + 1) as f64));
    }
    // 2s = f − s f: the leading term without the rounding of s
    let (high, low) = ln_2(f);
    let tail = s * square.mul_add(q, -f);
    k.mul_add(high, f + k.mul_add(low, tail))
}

#[inline(always)]
pub(super) fn ln<R: Real>(x: R) -> R {
    let (mantissa, k) = x.mantissa_and_exponent();
    logarithm(k, mantissa - x.constant(1.0))
}

/// With k = 0, f is x itself: what 1 + x rounds away is never missed, and no compiler can spoil a compensation.
#[inline(always)]
pub(super) fn ln_1p<R: Real>(x: R) -> R {
    let one = x.constant(1.0);
    let (mantissa, k) = (one + x).mantissa_and_exponent();
    let f = (x.constant(0.5) - k.abs()).if_positive(x, mantissa - one);
    logarithm(k, f)
}

#[cfg(test)]
mod tests;
