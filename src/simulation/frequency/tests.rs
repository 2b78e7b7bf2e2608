use super::*;

#[test]
fn ritz_values_reach_the_margin_and_never_pass_the_eigenvalue() {
    // eigenvalues crowded below the largest: Chebyshev points, where Lanczos' recursion has it hardest
    // where vectors are kept, and where they are not
    for (size, products) in [(300, 20), (700, 40), (1500, 80), (3000, 20), (3000, 40), (3000, 80)] {
        let eigenvalue = |i: usize| 0.5 - 0.5 * (std::f64::consts::PI * (i as f64 + 0.5) / size as f64).cos();
        let largest = eigenvalue(size - 1);
        let luck = (1.648 * (size as f64).sqrt() / BAD_LUCK).ln();
        let found = lanczos(
            noise(&vec![1.0; size]),
            products,
            None,
            |x, image| {
                (0..size).for_each(|i| image[i] = eigenvalue(i) * x[i]);
            },
            |_, _| true,
        );
        let found = found.map_or(0.0, |found| found.largest);
        let margin = (luck / (2.0 * products as f64 - 1.0)).powi(2);
        assert!(found <= largest * (1.0 + 1e-12) && found >= (1.0 - margin) * largest, "{products}: {found}");
    }
}

#[test]
fn a_largest_eigenvalue_that_stands_out_is_found_though_vectors_are_not_kept() {
    // it converges within some products, and what rounding brings back of it stays at most as large
    let size = 5000;
    let eigenvalue = |i: usize| if i == 17 { 10.0 } else { (i % 100) as f64 / 100.0 };
    let found = lanczos(
        noise(&vec![1.0; size]),
        100,
        None,
        |x, image| {
            (0..size).for_each(|i| image[i] = eigenvalue(i) * x[i]);
        },
        |_, _| true,
    );
    let found = found.map_or(0.0, |found| found.largest);
    assert!((found / 10.0 - 1.0).abs() < 1e-12, "{found}");
}

#[test]
fn a_space_that_is_exhausted_gives_the_eigenvalue_itself() {
    let eigenvalues = [3.0, 1.0, 3.0, 2.0, 0.0];
    let found = lanczos(
        noise(&[1.0; 5]),
        50,
        None,
        |x, image| (0..5).for_each(|i| image[i] = eigenvalues[i] * x[i]),
        |_, _| true,
    );
    assert!(found.is_some_and(|found| found.exhausted && (found.largest - 3.0).abs() < 1e-9));
}

#[test]
fn the_eigenvector_of_the_recursion_gives_its_eigenvalue() {
    let eigenvalue = |i: usize| (i % 37) as f64;
    let mut kept = Vec::new();
    let times = |x: &[f64], image: &mut [f64]| (0..500).for_each(|i| image[i] = eigenvalue(i) * x[i]);
    let found = lanczos(noise(&[1.0; 500]), 12, Some(&mut kept), times, |_, _| true);
    let (largest, shares) = found.map_or((0.0, Vec::new()), |found| (found.largest, eigenvector(&found)));
    let ritz: Vec<f64> =
        (0..500).map(|i| shares.iter().zip(&kept).map(|(share, basis)| share * basis[i]).sum()).collect();
    let quotient = (0..500).map(|i| eigenvalue(i) * ritz[i] * ritz[i]).sum::<f64>() / dot(&ritz, &ritz);
    assert!((quotient / largest - 1.0).abs() < 1e-6, "{quotient}, not {largest}");
}
