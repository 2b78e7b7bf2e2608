use super::*;

#[test]
fn small_systems_are_solved_and_what_they_do_not_say_is_zero() {
    let matrix = vec![vec![4.0, 2.0, 0.0], vec![2.0, 5.0, 1.0], vec![0.0, 1.0, 3.0]];
    let found = solve(matrix.clone(), vec![2.0, -3.0, 7.0]);
    for (row, right) in matrix.iter().zip([2.0, -3.0, 7.0]) {
        let product: f64 = row.iter().zip(&found).map(|(a, x)| a * x).sum();
        assert!((product - right).abs() < 1e-12, "{found:?}");
    }
    assert_eq!(solve(vec![vec![2.0, 2.0], vec![2.0, 2.0]], vec![4.0, 4.0]).iter().sum::<f64>(), 2.0);
    assert!(solve(vec![], vec![]).is_empty());
}
