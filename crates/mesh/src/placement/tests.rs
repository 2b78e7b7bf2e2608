use super::*;

#[test]
fn angles_make_the_rotation_that_they_are_of() {
    for degrees in [(0.0, 0.0, 0.0), (10.0, -70.0, 160.0), (200.0, 90.0, 30.0), (40.0, -90.0, 0.0), (0.0, 180.0, 90.0)]
    {
        let turn = rotation_about_axes(degrees.into());
        let again = rotation_about_axes(angles_about_axes(turn));
        assert!((turn - again).to_cols_array().iter().all(|part| part.abs() < 1e-15), "{degrees:?}");
    }
}
