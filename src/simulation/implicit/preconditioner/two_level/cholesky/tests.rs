#![allow(clippy::unwrap_used)]
use super::*;
use crate::backend::cpu::Instructions;

fn cpu(threads: usize) -> Cpu {
    Cpu::new(threads, usize::MAX, Instructions::Widest)
}

/// Rows up to the diagonal of A = G Gᵀ of a made-up G of full rank, or of one of whose rows one is the sum of two
/// others.
fn matrix(size: usize, lacking: bool) -> (Vec<f64>, impl Fn(usize, usize) -> f64) {
    let g = |i: usize, j: usize| ((i * 7 + j * 3) as f64 * (1.0 + 0.3 * (i as f64).sqrt())).sin();
    let mut rows: Vec<Vec<f64>> =
        (0..size).map(|i| (0..2 * size).map(|j| g(i, j) + f64::from(u8::from(j == size + i))).collect()).collect();
    if lacking {
        rows[20] = (0..2 * size).map(|j| rows[5][j] + rows[6][j]).collect();
    }
    let entry = move |i: usize, j: usize| rows[i].iter().zip(&rows[j]).map(|(a, b)| a * b).sum::<f64>();
    ((0..size).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| entry(i, j)).collect(), entry)
}

#[test]
fn solution_solves_the_system_also_where_an_unknown_depends_on_others() {
    // within a group of rows, of several, and of some that are no multiple of those side by side
    for (size, lacking) in [(37, false), (37, true), (151, false), (151, true)] {
        let (lower, entry) = matrix(size, lacking);
        let x: Vec<f64> = (0..size).map(|i| (i as f64 * 0.9).cos()).collect();
        let b: Vec<f64> = (0..size).map(|i| (0..size).map(|j| entry(i, j) * x[j]).sum()).collect();
        let mut found = b.clone();
        let mut factor = Cholesky::of(&cpu(1), lower, size);
        factor.solve(&cpu(1), &mut found);
        for (unknown, x) in found.iter().enumerate() {
            let column = factor.column(unknown);
            let (by_inverse, scale) =
                (dot(&column, &b), column.iter().zip(&b).map(|(a, b)| (a * b).abs()).sum::<f64>());
            assert!((by_inverse - x).abs() <= 1e-9 * (scale + x.abs()), "{lacking}: {by_inverse}, not {x}");
        }
        assert!(!lacking || found[20] == 0.0);
        for i in 0..size {
            let again: f64 = (0..size).map(|j| entry(i, j) * found[j]).sum();
            assert!((again - b[i]).abs() < 1e-8 * entry(i, i), "{size}, {lacking}, {i}: {again} {}", b[i]);
        }
    }
}

/// Of a size that several tasks and groups of rows share.
#[test]
fn any_number_of_threads_finds_the_same_bits() {
    let size = 403;
    let (lower, _) = matrix(size, false);
    let b: Vec<f64> = (0..size).map(|i| (i as f64 * 0.7).sin()).collect();
    let found = [1, 2, 3].map(|threads| {
        let cpu = cpu(threads);
        let mut factor = Cholesky::of(&cpu, lower.clone(), size);
        let mut x = b.clone();
        factor.solve(&cpu, &mut x);
        assert!(factor.tasks.len() > 1);
        x.iter().map(|x| x.to_bits()).collect::<Vec<u64>>()
    });
    assert!(found[0] == found[1] && found[0] == found[2]);
}
