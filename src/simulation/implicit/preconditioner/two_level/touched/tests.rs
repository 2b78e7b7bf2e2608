use super::super::cholesky::Cholesky;
use super::*;
use crate::backend::cpu::{Cpu, Instructions};

/// Matrices of 3 aggregates, all of one piece or the last of another; the unknowns of two of them are touched.
#[test]
fn what_springs_add_is_as_in_a_matrix_with_them() {
    let cpu = Cpu::new(1, 0, Instructions::Widest);
    let size = 3 * RIGID;
    for first_piece in [3, 2] {
        let piece = |i: usize| usize::from(i / RIGID >= first_piece);
        let entry = |i: usize, j: usize| {
            let spread = if piece(i) == piece(j) { ((i * 7 + j * 7) as f64).sin() * 0.1 } else { 0.0 };
            if i == j { 2.0 + (i as f64 * 0.7).cos() } else { spread }
        };
        let factor = |range: std::ops::Range<usize>, more: &dyn Fn(usize, usize) -> f64| {
            let (first, count) = (range.start, range.len());
            let places = range.flat_map(|i| (first..=i).map(move |j| (i, j)));
            Cholesky::of(&cpu, places.map(|(i, j)| entry(i, j) + more(i, j)).collect(), count)
        };
        let touched = [0, 2];
        // a bᵀ + … of two springs, one of which couples both aggregates: not of full rank
        let ways: [Vec<f64>; 2] = [1.0, 2.3].map(|seed: f64| {
            let way = |i: usize| if touched.contains(&(i / RIGID)) { (seed * (i as f64 + 1.0)).sin() } else { 0.0 };
            (0..size).map(way).collect()
        });
        let spring = |i: usize, j: usize| 50.0 * ways[0][i] * ways[0][j] + 3.0 * ways[1][i] * ways[1][j];
        let unknowns: Vec<usize> = touched.iter().flat_map(|a| RIGID * a..RIGID * (a + 1)).collect();
        let stiffness = unknowns.iter().flat_map(|&i| unknowns.iter().map(move |&j| (i, j)));
        let stiffness = stiffness.map(|(i, j)| spring(i, j)).collect();
        let columns = |aggregate: usize| {
            let first = if aggregate >= first_piece { RIGID * first_piece } else { 0 };
            let range = if first > 0 { first..size } else { 0..RIGID * first_piece };
            let without = factor(range, &|_, _| 0.0);
            let own = RIGID * aggregate - first..RIGID * (aggregate + 1) - first;
            (first, own.map(|unknown| without.column(unknown)).collect())
        };
        let mut small = Touched::default();
        small.take(&touched, stiffness, columns);
        let b: Vec<f64> = (0..size).map(|i| (i as f64 * 1.3).cos()).collect();
        let (mut expected, mut before) = (b.clone(), b.clone());
        factor(0..size, &spring).solve(&cpu, &mut expected);
        factor(0..size, &|_, _| 0.0).solve(&cpu, &mut before);
        let mut x = before.clone();
        small.correct(&mut x);
        let off = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off(&before, &expected) > 1e-2);
        assert!(off(&x, &expected) < 1e-12, "{}", off(&x, &expected));
        // gone again
        small.take(&[], Vec::new(), columns);
        x.clone_from(&before);
        small.correct(&mut x);
        assert_eq!(x, before);
    }
}
