#![allow(clippy::unwrap_used)]

use super::super::preconditioner::Identity;
use super::*;
use crate::backend::cpu::Cpu;
use crate::components::Precision;

/// D + a aᵀ of 40 rows.
fn times(diagonal: &[f64], a: &[f64], p: &Reals, image: &mut Reals) {
    let along: f64 = a.iter().enumerate().map(|(i, a)| a * p.get(i)).sum();
    update(image, |i, _| diagonal[i] * p.get(i) + a[i] * along);
}

fn solved(diagonal: &[f64]) -> (Solved, f64) {
    let count = diagonal.len();
    let a: Vec<f64> = (0..count).map(|i| (i as f64 * 0.7).sin()).collect();
    let b = Reals::F64((0..count).map(|i| 1.0 + (i as f64).cos()).collect());
    let zeros = || Reals::zeros(Precision::F64, count);
    let (sums, mut x) = (Sums::on(&Cpu::new(1, 0, Default::default())), zeros());
    let mut preconditioner = Identity;
    let mut vectors = Vectors([(); 7].map(|()| zeros()));
    let stop = Stop { tolerance: 1e-10, most: 200 };
    let found = solve(&sums, &b, &mut x, &mut vectors, &mut preconditioner, stop, |p, image| {
        times(diagonal, &a, p, image);
        Ok(())
    });
    let mut image = zeros();
    times(diagonal, &a, &x, &mut image);
    let left: f64 = (0..count).map(|i| (image.get(i) - b.get(i)).powi(2)).sum::<f64>().sqrt();
    (found.unwrap(), left)
}

#[test]
fn it_solves_what_is_positive_and_what_is_not_and_tells_which() {
    for negative in [0, 1, 5] {
        let diagonal: Vec<f64> = (0..40).map(|i| if i < negative { -1.0 - i as f64 } else { 1.0 + i as f64 }).collect();
        let (found, left) = solved(&diagonal);
        assert!(found.iterations < 100 && left < 1e-8, "{negative}: {left} of {found:?}");
        // one rank more lifts one eigenvalue at most, and does not lift -1 above 0 here
        assert_eq!(found.gives_way, negative > 0, "{found:?}");
    }
}
