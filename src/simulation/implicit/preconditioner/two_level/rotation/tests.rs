#![allow(clippy::unwrap_used)]
use super::*;
use glam::{DQuat, DVec3};

#[test]
fn turned_nodes_tell_their_rotation_in_space_and_in_a_plane_but_not_on_a_line() {
    for turn in [0.0, 0.02, 1.0, 3.1] {
        let exact = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(0.48, 0.6, -0.64), turn));
        for flat in [1.0, 0.0] {
            let place = |i: usize| {
                let i = i as f64;
                DVec3::new((3.0 * i).sin(), (5.0 * i).cos(), flat * (7.0 * i).sin()) * 1e-3
            };
            let a = (0..20).fold(DMat3::ZERO, |a, i| {
                let (rest, x) = (place(i), exact * place(i));
                a + DMat3::from_cols(x * rest.x, x * rest.y, x * rest.z)
            });
            let found = rotation(a).unwrap();
            assert!(size(&(found - exact)) < 1e-11, "{turn}, {flat}: {found}");
            assert!((angle(&found) - turn).abs() < 1e-7);
        }
    }
    let line = DVec3::new(1e-3, 2e-3, 0.0);
    assert!(rotation(DMat3::from_cols(line * line.x, line * line.y, line * line.z)).is_none());
    assert!(rotation(DMat3::ZERO).is_none());
}
