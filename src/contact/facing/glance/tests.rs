use super::*;
use crate::contact::facing::tests::by_shortlist;
use crate::contact::{Faced, Kept, Listed, Shortlist, Stays};

/// Points about tetrahedra of any shape, sharp ones among them, whose faces are one triangle or three: a point may be
/// behind one face, as deep as its inside goes, and before another that is nearer and looks away from under it.
#[test]
fn a_glance_at_what_is_sharp_tells_what_all_tell() {
    let mut random = fastrand::Rng::with_seed(23);
    let (mut glances, mut faces, mut leans) = (0, 0, 0);
    for round in 0..20_000 {
        let mut vector = || DVec3::new(random.f64(), random.f64(), random.f64());
        let mut places: Vec<DVec3> = (0..4).map(|_| vector()).collect();
        if (places[1] - places[0]).cross(places[2] - places[0]).dot(places[3] - places[0]) > 0.0 {
            places.swap(0, 1);
        }
        let sides = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [0, 2, 3]];
        let mut triangles: Vec<[u32; 3]> = sides.to_vec();
        if round % 2 == 1 {
            places.extend(sides.map(|side| side.iter().map(|&corner| places[corner as usize]).sum::<DVec3>() / 3.0));
            let thirds = |(middle, [a, b, c]): (u32, [u32; 3])| [[a, b, middle], [b, c, middle], [c, a, middle]];
            triangles = (4..).zip(sides).flat_map(thirds).collect();
        }
        let (first, count) = (places.len() as u32, triangles.len() as u32);
        // anywhere, or before or behind a face
        let above = 0.3 * vector().x - 0.25;
        let [a, b, c] = triangles[0].map(|corner| places[corner as usize]);
        let middle = (a + b + c) / 3.0 + above * (b - a).cross(c - a).normalize();
        let at = if round % 3 == 0 { vector() } else { middle };
        places.extend([at, at + 0.1 * (vector() - 0.5), at + 0.1 * (vector() - 0.5)]);
        triangles.push([first, first + 1, first + 2]);
        let owners = [vec![0; count as usize], vec![1]].concat();
        let surfaces = Surfaces::new(places.len(), triangles, owners, vec![0.3; count as usize + 1]);
        let normals: Vec<DVec3> = (0..=count).map(|triangle| surfaces.normal(&places, triangle)).collect();
        let now = Placed { places: &places, normals: &normals };
        let all: Vec<u32> = (0..count).collect();
        let distances = vec![0.0; all.len()];
        let listed = Listed { triangles: &all, distances: &distances, nearer: 0.0, farthest: 1.0 };
        let (node, mut short) = (Point::node(1, first), Shortlist::UNKNOWN);
        let point = if round % 4 < 2 { node } else { Point { triangle: Some(count), ..node } };
        let (mut found, reach) = (Faced::NOTHING, |_| 0.05);
        let to = (&mut found, &mut Kept::default());
        surfaces.faced((now, &point), listed, (reach, |_| 1.0), (&mut short, Stays::default()), to);
        if short.is_known() {
            let (_, at_a_glance) = by_shortlist(&surfaces, (now, &point), listed, &reach, (&mut short, 0.0));
            glances += usize::from(at_a_glance);
            faces += usize::from(at_a_glance && found.first.is_some());
            // behind one within its sides, and nearer in front of another, farther than is looked at
            let nearest = |of: u32| OnTriangle::nearest(at, surfaces.corners(&places, of));
            let outside = |of: u32| normals[of as usize].dot(at - surfaces.corners(&places, of)[0]);
            let is_before =
                |of: u32, away: f64| outside(of) > 0.0 && (0.05..away).contains(&nearest(of).at.distance(at));
            let is_behind = |of: u32| nearest(of).part == 0 && (-0.3..-0.05).contains(&outside(of));
            leans += usize::from((0..count).any(|of| is_behind(of) && (0..count).any(|o| is_before(o, -outside(of)))));
        }
    }
    assert!(glances > 4000 && faces > 50 && leans > 200, "{glances}, {faces}, {leans}");
}
