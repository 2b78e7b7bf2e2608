use super::*;
use crate::contact::Surfaces;

/// Beyond a side of a face one of its corners has less than nothing of the place there, and so a weight above 0 against
/// the point, as the point's own nodes have: the mass that a spring presses on is of these alone.
#[test]
fn what_a_face_has_beyond_its_sides_is_none_of_the_point() {
    let triangles = Surfaces::new(7, vec![[0, 1, 2]], vec![0], vec![1.0]);
    let surface = Surface { triangles, ..Surface::default() };
    let weights = [0.55, -0.05, 0.5];
    let facing = Facing { triangle: 0, weights, at: DVec3::ZERO, normal: DVec3::Z, gap: 0.0, part: 0 };
    let node = Point::node(1, 3);
    let of_face = Point { body: 1, nodes: [3, 4, 5, 6], weights: &[0.25; 4], triangle: Some(0) };
    for (point, own) in [(node, 1), (of_face, 4)] {
        let (nodes, points) = surface.between(&point, &facing);
        assert!(nodes[..points].iter().copied().eq(point.parts()), "{nodes:?}, {points}");
        assert_eq!(points, own);
        assert_eq!(nodes[points..], [(0, -0.55), (1, 0.05), (2, -0.5), (2, -0.0)]);
    }
}
