use super::*;

/// Nodes along a strip, in columns of two.
const NODES: u32 = 400;

/// A strip of triangles a metre wide, each of whose nodes has those around it in its list.
fn strip() -> (Surfaces, Vec<Point>, Lists, Vec<DVec3>) {
    let cut = |i: u32| [[i, i + 2, i + 3], [i, i + 3, i + 1]];
    let triangles: Vec<[u32; 3]> = (0..NODES - 2).step_by(2).flat_map(cut).collect();
    let count = triangles.len();
    let surfaces = Surfaces::new(NODES as usize, triangles, vec![0; count], vec![0.5; count]);
    let mut lists = Lists { points: (0..NODES).collect(), starts: vec![0], ..Lists::default() };
    for node in 0..NODES {
        lists.triangles.extend(surfaces.around(node));
        lists.starts.push(lists.triangles.len() as u32);
    }
    let places = (0..NODES).map(|node| DVec3::new(f64::from(node / 2), f64::from(node % 2), 0.0)).collect();
    (surfaces, (0..NODES).map(|node| Point::node(0, node)).collect(), lists, places)
}

/// Follows how nodes have moved; gives the first places of the neighbourhoods that begin anew, and what is left.
fn follow(all: &mut Neighbourhoods, places: &[DVec3]) -> (Vec<usize>, f64) {
    let mut renewed = Vec::new();
    let left = all.follow(places, 0.1, |range| renewed.push(range.start));
    (renewed, left)
}

#[test]
fn what_moves_together_or_elsewhere_changes_nothing() {
    let (surfaces, points, lists, mut places) = strip();
    let mut all = Neighbourhoods::default();
    all.list(&surfaces, &points, &lists);
    let every: Vec<usize> = (0..NODES as usize).step_by(POINTS).collect();
    assert_eq!(follow(&mut all, &places), (every, 0.1));
    places.iter_mut().for_each(|at| *at += DVec3::new(7.0, -3.0, 0.5));
    let (renewed, left) = follow(&mut all, &places);
    assert!(renewed.is_empty() && left > 0.0999, "{renewed:?}, {left}");
    // a node of the third, far from the others
    places[2 * POINTS + POINTS / 2].z += 0.06;
    let (renewed, left) = follow(&mut all, &places);
    assert!(renewed.is_empty() && left < 0.041 && left > 0.039, "{renewed:?}, {left}");
    assert!(all.stays(2 * POINTS) > 0.159 && all.stays(POINTS) < 0.101);
    places[2 * POINTS + POINTS / 2].z += 0.02;
    let (renewed, left) = follow(&mut all, &places);
    assert!(renewed == [2 * POINTS] && left > 0.0999, "{renewed:?}, {left}");
    // all are too wide where nodes hardly move any more
    assert!(!all.is_too_wide(0.1 / WIDE) && all.is_too_wide(0.09 / WIDE));
    let mut renewed = 0;
    assert_eq!(all.follow(&places, 0.01, |_| renewed += 1), 0.01);
    assert_eq!((renewed, all.is_too_wide(0.01)), (NODES.div_ceil(POINTS as u32), false));
    // a node that is no number is not where it was
    places[0] = DVec3::NAN;
    places[1] = DVec3::NAN;
    assert!(all.follow(&places, 0.01, |_| ()) <= 0.01);
}

/// As long as nodes move no farther than is left, none has moved farther in a neighbourhood than is allowed since that
/// began.
#[test]
fn what_is_left_keeps_all_within_what_is_allowed() {
    let (surfaces, points, lists, mut places) = strip();
    let mut all = Neighbourhoods::default();
    all.list(&surfaces, &points, &lists);
    let mut random = fastrand::Rng::with_seed(4);
    let mut begun: Vec<Vec<DVec3>> = vec![places.clone(); NODES.div_ceil(POINTS as u32) as usize];
    let (mut kept, mut count) = (0, 0);
    let apart_of = |now: &[DVec3], then: &[DVec3], range: Range<usize>| {
        let moved: Vec<DVec3> = range.map(|node| now[node] - then[node]).collect();
        moved.iter().flat_map(|a| moved.iter().map(|b| a.distance(*b))).fold(0.0, f64::max)
    };
    for _ in 0..60 {
        let (renewed, left) = follow(&mut all, &places);
        renewed.iter().for_each(|first| begun[first / POINTS].clone_from(&places));
        (kept, count) = (kept + begun.len() - renewed.len(), count + begun.len());
        // a part of the strip goes as far as is left
        let (first, way) = (random.usize(0..300), DVec3::new(random.f64() - 0.5, random.f64() - 0.5, 0.3));
        places[first..first + 100].iter_mut().for_each(|at| *at += way.normalize() * left);
        for (number, begun) in begun.iter().enumerate() {
            let range = POINTS * number..(NODES as usize).min(POINTS * (number + 1));
            assert!(apart_of(&places, begun, range) <= 0.1 + 1e-12);
        }
    }
    assert!(2 * kept > count, "{kept} of {count}");
}
