use super::*;

#[test]
fn lowest_eigenvalues_are_found_with_their_multiplicity() {
    // eigenvalues 1, 1, 4, 9, 9, 9, 16 ... far below the largest of 1e5
    let known = [1.0, 1.0, 4.0, 9.0, 9.0, 9.0, 16.0, 25.0];
    let size = 600;
    let eigenvalue = |i: usize| if i < known.len() { known[i] } else { 30.0 + 1e5 * (i as f64 / size as f64).powi(2) };
    let found = lowest(&vec![1.0; size], 7, 1.01e5, |x, y| (0..size).for_each(|i| y[i] = eigenvalue(i) * x[i]));
    for (pair, known) in found.iter().zip(known) {
        assert!((pair.value / known - 1.0).abs() < 1e-8 && pair.residual <= TOLERANCE, "{} of {known}", pair.value);
    }
}
