#![allow(clippy::unwrap_used)]

use super::*;
use crate::DistanceGrid;
use std::sync::Arc;

const MM: f64 = 1e-3;

fn of(shape: Shape, rounding: f64) -> Moments {
    Geometry::Analytic(Solid::new(shape, rounding).unwrap()).volume_moments().unwrap()
}

fn near(what: &str, found: f64, expected: f64, bound: f64) {
    assert!((found / expected - 1.0).abs() < bound, "{what}: {found:e}, expected {expected:e}");
}

/// Volume, height of the centre, moments along the axis and across, of what is round.
fn near_all(what: &str, (volume, center, moments): Moments, expected: [f64; 4], bound: f64) {
    let [x, y, z] = [moments.x_axis, moments.y_axis, moments.z_axis];
    near(&format!("volume of {what}"), volume, expected[0], bound);
    near(&format!("centre of {what}"), center.z, expected[1], bound);
    near(&format!("moment of {what} along its axis"), z.z, expected[2], bound);
    near(&format!("moment of {what} across"), x.x, expected[3], bound);
    near(&format!("moment of {what} across"), y.y, expected[3], bound);
    let off = [center.x, center.y, x.y, x.z, y.z].map(f64::abs).into_iter().fold(0.0, f64::max);
    assert!(off == 0.0, "{what}: {center} {moments}");
}

fn grid(surface: Triangles, spacing: f64) -> Moments {
    let grid = DistanceGrid::new(&surface, spacing).unwrap();
    Geometry::Grid(Arc::new(grid)).volume_moments().unwrap()
}

fn triangles(solid: &Solid, segments: usize) -> Triangles {
    let (points, triangles) = solid.surface(segments, 1.0);
    Triangles { points, triangles, ..Default::default() }
}

/// A ball of radius r and a cylinder of length l between its halves; a cylinder with edges that are quarters of a ring;
/// a frustum; a tube.
#[test]
fn what_is_round_has_the_moments_of_its_closed_form_however_slender_it_is() {
    for (length, r) in [(100.0 * MM, 0.25 * MM), (50.0 * MM, 10.0 * MM), (20.0 * MM, 10.0 * MM)] {
        let l = length - 2.0 * r;
        let (ball, rod) = (4.0 / 3.0 * PI * r.powi(3), PI * r * r * l);
        let across = rod * (l * l / 12.0 + r * r / 4.0) + ball * (0.4 * r * r + l * l / 4.0 + 0.375 * l * r);
        let along = 0.4 * ball * r * r + 0.5 * rod * r * r;
        let expected = [ball + rod, 0.5 * length, along, across];
        near_all("a capsule", of(Shape::Capsule { length, radius: r }, 0.0), expected, 1e-12);
    }
    for (length, inner, outer) in [(200.0, 0.9, 1.0), (7.0, 2.0, 3.0), (0.1, 50.0, 50.0 + 1e-6)] {
        let [l, a, b] = [length, inner, outer].map(|size| size * MM);
        let volume = PI * (b - a) * (b + a) * l;
        let squares = a * a + b * b;
        let expected = [volume, l / 2.0, volume * squares / 2.0, volume * (squares / 4.0 + l * l / 12.0)];
        near_all("a tube", of(Shape::Tube { length: l, inner: a, outer: b, bevel: 0.0 }, 0.0), expected, 1e-12);
    }
    for (length, tip, base) in [(300.0, 0.0, 2.0), (30.0, 0.0, 10.0), (4.0, 6.0, 0.0), (9.0, 1.0, 3.0), (5.0, 2.0, 2.0)]
    {
        let [l, a, b] = [length, tip, base].map(|size| size * MM);
        // means of powers of radii, by their divided differences
        let squares = (a * a + a * b + b * b) / 3.0;
        let fourths = (0..5).map(|i| a.powi(i) * b.powi(4 - i)).sum::<f64>() / 5.0;
        let volume = PI * l * squares;
        let center = l * (a * a + 2.0 * a * b + 3.0 * b * b) / (12.0 * squares);
        // second moment along the axis about the end at the origin
        let second = PI * l.powi(3) * (a * a / 30.0 + a * b / 10.0 + b * b / 5.0);
        let along = PI * l * fourths / 2.0;
        let expected = [volume, center, along, along / 2.0 + second - volume * center * center];
        near_all("a cone", of(Shape::Cone { length: l, tip: a, base: b }, 0.0), expected, 2e-12);
    }
}

#[test]
fn rounded_edges_have_the_moments_of_closed_forms() {
    // Pappus: the quarter of a disc that is left of a square's corner goes round
    let (length, radius, r) = (8.0 * MM, 3.0 * MM, 0.5 * MM);
    let (volume, center, moments) = of(Shape::Cylinder { length, radius }, r);
    let [square, quarter] = [[r * r, radius - r / 2.0], [PI * r * r / 4.0, radius - r + 4.0 * r / (3.0 * PI)]];
    let taken = 2.0 * 2.0 * PI * (square[0] * square[1] - quarter[0] * quarter[1]);
    near("volume of a rounded cylinder", volume, PI * radius * radius * length - taken, 1e-13);
    assert!(
        (center - DVec3::new(0.0, 0.0, length / 2.0)).length() < 1e-15 * MM && moments.x_axis.x == moments.y_axis.y
    );
    let (volume, center, moments) = of(Shape::Box { size: DVec3::new(1.0, 2.0, 3.0) }, 0.0);
    near("moment of a box", moments.x_axis.x, 6.5, 1e-15);
    near("moment of a box", moments.z_axis.z, 2.5, 1e-15);
    assert!(volume == 6.0 && center == DVec3::ZERO);
    let (rounded, ..) = of(Shape::Box { size: DVec3::new(1.0, 2.0, 3.0) }, 0.1);
    // what rounding takes from twelve edges and eight corners
    let taken = (4.0 - PI) * 0.01 * (0.8 + 1.8 + 2.8) + (8.0 - 4.0 / 3.0 * PI) * 1e-3;
    near("volume of a rounded box", rounded, 6.0 - taken, 1e-15);
    // a cube that is a ball but for nothing
    let (volume, _, moments) = of(Shape::Box { size: DVec3::splat(2.0) }, 1.0 - 1e-8);
    near("volume of a ball", volume, 4.0 / 3.0 * PI, 1e-7);
    near("moment of a ball", moments.y_axis.y, 8.0 / 15.0 * PI, 1e-7);
    assert!(Geometry::Analytic(Solid::new(Shape::Plane {}, 0.0).unwrap()).volume_moments().is_none());
}

/// What the bevel leaves is as high as its middle; a column at x is shorter by (outer − x) tan β.
#[test]
fn a_bevelled_tube_has_the_moments_of_its_closed_form() {
    for (length, inner, outer, bevel) in [(12.0, 2.0, 3.0, 40.0_f64), (120.0, 0.9, 1.0, 75.0), (12.0, 2.0, 3.0, 1e-9)] {
        let [l, a, b] = [length, inner, outer].map(|size| size * MM);
        let t = bevel.to_radians().tan();
        let (area, square) = (PI * (b - a) * (b + a), PI * (b.powi(4) - a.powi(4)) / 4.0);
        // integrals of 1, h, h² and h³ over the ring, h = (outer − x) t the height of the plane; x³ goes out
        let (h1, h2) = (area * b * t, (area * b * b + square) * t * t);
        let h3 = (area * b.powi(3) + 3.0 * b * square) * t.powi(3);
        let volume = area * l - h1;
        let x = square * t / volume;
        let z = (area * l * l - h2) / (2.0 * volume);
        // of z² and of x z about the origin: x h² is −2 outer x² t² over the ring
        let (zz, xz) = ((area * l.powi(3) - h3) / 3.0, b * square * t * t);
        let fourth = square * l - b * t * square;
        let (found, center, moments) = of(Shape::Tube { length: l, inner: a, outer: b, bevel }, 0.0);
        near("volume", found, volume, 1e-12);
        near("z of the centre", center.z, z, 1e-12);
        assert!((center.x - x).abs() < 1e-12 * b && center.y == 0.0);
        let [xx, yy, zz] = [fourth - volume * x * x, fourth, zz - volume * z * z];
        near("about x", moments.x_axis.x, yy + zz, 1e-11);
        near("about y", moments.y_axis.y, xx + zz, 1e-11);
        near("about z", moments.z_axis.z, xx + yy, 1e-11);
        assert!((moments.x_axis.z + xz - volume * x * z).abs() < 1e-11 * (yy + zz), "{moments} {xz}");
    }
}

/// Rounded and bevelled: as its distances say, column by column. Triangles of the surface do not end where the bevel
/// meets what is rounded.
#[test]
fn a_rounded_bevelled_tube_has_the_moments_of_what_is_inside() {
    for (bevel, rounding) in [(40.0, 0.45 * MM), (70.0, 0.3 * MM), (3.0, 0.45 * MM), (0.0, 0.2 * MM), (1e-7, 0.2 * MM)]
    {
        let shape = Shape::Tube { length: 20.0 * MM, inner: 2.0 * MM, outer: 3.0 * MM, bevel };
        let solid = Solid::new(shape, rounding).unwrap();
        let (volume, center, moments) = Geometry::Analytic(solid.clone()).volume_moments().unwrap();
        let (found, place, others) = by_columns(&solid, 400);
        near(&format!("volume at {bevel}°"), volume, found, 1e-5);
        assert!((center - place).length() < 1e-5 * 3.0 * MM, "{bevel}: {center} {place}");
        let off = (moments - others).to_cols_array().map(f64::abs).into_iter().fold(0.0, f64::max);
        assert!(off < 1e-5 * moments.x_axis.x, "{bevel}: {moments} {others}");
    }
}

/// Midpoints over half a ring of columns, by an angle across in which its rounded edges are smooth, their ends by
/// halving.
fn by_columns(solid: &Solid, count: usize) -> Moments {
    let Shape::Tube { length, inner, outer: radius, .. } = *solid.shape() else { unreachable!() };
    let step = PI / count as f64;
    let [middle, half] = [(radius + inner) / 2.0, (radius - inner) / 2.0];
    let mut sums = Sums::none();
    for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
        let [across, around] = [i, j].map(|i| (i as f64 + 0.5) * step);
        let rho = middle - half * across.cos();
        let [x, y] = [rho * around.cos(), rho * around.sin()];
        let section = 2.0 * rho * half * across.sin() * step * step;
        let end = |mut within: f64, mut beyond: f64| {
            for _ in 0..40 {
                let z = 0.5 * (within + beyond);
                *(if solid.distance(DVec3::new(x, y, z)).0 < 0.0 { &mut within } else { &mut beyond }) = z;
            }
            within
        };
        let within = length - solid.rounding() * 1.01;
        let [low, high] = [0.0, length].map(|z| end(within, z));
        let (z, height) = ((low + high) / 2.0, high - low);
        let volume = section * height;
        sums.volume += volume;
        sums.first += DVec3::new(x, 0.0, z) * volume;
        let mut second = outer(DVec3::new(x, 0.0, z));
        second += DMat3::from_diagonal(DVec3::new(0.0, y * y, height * height / 12.0));
        sums.second += second * volume;
    }
    sums.about(DVec3::ZERO)
}

#[test]
fn a_mesh_weighs_what_its_triangles_enclose_whatever_the_grid_is() {
    let size = DVec3::new(3.0, 3.0, 100.0) * MM;
    let bar = triangles(&Solid::new(Shape::Box { size }, 0.0).unwrap(), 16);
    let spacing = DistanceGrid::usual_spacing(&bar);
    let squares = DVec3::new(10_009.0, 10_009.0, 18.0) * MM * MM;
    for (place, bound) in [(DVec3::ZERO, 1e-14), (DVec3::new(5.0, -7.0, 3.0), 1e-10)] {
        let mut moved = bar.clone();
        moved.points.iter_mut().for_each(|point| *point += place);
        let (volume, center, moments) = grid(moved, spacing);
        near("volume", volume, 9e-7, bound);
        assert!((center - place).length() < 1e-15 * (1.0 + place.length() / MM), "{center}");
        for axis in 0..3 {
            near("moment", moments.col(axis)[axis], volume / 12.0 * squares[axis], bound);
        }
    }
    // turned and hollow: two boxes, one of them the other way round
    let turn = DMat3::from_rotation_x(0.7) * DMat3::from_rotation_z(0.4);
    let [outside, inside] = [DVec3::new(20.0, 30.0, 40.0) * MM, DVec3::new(10.0, 12.0, 14.0) * MM];
    let boxes = [outside, inside].map(|size| triangles(&Solid::new(Shape::Box { size }, 0.0).unwrap(), 4));
    let [mut hollow, hole] = boxes;
    let first = hollow.points.len() as u32;
    hollow.points.extend(hole.points);
    hollow.triangles.extend(hole.triangles.into_iter().map(|[a, b, c]| [b, a, c].map(|row| first + row)));
    hollow.points.iter_mut().for_each(|point| *point = turn * *point);
    let (volume, center, moments) = grid(hollow, 1.0 * MM);
    let of_box = |size: DVec3| {
        let squares = DVec3::splat((size * size).element_sum()) - size * size;
        (size.element_product(), squares * (size.element_product() / 12.0))
    };
    let ([whole, hole], [of_whole, of_hole]) =
        ([of_box(outside).0, of_box(inside).0], [of_box(outside).1, of_box(inside).1]);
    near("volume", volume, whole - hole, 1e-14);
    let expected = turn * DMat3::from_diagonal(of_whole - of_hole) * turn.transpose();
    let off = (moments - expected).to_cols_array().map(f64::abs).into_iter().fold(0.0, f64::max);
    assert!(center.length() < 1e-16 && off < 1e-14 * of_whole.x, "{center} {moments} {expected}");
}
