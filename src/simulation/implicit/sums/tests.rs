use super::*;
use crate::backend::cpu::Instructions;
use crate::components::Precision;

#[test]
fn sums_have_the_same_bits_on_any_number_of_threads() {
    for precision in [Precision::F32, Precision::F64] {
        let a = Reals::from_f64(precision, (0..400_000).map(|i| (i as f64 * 0.37).sin() * 10_f64.powi(i % 9)));
        let b = Reals::from_f64(precision, (0..400_000).map(|i| (i as f64 * 0.73).cos()));
        let on = |threads: usize| Sums::on(&Cpu::new(threads, 0, Instructions::Widest));
        let found = [1, 2, 3, 4].map(|threads| on(threads).dot(&a, &b).to_bits());
        assert!(found.iter().all(|bits| *bits == found[0]), "{found:?}");
        let exact: f64 = (0..a.len()).map(|i| a.get(i) * b.get(i)).sum();
        assert!((f64::from_bits(found[0]) - exact).abs() < 1e-9 * exact.abs().max(1e8));
    }
}
