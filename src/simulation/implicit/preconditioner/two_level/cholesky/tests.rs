use super::*;

/// A = G Gᵀ of a made-up G of full rank, and of one of whose rows one is the sum of two others.
#[test]
fn solution_solves_the_system_also_where_an_unknown_depends_on_others() {
    let size = 37;
    for lacking in [0, 1] {
        let g = |i: usize, j: usize| ((i * 7 + j * 3) as f64 * (1.0 + 0.3 * (i as f64).sqrt())).sin();
        let mut rows: Vec<Vec<f64>> =
            (0..size).map(|i| (0..2 * size).map(|j| g(i, j) + f64::from(u8::from(j == size + i))).collect()).collect();
        if lacking == 1 {
            rows[20] = (0..2 * size).map(|j| rows[5][j] + rows[6][j]).collect();
        }
        let entry = |i: usize, j: usize| dot(&rows[i], &rows[j]);
        let lower = (0..size).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| entry(i, j)).collect();
        let x: Vec<f64> = (0..size).map(|i| (i as f64 * 0.9).cos()).collect();
        let b: Vec<f64> = (0..size).map(|i| (0..size).map(|j| entry(i, j) * x[j]).sum()).collect();
        let mut found = b.clone();
        let factor = Cholesky::of(lower, size);
        factor.solve(&mut found);
        let inverse = factor.inverse();
        for (row, x) in inverse.chunks_exact(size).zip(&found) {
            let (by_inverse, scale) = (dot(row, &b), row.iter().zip(&b).map(|(a, b)| (a * b).abs()).sum::<f64>());
            assert!((by_inverse - x).abs() <= 1e-9 * (scale + x.abs()), "{lacking}: {by_inverse}, not {x}");
        }
        assert!(lacking == 0 || found[20] == 0.0);
        for i in 0..size {
            let again: f64 = (0..size).map(|j| entry(i, j) * found[j]).sum();
            assert!((again - b[i]).abs() < 1e-8 * entry(i, i), "{lacking}, {i}: {again} {}", b[i]);
        }
    }
}
