use crate::topology::hex8::scaled_jacobian;
use crate::topology::tet4::{mean_ratio, volume as tet_volume};
use glam::DVec3;

#[test]
fn regular_elements_have_the_quality_one() {
    let tet = [(1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0)];
    let tet = tet.map(|(x, y, z)| DVec3::new(x, y, z));
    let right = if tet_volume(tet) > 0.0 { tet } else { [tet[1], tet[0], tet[2], tet[3]] };
    assert!((mean_ratio(right) - 1.0).abs() < 1e-14);
    assert!((mean_ratio([right[1], right[0], right[2], right[3]]) + 1.0).abs() < 1e-14, "inside out is below 0");
    let cube = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    let cube = cube.map(|[x, y, z]| DVec3::new(f64::from(x), 2.0 * f64::from(y), 3.0 * f64::from(z)));
    assert!((scaled_jacobian(cube) - 1.0).abs() < 1e-14);
    // sheared by 45°: the angle between two edges at each corner has the sine of 45°
    let sheared = cube.map(|p| p + DVec3::new(p.z, 0.0, 0.0));
    assert!((scaled_jacobian(sheared) - 0.5_f64.sqrt()).abs() < 1e-14);
}
