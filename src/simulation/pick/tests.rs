use super::*;

#[test]
fn a_ray_meets_a_triangle_from_both_sides_and_not_beside_it() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let (distance, weights) = Pick::meet(DVec3::new(0.25, 0.5, 3.0), -DVec3::Z, corners).unwrap_or_default();
    assert_eq!((distance, weights), (3.0, [0.25, 0.25, 0.5]));
    assert!(Pick::meet(DVec3::new(0.25, 0.5, -3.0), DVec3::Z, corners).is_some());
    assert_eq!(Pick::meet(DVec3::new(0.25, 0.5, 3.0), DVec3::Z, corners), None);
    assert_eq!(Pick::meet(DVec3::new(0.75, 0.5, 3.0), -DVec3::Z, corners), None);
    assert_eq!(Pick::meet(DVec3::new(0.25, 0.5, 3.0), DVec3::X, corners), None);
    assert_eq!(Pick::meet(DVec3::new(-1.0, 0.5, 0.0), DVec3::X, corners), None);
}
