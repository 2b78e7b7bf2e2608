use super::*;

#[test]
fn sizes_are_traces_of_c_and_of_its_inverse_or_where_the_volume_has_grown_its_cofactors() {
    // stretches 2, 3 and ¼, turned about z by 90°: J = 1.5; then 2, ½ and ¼
    let f = [[0.0, -3.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 0.25]];
    let [first, inverse, _] = sizes(&f, true);
    assert!((first - (4.0 + 9.0 + 0.0625) / 3.0_f64).abs() < 1e-14);
    assert!((inverse - 1.5 * 1.5 * (0.25 + 1.0 / 9.0 + 16.0) / 3.0_f64).abs() < 1e-14);
    let [_, smaller, _] = sizes(&[[0.0, -0.5, 0.0], f[1], f[2]], true);
    assert!((smaller - (0.25 + 4.0 + 16.0) / 3.0_f64).abs() < 1e-14);
    assert_eq!(right_cauchy_green(&f), [4.0, 9.0, 0.0625, 0.0, 0.0, 0.0]);
}

#[test]
fn squeeze_is_the_inverse_square_of_the_stretch_where_one_axis_is_squeezed() {
    let f = [[0.5, 0.0, 0.0], [0.0, 0.0, -1.25], [0.0, 1.25, 0.0]];
    let [[.., of_inverse], [.., of_cofactor]] = [sizes(&f, true), sizes(&f, false)];
    assert!((of_inverse - 4.0_f64).abs() < 1e-14 && (of_cofactor - 1.25_f64.powi(4)).abs() < 1e-14);
}

#[test]
fn turning_changes_no_strain_and_stretching_does() {
    let f = [[1.2, 0.3, 0.0], [-0.1, 0.9, 0.2], [0.05, 0.0, 1.1]];
    // w × F: a rigid turn of the present shape
    let w = [0.3, -0.2, 0.5];
    let spun = |i: usize, j: usize| w[(i + 1) % 3] * f[(i + 2) % 3][j] - w[(i + 2) % 3] * f[(i + 1) % 3][j];
    let turn = Mat3(std::array::from_fn(|i| std::array::from_fn(|j| spun(i, j))));
    assert!(change_of_strain(&f, &turn).abs() < 1e-30_f64);
    // F grows by a hundredth: E by (F^T F)/100, component by component
    let grown = Mat3(f.map(|row| row.map(|x: f64| 0.01 * x)));
    let [xx, yy, zz, xy, yz, xz] = right_cauchy_green(&f);
    let expected = 1e-4 * (xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + xz * xz));
    assert!((change_of_strain(&f, &grown) / expected - 1.0).abs() < 1e-12);
}
