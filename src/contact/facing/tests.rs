#![allow(clippy::expect_used)]

use super::*;
use crate::contact::candidates::ON_IT;
use crate::contact::rims::RIM;

/// What a point faces by its shortlist, which is known and serves while nodes move so far (m), and whether that is seen
/// at a glance: then the same.
pub(in crate::contact) fn by_shortlist(
    surfaces: &Surfaces,
    (now, point): (Placed<'_>, &Point),
    listed: Listed<'_>,
    reach: &impl Fn(u32) -> f64,
    (short, moved): (&mut Shortlist, f64),
) -> (Faced, bool) {
    let mut same = *short;
    let [mut chosen, mut seen] = [Faced::NOTHING; 2];
    let kept = (&mut chosen, &mut Kept::default());
    surfaces.faced((now, point), listed, (reach, |_| 1.0), (&mut same, Stays::default()), kept);
    // with normals that are known, and with those that are asked for
    let mut is_all = [now.normals, &[][..]].into_iter().map(|normals| {
        let of = (Placed { normals, ..now }, point, (&mut *short, listed.triangles));
        let lately = (Lately { gone: f64::INFINITY, farther: 0.0 }, || moved);
        let seen = (&mut seen, &mut Own::default());
        surfaces.faced_at_a_glance(of, (listed.nearer, (reach, 0.0), |_| 1.0), lately, seen)
    });
    let is_all = is_all.all(|is_all| is_all);
    assert!(!is_all || seen == chosen, "{seen:?}, {chosen:?}");
    (chosen, is_all)
}

/// What a point faces, with the normals of all triangles found for it.
pub(in crate::contact) fn faced(
    surfaces: &Surfaces,
    places: &[DVec3],
    point: &Point,
    triangles: &[u32],
    reach: impl Fn(u32) -> f64,
) -> Faced {
    let all = 0..surfaces.triangles.len() as u32;
    let normals: Vec<DVec3> = all.map(|triangle| surfaces.normal(places, triangle)).collect();
    let distances = vec![0.0; triangles.len()];
    let listed = Listed { triangles, distances: &distances, nearer: 0.0, farthest: 1.0 };
    let now = Placed { places, normals: &normals };
    let (mut short, mut found) = (Shortlist::UNKNOWN, Faced::NOTHING);
    let stays = Stays { moved: 1e-3, reach: 1e-3 };
    let kept = (&mut found, &mut Kept::default());
    surfaces.faced((now, point), listed, (&reach, |_| 1.0), (&mut short, stays), kept);
    // what the shortlist leaves out changes nothing
    assert_eq!(by_shortlist(surfaces, (now, point), listed, &reach, (&mut short, stays.moved)).0, found);
    // forces act along one line, but for what counts as being on a face
    for facing in [&found.first, &found.second].into_iter().flatten() {
        let corners = surfaces.corners(places, facing.triangle).into_iter().zip(facing.weights);
        let bears: DVec3 = corners.map(|(corner, weight)| corner * weight).sum();
        let off = (point.place(places) - bears).distance(facing.gap * facing.normal);
        assert!(off <= ON_IT, "{facing:?} is borne {off} m beside");
    }
    found
}

/// A flat square of two triangles, normal up, and a point above it.
fn square(height: f64) -> (Surfaces, Vec<DVec3>) {
    let places = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0), (0.5, 0.5, height)];
    let triangles = vec![[0, 1, 2], [0, 2, 3]];
    (Surfaces::new(5, triangles, vec![0; 2], vec![0.5; 2]), places.map(DVec3::from).to_vec())
}

#[test]
fn a_place_on_the_side_of_two_faces_is_as_far_from_both() {
    for height in [0.1, 1e-5, 0.0, -1e-5, -0.1] {
        let (surfaces, places) = square(height);
        let faced = faced(&surfaces, &places, &Point::node(1, 4), &[0, 1], |_| 0.2);
        let first = faced.first.expect("it faces them");
        assert!((first.gap - height).abs() < 1e-15 && (first.normal - DVec3::Z).length() < 1e-12, "{first:?}");
        assert_eq!((first.triangle, faced.second), (0, None));
    }
}

/// Of a strip the second half is not in any list: still it is seen that it is nearer.
#[test]
fn where_the_surface_goes_on_its_other_parts_are_not_faced() {
    let corners = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (0.0, 1.0), (1.0, 1.0), (2.0, 1.0)];
    let mut places: Vec<DVec3> = corners.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
    places.push(DVec3::ZERO);
    let triangles = vec![[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]];
    let surfaces = Surfaces::new(7, triangles, vec![0; 4], vec![0.5; 4]);
    for place in [(1.3, 0.5, 0.0), (1.3, 0.5, 0.1), (1.1, 0.0, -0.2), (1.4, 1.0, 1e-9), (1.4, 1.0, -1e-9)] {
        places[6] = place.into();
        let faced = |triangles: &[u32]| faced(&surfaces, &places, &Point::node(1, 6), triangles, |_| 1.0).first;
        assert_eq!(faced(&[0, 1]), None, "{place:?}");
        assert!((faced(&[0, 1, 2, 3]).expect("it faces one").gap - place.2).abs() < 1e-15);
    }
}

#[test]
fn farther_than_the_reach_or_deeper_than_the_inside_is_nothing() {
    for (height, there) in [(0.21, false), (0.19, true), (-0.49, true), (-0.51, false)] {
        let (surfaces, places) = square(height);
        let faced = faced(&surfaces, &places, &Point::node(1, 4), &[0, 1], |_| 0.2);
        assert_eq!(faced.first.is_some(), there, "{height}");
    }
}

/// A floor and a wall at its end x = 0, up from it or down, and a point of a face that is a little or not at all
/// inside both.
#[test]
fn a_wall_that_rises_is_another_face_and_one_that_falls_off_is_not() {
    for (rises, end) in [(true, 1.0), (false, -1.0)] {
        for height in [-1e-4, -1e-9, 0.0, 1e-9] {
            let floor = [(0.0, -1.0, 0.0), (1.0, -1.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)];
            let wall = [(0.0, -1.0, end), (0.0, 1.0, end)];
            // it looks straight down
            let face = [(1e-9, 0.1, height), (1e-9, 1.1, height), (1.0, 0.1, height)];
            let places: Vec<DVec3> = floor.into_iter().chain(wall).chain(face).map(DVec3::from).collect();
            // out of the wall is +x where it rises, −x where it falls off
            let triangles = vec![[0, 1, 2], [0, 2, 3], [0, 3, 5], [0, 5, 4], [6, 7, 8]];
            let surfaces = Surfaces::new(9, triangles, vec![0, 0, 0, 0, 1], vec![0.5; 5]);
            let point = Point { triangle: Some(4), ..Point::node(1, 6) };
            let faced = faced(&surfaces, &places, &point, &[0, 1, 2, 3], |_| 0.2);
            assert!(faced.first.is_some(), "{rises}, {height}");
            assert_eq!(faced.second.is_some(), rises, "{rises}, {height}: {faced:?}");
        }
    }
}

/// A node that has sunk into a corner of 90° or 120° is borne by both walls, each along its own normal, wherever behind
/// the line in which they meet.
#[test]
fn what_has_sunk_into_a_corner_is_borne_by_both_walls() {
    for opens in [45.0_f64, 60.0] {
        let (across, up) = opens.to_radians().sin_cos();
        for off in [-0.02, 0.0, 0.02] {
            let line = [(0.0, -1.0, 0.0), (0.0, 2.0, 0.0)];
            let walls = [(across, 0.3, up), (-across, 0.3, up)];
            let cone = [(off, 0.0, -0.1), (1.0, 0.0, 1.0), (-0.5, 1.0, 1.0), (-0.5, -1.0, 1.0)];
            let places: Vec<DVec3> = line.into_iter().chain(walls).chain(cone).map(DVec3::from).collect();
            let triangles = vec![[0, 2, 1], [0, 1, 3], [4, 6, 5], [4, 7, 6], [4, 5, 7]];
            let surfaces = Surfaces::new(8, triangles, vec![0, 0, 1, 1, 1], vec![0.5; 5]);
            let faced = faced(&surfaces, &places, &Point::node(1, 4), &[0, 1], |_| 0.2);
            for facing in [faced.first, faced.second] {
                let facing = facing.expect("both walls");
                let normal = surfaces.normal(&places, facing.triangle);
                assert!(normal.z > 0.5 && facing.normal == normal, "{facing:?}");
                let depth = -normal.dot(places[4]);
                assert!((facing.gap + depth).abs() < 1e-12, "{facing:?}, {depth}");
                // along the line it is where the node is, and behind it where no wall is
                assert!(facing.weights.iter().any(|&weight| weight < -1e-3), "{facing:?}");
            }
        }
    }
}

/// Before a node of the line in which walls meet several triangles of each are as near: whatever their order is, both
/// walls are faced. One more of the second in its place would leave the first alone.
#[test]
fn before_a_node_of_the_line_both_walls_are_faced() {
    let line = [(0.0, -1.0, 0.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)];
    let walls = [(1.0, -1.0, 1.0), (1.0, 1.0, 1.0), (-1.0, -1.0, 1.0), (-1.0, 1.0, 1.0)];
    let cone = [(0.005, 0.0, -0.1), (1.0, 0.0, 1.0), (-0.5, 1.0, 1.0), (-0.5, -1.0, 1.0)];
    let places: Vec<DVec3> = line.into_iter().chain(walls).chain(cone).map(DVec3::from).collect();
    let right = [[1, 0, 3], [1, 3, 4], [1, 4, 2]];
    let left = [[1, 5, 0], [1, 6, 5], [1, 2, 6]];
    let of_cone = [[7, 9, 8], [7, 10, 9], [7, 8, 10]];
    for order in [[0, 1, 2, 3, 4, 5], [3, 4, 5, 0, 1, 2], [0, 3, 1, 4, 2, 5], [3, 0, 4, 1, 5, 2], [0, 3, 4, 1, 5, 2]] {
        let all = [right, left].concat();
        let triangles: Vec<[u32; 3]> = order.map(|i: usize| all[i]).into_iter().chain(of_cone).collect();
        let surfaces = Surfaces::new(11, triangles, vec![0, 0, 0, 0, 0, 0, 1, 1, 1], vec![0.5; 9]);
        let faced = faced(&surfaces, &places, &Point::node(1, 7), &[0, 1, 2, 3, 4, 5], |_| 0.2);
        let normals = [faced.first, faced.second].map(|facing| facing.map(|facing| facing.normal.x.signum()));
        // less deep in the left one, which is above the node by less
        assert_eq!(normals, [Some(1.0), Some(-1.0)], "{order:?}: {faced:?}");
    }
}

/// What is beside the thin edge of a wedge, and nearer to the flank before it, is not inside of the flank behind that.
#[test]
fn beyond_what_is_thin_is_not_inside() {
    // an edge down along y; flanks of 20° to the vertical
    let (half, high) = 20.0_f64.to_radians().sin_cos();
    let wedge = [(0.0, -1.0, 0.0), (0.0, 1.0, 0.0), (half, 0.0, high), (-half, 0.0, high)];
    // a face that rises by 30° to the left looks up and to the right
    let (out, up) = 30.0_f64.to_radians().sin_cos();
    let own = [(-0.2 * up, 0.0, 0.2 * out), (-0.4 * up, -0.3, 0.4 * out), (-0.4 * up, 0.3, 0.4 * out)];
    let places: Vec<DVec3> = wedge.into_iter().chain(own).map(DVec3::from).collect();
    let triangles = vec![[0, 1, 2], [0, 3, 1], [4, 6, 5]];
    let surfaces = Surfaces::new(7, triangles, vec![0, 0, 1], vec![0.5; 3]);
    let normals = [0, 1, 2].map(|triangle| surfaces.normal(&places, triangle));
    assert!(normals[0].z < 0.0 && normals[1].z < 0.0 && normals[2].z > 0.0, "{normals:?}");
    assert!(normals[2].dot(normals[0]) < TURNED_AWAY, "it would face the far flank");
    let faced = faced(&surfaces, &places, &Point::node(1, 4), &[0, 1], |_| 0.01);
    assert_eq!((faced.first, faced.second), (None, None));
}

/// A floor and a slope beside it, up by 25° or down by 60°, and a point that looks straight down. In front of both it
/// is kept away from the nearer, as by a thickness; inside both it comes out of the one that it faces more.
#[test]
fn outside_of_several_faces_the_nearest_is_in_the_way_and_inside_the_one_that_is_faced() {
    let floor = [(-3.0, -1.0, 0.0), (0.0, -1.0, 0.0), (0.0, 2.0, 0.0)];
    for (slope, at, expected) in [
        (25_f64, (-0.05, 0.1, 0.5), 1),
        (25.0, (-0.5, 0.1, 0.5), 0),
        (-60.0, (-0.02, 0.1, -0.1), 0),
        (-60.0, (0.2, 0.1, -0.4), 1),
    ] {
        let (rise, run) = slope.to_radians().sin_cos();
        let slope = [(0.0, -1.0, 0.0), (3.0 * run, -1.0, 3.0 * rise), (0.0, 2.0, 0.0)];
        let at = DVec3::from(at);
        let face = [at, at + DVec3::Y, at + DVec3::X];
        let places: Vec<DVec3> = floor.into_iter().chain(slope).map(DVec3::from).chain(face).collect();
        let surfaces = Surfaces::new(9, vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]], vec![0, 0, 1], vec![0.5; 3]);
        let point = Point { triangle: Some(2), ..Point::node(1, 6) };
        let faced = faced(&surfaces, &places, &point, &[0, 1], |_| 1.0);
        assert_eq!(faced.first.map(|first| first.triangle), Some(expected), "{at}: {faced:?}");
    }
}

#[test]
fn triangles_without_area_are_never_faced() {
    let places: Vec<DVec3> =
        [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.0), (1.0, 0.0, 0.1)].map(DVec3::from).to_vec();
    let surfaces = Surfaces::new(4, vec![[0, 1, 2], [0, 0, 0]], vec![0; 2], vec![0.5; 2]);
    let faced = faced(&surfaces, &places, &Point::node(1, 3), &[0, 1], |_| 1.0);
    assert_eq!(faced.first, None);
}

/// Two blocks of 12 triangles, the upper one turned a little and moved, so that some of its corners are beyond the rim
/// of the lower one: as the whole list has it, and for most by no more than a glance.
#[test]
fn beside_rims_and_at_rims_a_glance_tells() {
    let mut random = fastrand::Rng::with_seed(9);
    let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let both = [0, 8].into_iter().flat_map(|first| sides.map(|side| side.map(|i| first + i)));
    let triangles: Vec<[u32; 3]> = both.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let owners = [[0; 12], [1; 12]].concat();
    let surfaces = Surfaces::new(16, triangles, owners, vec![0.5; 24]);
    let listed: Vec<u32> = (0..12).collect();
    // how many are not seen at a glance, and how many are
    let [mut beyond, mut before] = [[0; 2]; 2];
    for _ in 0..200 {
        let mut within = |size: f64| size * (random.f64() - 0.5);
        let turned = glam::DQuat::from_euler(glam::EulerRot::XYZ, within(0.02), within(0.02), within(1.5));
        let off = DVec3::new(within(0.8), within(0.8), 1.0 + within(0.04));
        let places: Vec<DVec3> =
            (0..16).map(|i| if i < 8 { corner(i) } else { turned * corner(i - 8) + off }).collect();
        for node in 8..12 {
            let (point, distances) = (Point::node(1, node), [0.0; 12]);
            let listed = Listed { triangles: &listed, distances: &distances, nearer: 0.0, farthest: 1.0 };
            let now = Placed { places: &places, normals: &[] };
            let (mut short, mut found) = (Shortlist::UNKNOWN, Faced::NOTHING);
            let stays = Stays { moved: 1e-3, reach: 1e-3 };
            let kept = (&mut found, &mut Kept::default());
            surfaces.faced((now, &point), listed, (|_| 0.05, |_| 1.0), (&mut short, stays), kept);
            if !short.is_known() {
                continue;
            }
            let of_short = (&mut short, stays.moved);
            let (same, at_a_glance) = by_shortlist(&surfaces, (now, &point), listed, &|_| 0.05, of_short);
            assert_eq!((same.first, same.second), (found.first, found.second));
            let place = places[node as usize];
            let is_beyond = place.min(DVec3::ONE - place).truncate().min_element() < 0.0;
            let counted = if is_beyond { &mut beyond } else { &mut before };
            counted[usize::from(at_a_glance)] += 1;
        }
    }
    assert!(beyond[1] > 100 && beyond[0] < beyond[1] / 4, "{beyond:?}");
    // those within are inside several triangles at once, as far as an inside goes
    assert!(before[1] > 80, "{before:?}");
}

/// A bumpy floor of squares of one metre, and a small triangle of another body above it or in it that looks down: while
/// nodes move by less than one triangle of its shortlist is to matter alone for, that one tells what all tell.
#[test]
fn one_triangle_alone_tells_what_all_tell_while_little_moves() {
    let mut random = fastrand::Rng::with_seed(10);
    let square = |i: u32| [i, i + 1, i + 6, i + 5].map(|node| node + i / 4);
    let floor = (0..16).map(square).flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let triangles: Vec<[u32; 3]> = floor.chain([[25, 27, 26]]).collect();
    let surfaces = Surfaces::new(28, triangles, [vec![0; 32], vec![1]].concat(), vec![0.5; 33]);
    let (listed, distances): (Vec<u32>, _) = ((0..32).collect(), [0.0; 32]);
    let listed = Listed { triangles: &listed, distances: &distances, nearer: 0.0, farthest: 1.0 };
    let point = Point { triangle: Some(32), ..Point::node(1, 25) };
    let (stays, farther) = (Stays { moved: 3e-2, reach: 1e-3 }, 3e-3);
    let (reach, edge) = (|_: u32| 0.05, |_: u32| 1.0);
    // how often one is alone, and how often it is still then
    let (mut alone, mut told) = (0, 0);
    for _ in 0..1000 {
        let mut within = |size: f64| size * (random.f64() - 0.5);
        let at = DVec3::new(2.0 + within(2.0), 2.0 + within(2.0), within(0.1));
        let of_floor = (0..25).map(|node| (f64::from(node % 5), f64::from(node / 5)));
        let mut places: Vec<DVec3> = of_floor.map(|(x, y)| DVec3::new(x, y, within(0.1))).collect();
        places.extend([DVec3::ZERO, 0.02 * DVec3::X, 0.02 * DVec3::Y].map(|corner| at + corner));
        let of_all = |places: &[DVec3]| {
            let (mut short, mut found) = (Shortlist::UNKNOWN, Faced::NOTHING);
            let (now, kept) = (Placed { places, normals: &[] }, (&mut found, &mut Kept::default()));
            surfaces.faced((now, &point), listed, (reach, edge), (&mut short, stays), kept);
            (short, found)
        };
        let mut seen = Faced::NOTHING;
        let mut glance = |short: &mut Shortlist, places: &[DVec3], gone: f64| {
            let of = (Placed { places, normals: &[] }, &point, (short, listed.triangles));
            let (lately, told) = ((Lately { gone, farther }, || stays.moved), (&mut seen, &mut Own::default()));
            surfaces.faced_at_a_glance(of, (0.0, (reach, stays.reach), edge), lately, told).then_some(seen)
        };
        let (mut short, _) = of_all(&places);
        let gone = 0.99 * farther;
        glance(&mut short, &places, 0.0);
        let now = short.triangles_now(Lately { gone, farther }).map_or(0, |(now, _)| now.len());
        if short.triangles().is_none_or(|all| all.len() < 2) || now != 1 {
            continue;
        }
        alone += 1;
        let half = 0.5 * gone / 3.0_f64.sqrt();
        for at in &mut places {
            *at += half * DVec3::new(within(2.0), within(2.0), within(2.0));
        }
        if let Some(seen) = glance(&mut short, &places, gone) {
            let (_, found) = of_all(&places);
            assert_eq!((seen.first, seen.second), (found.first, found.second));
            told += usize::from(seen.first.is_some());
        }
        // farther than that all are looked at
        let all = short.triangles_now(Lately { gone: 1.01 * farther, farther });
        assert!(all.is_some_and(|(all, _)| all.len() > 1));
    }
    assert!(alone > 100 && told > alone / 2, "{alone} {told}");
}

/// A floor so rough that there are rims and none, and above it four triangles around a node, turned anyhow: what is
/// asked of a triangle holds however nodes move that it allows for.
#[test]
fn what_is_asked_of_a_triangle_holds_while_nodes_move() {
    let mut random = fastrand::Rng::with_seed(7);
    let cut = |node: u32| [[node, node + 1, node + 6], [node, node + 6, node + 5]];
    let floor = (0..20).filter(|node| node % 5 < 4).flat_map(cut);
    let triangles: Vec<[u32; 3]> = floor.chain((0..4).map(|i| [25, 26 + i, 26 + (i + 1) % 4])).collect();
    let surfaces = Surfaces::new(30, triangles, [vec![0; 32], vec![1; 4]].concat(), vec![0.5; 36]);
    let (point, moved) = (Point::node(1, 25), 0.02);
    let [mut away, mut facing, mut smooth, mut rims] = [0; 4];
    for round in 0..4000 {
        let mut vector = |size: f64| size * (DVec3::new(random.f64(), random.f64(), random.f64()) - 0.5);
        let on_floor = |node: u32| DVec3::new(f64::from(node % 5), f64::from(node / 5), 0.0);
        let mut before: Vec<DVec3> = (0..25).map(|node| on_floor(node) + vector(0.8)).collect();
        let (at, [one, other]) = (DVec3::new(2.0, 2.0, 1.0) + vector(1.0), [vector(2.0), vector(2.0)]);
        before.extend([DVec3::ZERO, one, other, -one, -other].map(|off| at + off + vector(0.2)));
        let triangle = round % 32;
        let now = Placed { places: &before, normals: &[] };
        let [is_turned_away, may_have_rim] = surfaces.ask((now, &point), triangle, moved);
        let counted = if is_turned_away { &mut away } else { &mut facing };
        *counted += 1;
        let counted = if may_have_rim { &mut rims } else { &mut smooth };
        *counted += 1;
        for _ in 0..20 {
            let after: Vec<DVec3> = before.iter().map(|&place| place + vector(moved / 3.0_f64.sqrt())).collect();
            let now = Placed { places: &after, normals: &[] };
            let (normal, own) = (surfaces.normal(&after, triangle), surfaces.normal_of_node(now, 25));
            assert!(!is_turned_away || normal.dot(own) < TURNED_AWAY, "{round}: {}", normal.dot(own));
            let corners = surfaces.triangles[triangle as usize];
            let around = corners.iter().flat_map(|&node| surfaces.around(node));
            let least = around.map(|&beside| normal.dot(surfaces.normal(&after, beside))).fold(1.0, f64::min);
            assert!(may_have_rim || least >= RIM, "{round}: {least}");
        }
    }
    assert!(away.min(facing).min(smooth).min(rims) > 300, "{away} {facing} {smooth} {rims}");
}
