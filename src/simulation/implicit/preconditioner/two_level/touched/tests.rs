use super::*;

/// A matrix of 3 aggregates, rows up to the diagonal; the unknowns of two of them are touched.
#[test]
fn what_springs_add_is_as_in_a_matrix_with_them() {
    let size = 3 * RIGID;
    let entry = |i: usize, j: usize| {
        let spread = ((i * 7 + j * 7) as f64).sin() * 0.1;
        if i == j { 2.0 + (i as f64 * 0.7).cos() } else { spread }
    };
    let lower = |more: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        (0..size).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| entry(i, j) + more(i, j)).collect()
    };
    let touched = [0, 2];
    // a bᵀ + … of two springs, one of which couples both aggregates: not of full rank
    let ways: [Vec<f64>; 2] = [1.0, 2.3].map(|seed: f64| {
        (0..size).map(|i| if touched.contains(&(i / RIGID)) { (seed * (i as f64 + 1.0)).sin() } else { 0.0 }).collect()
    });
    let spring = |i: usize, j: usize| 50.0 * ways[0][i] * ways[0][j] + 3.0 * ways[1][i] * ways[1][j];
    let with = Cholesky::of(lower(&spring), size);
    let without = Cholesky::of(lower(&|_, _| 0.0), size);
    let unknowns: Vec<usize> = touched.iter().flat_map(|a| RIGID * a..RIGID * (a + 1)).collect();
    let stiffness = unknowns.iter().flat_map(|&i| unknowns.iter().map(move |&j| (i, j))).map(|(i, j)| spring(i, j));
    let mut small = Touched::default();
    small.take(&touched, stiffness.collect(), &without, size);
    let mut x: Vec<f64> = (0..size).map(|i| (i as f64 * 1.3).cos()).collect();
    let mut expected = x.clone();
    with.solve(&mut expected);
    without.solve(&mut x);
    let before = x.clone();
    small.correct(&mut x);
    let off = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off(&before, &expected) > 1e-2);
    assert!(off(&x, &expected) < 1e-12, "{}", off(&x, &expected));
    // gone again
    small.take(&[], Vec::new(), &without, size);
    let mut again = before.clone();
    small.correct(&mut again);
    assert_eq!(again, before);
}
