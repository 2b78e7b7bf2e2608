use super::*;

/// Two rows of triangles of two bodies, the second above the first.
fn rows() -> (Surfaces, Vec<DVec3>, Vec<Point>) {
    let (long, half) = (400, 402);
    let strip = |first: u32| (first..first + long).map(|a| [a, a + 1, a + 2]);
    let triangles: Vec<[u32; 3]> = strip(0).chain(strip(half)).collect();
    let owners = (0..2 * long).map(|number| number / long).collect();
    let count = triangles.len();
    let at = |node: u32| DVec3::new(f64::from(node % half), f64::from(node % 2), 0.1 * f64::from(node / half));
    let points = (0..2 * half).map(|node| Point::node(node / half, node)).collect();
    (Surfaces::new(2 * half as usize, triangles, owners, vec![0.5; count]), (0..2 * half).map(at).collect(), points)
}

/// Lists of nodes of the second row: what of the first is within a metre or so.
fn lists() -> Lists {
    let mut lists = Lists { radius: 1.5, starts: vec![0], ..Lists::default() };
    for node in 2..400 {
        lists.points.push(402 + node);
        lists.triangles.extend(node - 2..node);
        lists.distances.extend([0.1; 2]);
        lists.starts.push(lists.triangles.len() as u32);
    }
    lists
}

/// What is begun anew when these nodes move, of neighbourhoods that were just begun; in ranges of points.
fn anew(shift: impl Fn(u32) -> DVec3) -> Vec<Range<usize>> {
    let (surfaces, places, points) = rows();
    let mut all = Neighbourhoods::of(&surfaces, &points, &lists());
    let mut first = Vec::new();
    all.look(&places, [0.01, 0.02], |range| first.push(range));
    assert_eq!(first.first(), Some(&(0..POINTS)));
    assert_eq!(first.last(), Some(&(6 * POINTS..398)), "all are begun, and the last is shorter");
    let moved: Vec<DVec3> = (0..).zip(&places).map(|(node, &at)| at + shift(node)).collect();
    let mut anew = Vec::new();
    all.look(&moved, [0.01, 0.02], |range| anew.push(range));
    // of those that stay as they are it is known how far they have moved
    for place in (0..398).filter(|place| !anew.iter().any(|range| range.contains(place))) {
        let [by, most] = all.moved(place);
        assert!(by <= 0.01 && most == 0.02, "{place}: {by}");
    }
    anew
}

#[test]
fn what_moves_as_a_whole_stays_and_what_moves_apart_is_begun_anew() {
    assert_eq!(anew(|_| DVec3::new(5.0, -3.0, 1.0)), []);
    // stretched: far apart at the ends, and little from neighbour to neighbour
    assert_eq!(anew(|node| DVec3::X * 1e-4 * f64::from(node % 402)), []);
    // the rows slide along each other
    assert_eq!(anew(|node| DVec3::X * if node < 402 { 0.011 } else { 0.0 }).len(), 7);
    assert_eq!(anew(|node| DVec3::X * if node < 402 { 0.009 } else { 0.0 }), []);
    // one node alone, of the points of one neighbourhood; one of a triangle beside those in its lists; and what is no
    // number
    assert_eq!(anew(|node| DVec3::Z * if node == 402 + 100 { 0.011 } else { 0.0 }), [64..128]);
    assert_eq!(anew(|node| DVec3::Z * if node == 68 { 0.011 } else { 0.0 }), [0..64, 64..128]);
    let nowhere = anew(|node| DVec3::Z * if node == 100 { f64::NAN } else { 0.0 });
    assert_eq!(nowhere, [64..128]);
}
