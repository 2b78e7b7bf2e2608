//! Parts that a grid of distances does not have are told, and how fine it is where nothing is said.

use super::super::{DistanceGrid, Shape, Solid};
use glam::{DMat3, DVec3};
use sinew_mesh::{SurfaceError, Triangles};
use std::f64::consts::TAU;

const MM: f64 = 1e-3;

fn of_shape(shape: Shape, rounding: f64, segments: usize) -> Triangles {
    let (points, triangles) = Solid::new(shape, rounding).unwrap().surface(segments, 0.0);
    Triangles { points, triangles, ..Triangles::default() }
}

/// A profile (radius, z; m) from the axis to the axis, upwards, turned about it.
fn turned(profile: &[(f64, f64)], segments: u32) -> Triangles {
    let [(_, low), (_, high)] = [profile[0], profile[profile.len() - 1]];
    let rings = &profile[1..profile.len() - 1];
    let around = |i: u32| (TAU * f64::from(i) / f64::from(segments)).sin_cos();
    let mut points = vec![DVec3::new(0.0, 0.0, low), DVec3::new(0.0, 0.0, high)];
    for &(radius, z) in rings {
        points.extend((0..segments).map(around).map(|(sin, cos)| DVec3::new(radius * cos, radius * sin, z)));
    }
    let row = |ring: usize, i: u32| 2 + ring as u32 * segments + i % segments;
    let mut triangles = Vec::new();
    for i in 0..segments {
        triangles.extend([[0, row(0, i + 1), row(0, i)], [1, row(rings.len() - 1, i), row(rings.len() - 1, i + 1)]]);
        for ring in 1..rings.len() {
            let [a, b, c, d] = [row(ring - 1, i), row(ring - 1, i + 1), row(ring, i + 1), row(ring, i)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Triangles { points, triangles, ..Triangles::default() }
}

/// A handle (m) with a tip of a radius and a length before it, which is round at its end.
fn with_tip(radius: f64, length: f64, segments: u32) -> Triangles {
    let arc = (1..8).map(|i| (TAU / 32.0 * f64::from(i)).sin_cos());
    let mut profile = vec![(0.0, 0.0)];
    profile.extend(arc.map(|(sin, cos)| (radius * sin, radius * (1.0 - cos))));
    profile.extend([(radius, radius), (radius, length), (10.5 * MM, length), (10.5 * MM, length + 36.0 * MM)]);
    profile.push((0.0, length + 36.0 * MM));
    turned(&profile, segments)
}

fn rotated(mut surface: Triangles, turn: DMat3) -> Triangles {
    surface.points.iter_mut().for_each(|point| *point = turn * *point);
    surface
}

fn turns() -> [DMat3; 3] {
    [DMat3::IDENTITY, DMat3::from_rotation_x(0.5) * DMat3::from_rotation_z(0.3), DMat3::from_rotation_y(1.1)]
}

fn lost(grid: &DistanceGrid) -> Vec<&String> {
    grid.notes().iter().filter(|note| note.contains("is lost: at (")).collect()
}

/// The numbers in the note of what is lost between two texts.
fn told<const N: usize>(grid: &DistanceGrid, after: &str, before: &str) -> [f64; N] {
    let notes = lost(grid);
    assert_eq!(notes.len(), 1, "{:?}", grid.notes());
    let text = notes[0].split(after).nth(1).and_then(|rest| rest.split(before).next()).unwrap();
    let numbers: Vec<f64> = text.split(", ").map(|number| number.parse().unwrap()).collect();
    numbers.try_into().unwrap()
}

#[test]
fn a_tip_that_is_lost_is_told_with_its_place_its_reach_and_a_spacing_that_has_it() {
    // four points of the grid are about the axis of the first two; in those that are turned a tip may leave some traces
    for (radius, length, segments, turn) in [(0.3, 4.0, 24, 0), (0.3, 4.0, 4, 0), (0.3, 4.0, 24, 1), (0.12, 2.5, 6, 2)]
    {
        let tip = rotated(with_tip(radius * MM, length * MM, segments), turns()[turn]);
        let grid = DistanceGrid::new(&tip, 0.85 * MM).unwrap();
        let what = format!("{radius} {length} {segments} {turn}: {:?}", grid.notes());
        let [reach] = told(&grid, "reaches ", " m beyond");
        assert!(reach < (length + 1.0) * MM && reach > if turn == 0 { 0.9 * length * MM } else { 1.1 * MM }, "{what}");
        if turn == 0 {
            let at = DVec3::from_array(told(&grid, "at (", ") m"));
            assert!(at.length() < 0.5 * MM, "{what}");
        }
        if radius < 0.2 {
            assert!(lost(&grid)[0].contains("too thin for a grid of all"), "{what}");
            continue;
        }
        let [finer] = told(&grid, "a `spacing` of ", " m,");
        assert!((0.5 * radius..1.1 * radius).contains(&(finer / MM)), "{what}");
        let grid = DistanceGrid::new(&tip, finer).unwrap();
        assert!(lost(&grid).is_empty(), "{what} {:?}", grid.notes());
        assert!(grid.distance(turns()[turn] * DVec3::new(0.0, 0.0, MM)).0 < 0.0, "{what}");
    }
}

#[test]
fn long_thin_triangles_and_needles_are_looked_at_all_along() {
    // the sides of the needle have no corner between 3 and 30 mm
    let profile = [(0.0, 0.0), (0.2, 3.0), (0.2, 30.0), (8.0, 31.0), (0.0, 60.0)];
    let needle = turned(&profile.map(|(radius, z)| (radius * MM, z * MM)), 8);
    let grid = DistanceGrid::new(&needle, 0.97 * MM).unwrap();
    let [reach] = told(&grid, "reaches ", " m beyond");
    assert!((28.0 * MM..32.0 * MM).contains(&reach), "{:?}", grid.notes());
    // a wire beside a ball, and one alone
    let wire = turned(&[(0.0, -9.0), (0.02, -9.0), (0.02, 9.0), (0.0, 9.0)].map(|(r, z)| (r * MM, z * MM)), 6);
    let mut both = of_shape(Shape::Sphere { radius: 5.0 * MM }, 0.0, 32);
    let first = both.points.len() as u32;
    both.points.extend(wire.points.iter().map(|point| point + DVec3::new(7.0 * MM, 0.13 * MM, 0.0)));
    both.triangles.extend(wire.triangles.iter().map(|corners| corners.map(|row| first + row)));
    let grid = DistanceGrid::new(&both, 0.5 * MM).unwrap();
    let [x, ..] = told::<3>(&grid, "at (", ") m");
    assert!((x - 7.0 * MM).abs() < 0.03 * MM, "{:?}", grid.notes());
}

/// A tool that would touch nothing is none.
#[test]
fn a_surface_of_which_the_grid_has_nothing_is_refused() {
    let wire = turned(&[(0.0, -9.0), (0.02, -9.0), (0.02, 9.0), (0.0, 9.0)].map(|(r, z)| (r * MM, z * MM)), 6);
    let ball = of_shape(Shape::Sphere { radius: 5.0 * MM }, 0.0, 16);
    for (surface, spacing) in [(rotated(wire, turns()[1]), 1.0 * MM), (ball.clone(), 1.0)] {
        let error = DistanceGrid::new(&surface, spacing).unwrap_err();
        assert_eq!(error, SurfaceError::Lost { spacing });
        assert!(error.to_string().contains("there is nothing inside"), "{error}");
    }
    assert!(DistanceGrid::new(&ball, 1.0 * MM).is_ok());
}

#[test]
fn edges_and_points_of_what_is_sharp_are_not_told_of() {
    let opening = |degrees: f64| 30.0 * MM * (degrees.to_radians() / 2.0).tan();
    let mut surfaces: Vec<(String, Triangles)> = Vec::new();
    for degrees in [20.0, 40.0, 90.0] {
        for segments in [8, 25] {
            let shape = Shape::Cone { length: 30.0 * MM, tip: 0.0, base: opening(degrees) };
            surfaces.push((format!("cone of {degrees}°, {segments}"), of_shape(shape, 0.0, segments)));
        }
    }
    for size in [[4.0, 6.0, 3.0], [5.0, 5.0, 5.0], [6.0, 6.0, 100.0]] {
        surfaces.push((format!("box {size:?}"), of_shape(Shape::Box { size: DVec3::from(size) * MM }, 0.0, 4)));
    }
    for (length, inner, outer, bevel) in
        [(12.0, 2.0, 3.0, 30.0), (12.0, 2.0, 3.0, 0.0), (40.0, 1.0, 3.0, 60.0), (20.0, 1.0, 4.0, 45.0)]
    {
        let [length, inner, outer] = [length, inner, outer].map(|size| size * MM);
        let tube = of_shape(Shape::Tube { length, inner, outer, bevel }, 0.0, 32);
        surfaces.push((format!("tube {length} {bevel}"), tube));
    }
    surfaces.push(("ball".into(), of_shape(Shape::Sphere { radius: 5.0 * MM }, 0.0, 64)));
    surfaces.push(("coarse ball".into(), of_shape(Shape::Sphere { radius: 5.0 * MM }, 0.0, 6)));
    surfaces.push(("capsule".into(), of_shape(Shape::Capsule { length: 60.0 * MM, radius: 2.0 * MM }, 0.0, 24)));
    // an octahedron, and one with five sides
    surfaces.push(("octahedron".into(), turned(&[(0.0, -3.0), (3.0, 0.0), (0.0, 3.0)], 4)));
    surfaces
        .push(("icosahedron".into(), turned(&[(0.0, -5f64.sqrt()), (2.0, -1.0), (2.0, 1.0), (0.0, 5f64.sqrt())], 5)));
    for (name, surface) in surfaces {
        for turn in &turns()[..2] {
            let surface = rotated(surface.clone(), *turn);
            let grid = DistanceGrid::new(&surface, DistanceGrid::usual_spacing(&surface)).unwrap();
            assert!(lost(&grid).is_empty(), "{name}, {turn}: {:?}", grid.notes());
        }
    }
}

#[test]
fn a_slender_surface_has_finer_cells_of_as_many_points() {
    let of_box = |x: f64, y: f64, z: f64| of_shape(Shape::Box { size: DVec3::new(x, y, z) * MM }, 0.0, 4);
    assert_eq!(DistanceGrid::usual_spacing(&of_box(7.0, 7.0, 7.0)), 7.0 * MM / 59.0);
    for (x, y, z, across) in
        [(6.0, 6.0, 100.0, 20.0), (3.0, 40.0, 40.0, 5.0), (0.5, 100.0, 0.5, 6.0), (30.0, 29.0, 31.0, 55.0)]
    {
        let surface = of_box(x, y, z);
        let spacing = DistanceGrid::usual_spacing(&surface);
        assert!(spacing <= x.max(y).max(z) * MM / 59.0 && x.min(y) * MM / spacing > across, "{x} {y} {z}: {spacing}");
        let points = DistanceGrid::new(&surface, spacing).unwrap().values().len();
        assert!((200_000..=262_144).contains(&points), "{x} {y} {z}: {points}");
    }
    // flat and without a size
    let mut flat = of_box(1.0, 1.0, 1.0);
    flat.points.iter_mut().for_each(|point| *point = DVec3::ZERO);
    assert!(DistanceGrid::new(&flat, DistanceGrid::usual_spacing(&flat)).is_err());
}
