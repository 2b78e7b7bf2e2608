use super::super::Scalar;
use super::*;

fn entries<T: Scalar>(s: [f64; 6]) -> Sym3<T> {
    Sym3(s.map(T::from_f64))
}

/// Largest error of Σ e n nᵀ and of NᵀN, in units of the largest entry of s.
fn error<T: Scalar>(s: [f64; 6]) -> f64 {
    let s = entries::<T>(s);
    let (values, vectors) = s.eigen();
    let largest = s.0.iter().fold(1e-300, |largest: f64, x| largest.max(x.to_f64().abs()));
    let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];
    let mut worst = 0.0_f64;
    for (entry, (i, j)) in pairs.into_iter().enumerate() {
        let n = |axis: usize, i: usize| vectors[axis][i].to_f64();
        let whole: f64 = (0..3).map(|axis| values[axis].to_f64() * n(axis, i) * n(axis, j)).sum();
        let unit: f64 = (0..3).map(|axis| n(i, axis) * n(j, axis)).sum();
        worst = worst.max((whole - s.0[entry].to_f64()).abs() / largest);
        worst = worst.max((unit - f64::from(u8::from(i == j))).abs());
    }
    worst
}

#[test]
fn eigenvalues_and_vectors_make_the_matrix_again() {
    // a pseudo-random walk through entries of very different size, signs, and equal entries
    let mut state = 1_u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let size = [1.0, 1.0, 1e-3, 1e-7, 0.0, 1.0, 30.0, 1e-12][(state >> 40) as usize % 8];
        size * ((state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    };
    let (mut single, mut double) = (0.0_f64, 0.0_f64);
    for i in 0..40_000 {
        let mut s = [number(), number(), number(), number(), number(), number()];
        if i % 5 == 0 {
            s[1] = s[0];
        }
        if i % 7 == 0 {
            (s[2], s[4]) = (s[0], s[3]);
        }
        single = single.max(error::<f32>(s));
        double = double.max(error::<f64>(s));
    }
    println!("f32 {:.1} ε, f64 {:.1} ε", single / f64::from(f32::EPSILON), double / f64::EPSILON);
    assert!(single < 16.0 * f64::from(f32::EPSILON), "{single:e}");
    assert!(double < 16.0 * f64::EPSILON, "{double:e}");
}

#[test]
fn matrices_of_nothing_and_of_next_to_nothing_have_eigenvectors_too() {
    for size in [0.0, 1e-45, 1e-38, 1e-30, 1e-20, 1e-18, 1e-10] {
        let s = [size, -size, 0.3 * size, 0.7 * size, size, -0.2 * size];
        let (values, vectors) = entries::<f32>(s).eigen();
        for axis in 0..3 {
            let length: f32 = vectors[axis].iter().map(|x| x * x).sum();
            assert!((length - 1.0).abs() < 1e-6, "{size:e}: {length}");
            assert!(f64::from(values[axis].abs()) <= 3.0 * size, "{size:e}: {values:?}");
        }
    }
}
