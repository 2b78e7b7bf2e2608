use super::*;

/// Beyond a side of a face one of its corners has less than nothing of the place there, and so a weight above 0 here,
/// as the point's own nodes have.
#[test]
fn what_a_face_has_beyond_its_sides_is_none_of_the_point() {
    let meeting = Meeting {
        friction: [0.0; 2],
        thickness: 0.0,
        faces: false,
        edges: false,
        spring: None,
        edge: 1.0,
        settling: 0.0,
    };
    let pair = Pair {
        meeting,
        point: 7,
        first: true,
        normal: DVec3::Z,
        nodes: SmallVec::from_slice(&[(7, 1.0), (1, 0.05), (2, -0.45), (3, -0.6)]),
        points: 1,
        allowed: 0.0,
        offset: 0.0,
        turned: DVec3::ZERO,
    };
    assert_eq!(pair.of_point(), [(7, 1.0)]);
}
