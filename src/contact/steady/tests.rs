#![allow(clippy::expect_used)]

use super::*;
use crate::contact::{Faced, Listed};

/// Cells of a floor along each side.
const CELLS: u32 = 6;

/// An uneven floor of triangles with edges of about 1, and below its lid, a node over it: one of the lid's.
struct Place {
    surfaces: Surfaces,
    places: Vec<DVec3>,
    point: Point,
}

impl Place {
    fn random(random: &mut fastrand::Rng, of_face: bool) -> Self {
        let row = CELLS + 1;
        let mut places = Vec::new();
        let mut number = |size: f64| size * (random.f64() - 0.5);
        let (x, y, height) = (3.0 + number(2.0), 3.0 + number(2.0), number(0.3));
        for side in [0.0, 1.0] {
            for place in 0..row * row {
                let at = DVec3::new(f64::from(place % row), f64::from(place / row), 0.0);
                let moved = at + DVec3::new(number(0.4), number(0.4), number(0.1));
                // the middle of the lid is over the floor's at (x, y)
                places.push(moved + side * DVec3::new(x - 3.0, y - 3.0, height));
            }
        }
        let cell = |first: u32, up: bool| {
            let [a, b, c, d] = [first, first + 1, first + row + 1, first + row];
            if up { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] }
        };
        let of_side =
            |side: u32| (0..CELLS * CELLS).flat_map(move |at| cell(side + at % CELLS + at / CELLS * row, side == 0));
        let triangles: Vec<[u32; 3]> = of_side(0).chain(of_side(row * row)).collect();
        let bodies = (0..triangles.len()).map(|number| u32::from(number >= triangles.len() / 2)).collect();
        let depths = vec![0.5; triangles.len()];
        let middle = row * row + 3 * row + 3;
        let of_lid = triangles.len() as u32 / 2 + 2 * (3 * CELLS + 3);
        let point = if of_face {
            let nodes = triangles[of_lid as usize];
            let [a, b, c] = nodes;
            Point { body: 1, nodes: [a, b, c, c], weights: [0.5, 0.25, 0.25, 0.0], triangle: Some(of_lid) }
        } else {
            Point::node(1, middle)
        };
        Self { surfaces: Surfaces::new(places.len(), triangles, bodies, depths), places, point }
    }

    fn faced(&self, places: &[DVec3]) -> Faced {
        let floor: Vec<u32> = (0..2 * CELLS * CELLS).collect();
        let listed = Listed { triangles: &floor, distances: &vec![0.0; floor.len()], nearer: 0.0, farthest: 9.0 };
        self.surfaces.faced(Placed { places, normals: &[] }, &self.point, listed, |_| 0.05, (1.0, true))
    }
}

/// However nodes move, as long as no two do so against each other by as much as is said: the same is found with one
/// triangle as with all.
#[test]
fn what_is_faced_stays_as_long_as_is_foreseen() {
    let mut random = fastrand::Rng::with_seed(5);
    let [mut nothing, mut something] = [0, 0];
    for trial in 0..3000 {
        let place = Place::random(&mut random, trial % 3 == 0);
        let before = place.faced(&place.places);
        if !(before.steady > 0.0) {
            continue;
        }
        for _ in 0..4 {
            // corners of a box whose diagonal is that long: the worst that may be
            let side = 0.999 * before.steady.min(1.0) / 3.0_f64.sqrt();
            let corner = |random: &mut fastrand::Rng| if random.bool() { side } else { 0.0 };
            let moved = |at: &DVec3| *at + DVec3::from_array([(); 3].map(|()| corner(&mut random)));
            let places: Vec<DVec3> = place.places.iter().map(moved).collect();
            let all = place.faced(&places);
            assert_eq!(all.second, None, "{trial}");
            match before.first {
                None => {
                    assert_eq!(all.first, None, "{trial}");
                    nothing += 1;
                }
                Some(first) => {
                    let one = place.surfaces.still_faced(&places, &place.point, first.triangle, 0.05);
                    // what leaves its triangle is looked for anew
                    if one.is_some() {
                        assert_eq!(one, all.first, "{trial}: {}", before.steady);
                        something += 1;
                    }
                }
            }
        }
    }
    assert!(nothing > 500 && something > 500, "{nothing}, {something}");
}

/// Beyond it, something else is faced sooner or later: the bound is one.
#[test]
fn a_point_that_goes_to_another_triangle_is_not_taken_for_what_it_was() {
    let mut random = fastrand::Rng::with_seed(6);
    let mut others = 0;
    for _ in 0..500 {
        let place = Place::random(&mut random, false);
        let Some(first) = place.faced(&place.places).first else { continue };
        let mut places = place.places.clone();
        places[place.point.nodes[0] as usize] += DVec3::new(0.7, 0.4, 0.0);
        let now = place.faced(&places).first;
        let one = place.surfaces.still_faced(&places, &place.point, first.triangle, 0.05);
        assert!(one.is_none() || one == now, "{one:?}, {now:?}");
        others += usize::from(one.is_none());
    }
    assert!(others > 100, "{others}");
}
