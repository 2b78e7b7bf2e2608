use super::*;
use crate::contact::facing::tests::by_shortlist;
use crate::contact::{Faced, Kept, Listed, Placed, Point, Surfaces};
use glam::DVec3;

/// A wavy sheet of 5 × 5 nodes a metre apart, cut into triangles, and a triangle of another body that looks down on
/// it, whose nodes have no places yet.
fn sheet() -> (Surfaces, Vec<DVec3>) {
    let at = |i: u32| DVec3::new(f64::from(i % 5), f64::from(i / 5), 0.3 * f64::from(i).sin());
    let cut = |i: u32| [[i, i + 1, i + 6], [i, i + 6, i + 5]];
    let triangles: Vec<[u32; 3]> = (0..20).filter(|i| i % 5 < 4).flat_map(cut).collect();
    let count = triangles.len();
    let owners = [vec![0; count], vec![1]].concat();
    let triangles = [triangles, vec![[25, 26, 27]]].concat();
    (Surfaces::new(28, triangles, owners, vec![0.5; count + 1]), (0..25).map(at).collect())
}

/// What a point of the other triangle faces, its first corner or one within, by a shortlist or, where that is not
/// known, by the whole list; and whether at a glance.
fn faced(
    surfaces: &Surfaces,
    (places, within): (&[DVec3], bool),
    short: &mut Shortlist,
    stays: Stays,
) -> (Faced, bool) {
    let other = surfaces.triangles.len() as u32 - 1;
    let all: Vec<u32> = (0..other).collect();
    let normals: Vec<DVec3> = (0..=other).map(|triangle| surfaces.normal(places, triangle)).collect();
    let distances = vec![0.0; all.len()];
    let listed = Listed { triangles: &all, distances: &distances, nearer: 0.0, farthest: 1.0 };
    let now = Placed { places, normals: &normals };
    let point = match within {
        true => Point {
            nodes: [25, 26, 27, 27],
            weights: &[0.6, 0.2, 0.2, 0.0],
            triangle: Some(other),
            ..Point::node(1, 25)
        },
        false => Point::node(1, 25),
    };
    if short.triangles().is_some() {
        return by_shortlist(surfaces, (now, &point), listed, &|_| 0.1, (short, stays.moved));
    }
    let mut found = Faced::NOTHING;
    surfaces.faced((now, &point), listed, (|_| 0.1, |_| 1.0), (short, stays), (&mut found, &mut Kept::default()));
    (found, false)
}

/// However nodes move that a shortlist allows for: what it leaves out changes nothing of what is faced. And it
/// leaves out most.
#[test]
fn shortlists_have_all_that_may_be_faced() {
    let mut random = fastrand::Rng::with_seed(11);
    let (surfaces, flat) = sheet();
    let (mut known, mut left, mut faces, mut asked, mut turned, mut glances) = (0, 0, 0, 0, 0, 0);
    for round in 0..400 {
        let mut vector = |size: f64| size * (DVec3::new(random.f64(), random.f64(), random.f64()) - 0.5);
        let (place, stays) = (vector(1.0), Stays { moved: 0.02, reach: 0.0 });
        let mut before = flat.clone();
        let (corner, within) = (DVec3::new(2.0 + place.x, 2.0 + place.y, flat[12].z + 0.3 * place.z), round % 2 == 1);
        // in some rounds it looks the other way
        let across = if round % 8 < 6 { [DVec3::Y, DVec3::X] } else { [DVec3::X, DVec3::Y] };
        before.extend([corner, corner + 0.5 * across[0], corner + 0.5 * across[1]]);
        let mut short = Shortlist::UNKNOWN;
        faced(&surfaces, (&before, within), &mut short, stays);
        let Some(triangles) = short.triangles() else { continue };
        (known, left) = (known + 1, left + triangles.len());
        let count = triangles.len();
        // what the one that it faces is asked for here must hold, however nodes move
        faced(&surfaces, (&before, within), &mut short, stays);
        asked += (0..count).filter(|&number| short.is_asked(number)).count();
        turned += (0..count).filter(|&number| short.is_turned_away(number)).count();
        for _ in 0..20 {
            // each within half of what two may move against each other
            let half = stays.moved / 3.0_f64.sqrt();
            let after: Vec<DVec3> = before.iter().map(|&at| at + vector(half)).collect();
            let [mut unknown, mut same] = [Shortlist::UNKNOWN, short];
            let by_list = faced(&surfaces, (&after, within), &mut unknown, stays).0;
            let (by_short, at_a_glance) = faced(&surfaces, (&after, within), &mut same, stays);
            assert_eq!((by_short.first, by_short.second), (by_list.first, by_list.second), "{round}");
            assert!(by_short.wakes <= by_list.wakes + stays.moved, "{round}");
            faces += usize::from(by_list.first.is_some());
            glances += usize::from(at_a_glance && by_list.first.is_some());
        }
    }
    assert!(known > 200 && left < 5 * known && faces > 1000, "{known}, {left}, {faces}");
    assert!(2 * glances > faces, "{glances} of {faces}");
    // of nodes, three of four of which look at the sheet
    assert!(turned > 50 && 3 * turned < 2 * asked && asked < known, "{turned} of {asked} of {known}");
}
