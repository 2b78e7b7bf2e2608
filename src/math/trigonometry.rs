//! Sine and cosine over any [`Real`], without a branch.

use super::Real;

/// Taylor terms (−1)ⁿ/(2n + 1)! of (sin r − r)/r³: for |r| ≤ π/2 six leave an error of 7e-10 (f32), ten of 2e-18.
const SINE: [f64; 10] = [
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 355_687_428_096_000.0,
    -1.0 / 121_645_100_408_832_000.0,
    1.0 / 51_090_942_171_709_440_000.0,
];

/// π as a sum: the first two have so many zeros at their ends that their products with numbers of half turns are exact,
/// up to 4000 half turns in f32 and 1e9 in f64 (Cody and Waite).
const fn pi(single: bool) -> [f64; 3] {
    match single {
        true => [3.140_625, 9.675_025_939_941_406e-4, 1.509_957_990_978_376_4e-7],
        false => [3.141_592_502_593_994, 1.509_957_883_172_319_3e-7, 1.078_060_571_631_623_8e-14],
    }
}

/// (−1)ⁿ sin(x − kπ) for the whole number n that k is, or is ½ more than.
#[inline(always)]
fn sine_of_the_rest<R: Real>(x: R, k: R, n: R) -> R {
    let single = R::EPSILON > 1e-10;
    let mut r = x;
    for part in pi(single) {
        r -= k * x.constant(part);
    }
    let square = r * r;
    let terms = if single { 6 } else { 10 };
    let mut q = x.constant(SINE[terms - 1]);
    for term in (0..terms - 1).rev() {
        q = q.mul_add(square, x.constant(SINE[term]));
    }
    let sine = (r * square).mul_add(q, r);
    let odd = (n - (n * x.constant(0.5)).round() * x.constant(2.0)).abs();
    sine * (x.constant(1.0) - x.constant(2.0) * odd)
}

#[inline(always)]
pub(super) fn sin<R: Real>(x: R) -> R {
    let k = (x * x.constant(std::f64::consts::FRAC_1_PI)).round();
    sine_of_the_rest(x, k, k)
}

/// cos(r + (n + ½)π) = −(−1)ⁿ sin r.
#[inline(always)]
pub(super) fn cos<R: Real>(x: R) -> R {
    let half = x.constant(0.5);
    let n = (x * x.constant(std::f64::consts::FRAC_1_PI) - half).round();
    -sine_of_the_rest(x, n + half, n)
}

#[cfg(test)]
mod tests;
