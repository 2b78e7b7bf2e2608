use super::*;

fn motions_of(held: &[(usize, usize)]) -> Vec<[DVec3; 2]> {
    let corners = (0..8).map(|i| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) - 0.5);
    let nodes: Vec<(usize, DVec3)> = corners.enumerate().collect();
    let mut free = vec![true; 24];
    held.iter().for_each(|(node, axis)| free[3 * node + axis] = false);
    without_constraint(&nodes, 1.0, &free)
}

#[test]
fn what_slides_on_a_plane_has_two_translations_and_a_turn() {
    let found = motions_of(&[(0, 2), (1, 2), (2, 2), (3, 2)]);
    assert_eq!(found, [[DVec3::Z, DVec3::ZERO], [DVec3::ZERO, DVec3::X], [DVec3::ZERO, DVec3::Y]]);
}

#[test]
fn a_hinge_leaves_a_turn_about_it() {
    // the edge at x = y = -1/2
    let held: Vec<(usize, usize)> = [0, 4].into_iter().flat_map(|node| (0..3).map(move |axis| (node, axis))).collect();
    let found = motions_of(&held);
    assert_eq!(found.len(), 1, "{found:?}");
    let [w, t] = found[0];
    let through = w.cross(t) / w.length_squared();
    assert!(w.truncate().length() < 1e-12 && (through - DVec3::new(-0.5, -0.5, 0.0)).length() < 1e-12, "{found:?}");
}

#[test]
fn what_is_held_is_held_and_what_is_not_is_free() {
    assert_eq!(motions_of(&[]).len(), 6);
    assert_eq!(motions_of(&[(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]).len(), 0);
    // a node held is a joint
    assert_eq!(motions_of(&[(3, 0), (3, 1), (3, 2)]).len(), 3);
}
