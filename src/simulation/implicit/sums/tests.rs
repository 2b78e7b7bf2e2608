use super::*;
use crate::backend::cpu::Instructions;

#[test]
fn sums_have_the_same_bits_on_any_number_of_threads() {
    let a: Vec<f64> = (0..400_000).map(|i| (i as f64 * 0.37).sin() * 10_f64.powi(i % 9)).collect();
    let b: Vec<f64> = (0..400_000).map(|i| (i as f64 * 0.73).cos()).collect();
    let found = [1, 2, 3, 4].map(|threads| Sums::on(&Cpu::new(threads, 0, Instructions::Widest)).dot(&a, &b).to_bits());
    assert!(found.iter().all(|bits| *bits == found[0]), "{found:?}");
    let exact: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
    assert!((f64::from_bits(found[0]) - exact).abs() < 1e-9 * exact.abs().max(1e8));
}
