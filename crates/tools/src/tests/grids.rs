//! Distances on grids, against closed forms and against triangles one by one.

use super::super::closed::Closed;
use super::super::{DistanceGrid, Geometry, Shape, Solid};
use super::{corners, place, to_triangles, winding};
use glam::DVec3;
use sinew_mesh::{SurfaceError, Triangles};
use std::f64::consts::TAU;
use std::sync::Arc;

fn triangles((points, triangles): (Vec<DVec3>, Vec<[u32; 3]>)) -> Triangles {
    Triangles { points, triangles, ..Triangles::default() }
}

fn of_shape(shape: Shape, rounding: f64, segments: usize) -> Triangles {
    triangles(Solid::new(shape, rounding).unwrap().surface(segments, 0.0))
}

/// A torus about the z axis.
fn torus(ring: f64, tube: f64, around: u32, across: u32) -> Triangles {
    let point = |i: u32, j: u32| {
        let [u, v] = [TAU * f64::from(i) / f64::from(around), TAU * f64::from(j) / f64::from(across)];
        let rho = ring + tube * v.cos();
        DVec3::new(rho * u.cos(), rho * u.sin(), tube * v.sin())
    };
    let row = |i: u32, j: u32| (i % around) * across + j % across;
    let places = (0..around).flat_map(|i| (0..across).map(move |j| (i, j)));
    let quad = |(i, j)| {
        let [a, b, c, d] = [row(i, j), row(i + 1, j), row(i + 1, j + 1), row(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    Triangles {
        points: places.clone().map(|(i, j)| point(i, j)).collect(),
        triangles: places.flat_map(quad).collect(),
        ..Triangles::default()
    }
}

fn cube() -> Triangles {
    of_shape(Shape::Box { size: DVec3::splat(2.0) }, 0.0, 4)
}

fn moved(mut surface: Triangles, by: DVec3) -> Triangles {
    surface.points.iter_mut().for_each(|point| *point += by);
    surface
}

fn together(mut one: Triangles, other: Triangles) -> Triangles {
    let first = one.points.len() as u32;
    one.points.extend(other.points);
    one.triangles.extend(other.triangles.into_iter().map(|corners| corners.map(|row| first + row)));
    one
}

/// The largest difference to a closed form within a band about the surface (m), of distances and of directions.
fn worst(grid: &DistanceGrid, band: f64, exact: impl Fn(DVec3) -> (f64, DVec3)) -> [f64; 2] {
    let mut dice = fastrand::Rng::with_seed(3);
    let (center, radius) = grid.bounding_sphere();
    let mut worst = [0.0_f64; 2];
    let mut seen = 0;
    while seen < 3000 {
        let y = place(&mut dice, center, 1.2 * radius);
        let (distance, gradient) = exact(y);
        if distance.abs() < band {
            let found = grid.distance(y);
            assert!((found.1.length() - 1.0).abs() < 1e-12);
            worst = [worst[0].max((found.0 - distance).abs()), worst[1].max(found.1.distance(gradient))];
            seen += 1;
        }
    }
    worst
}

/// The largest difference of two grids' distances (m) in and about the cube.
fn apart(one: &DistanceGrid, other: &DistanceGrid) -> f64 {
    let mut dice = fastrand::Rng::with_seed(7);
    let places = (0..3000).map(|_| place(&mut dice, DVec3::ZERO, 1.3));
    places.map(|y| (one.distance(y).0 - other.distance(y).0).abs()).fold(0.0, f64::max)
}

#[test]
fn a_ball_and_a_torus_are_those_of_closed_forms_and_nearer_on_finer_grids() {
    let ball = of_shape(Shape::Sphere { radius: 5e-3 }, 0.0, 160);
    let exact = Solid::new(Shape::Sphere { radius: 5e-3 }, 0.0).unwrap();
    let ring = torus(4e-3, 1.5e-3, 240, 120);
    let of_torus = |y: DVec3| {
        let rho = y.truncate().length();
        let middle = (y.truncate() / rho * 4e-3).extend(0.0);
        (y.distance(middle) - 1.5e-3, (y - middle).normalize())
    };
    let at = |spacing: f64| {
        let grids = [&ball, &ring].map(|surface| DistanceGrid::new(surface, spacing).unwrap());
        let found = [worst(&grids[0], 0.3e-3, |y| exact.distance(y)), worst(&grids[1], 0.3e-3, of_torus)];
        assert!(grids.iter().all(|grid| grid.notes().is_empty()));
        found
    };
    let (coarse, fine) = (at(0.4e-3), at(0.2e-3));
    // chords of 160 and 120 segments; spacing² / 8 times both curvatures, which are 1/4 and 1/0.8 per mm at most
    for (found, [chord, curvature]) in coarse.iter().zip([[2.0e-6, 2.0 / 4e-3], [1.0e-6, 1.0 / 0.8e-3 + 1.0 / 2e-3]]) {
        assert!(found[0] < chord + 0.4e-3 * 0.4e-3 / 8.0 * curvature, "{found:?}");
        assert!(found[1] < 0.4e-3 * curvature + 0.1, "{found:?}");
    }
    for (coarse, fine) in coarse.iter().zip(&fine) {
        assert!(fine[0] < coarse[0] / 2.0 && fine[1] < coarse[1] / 1.5, "{coarse:?} {fine:?}");
    }
}

#[test]
fn a_box_is_that_of_its_closed_form_away_from_its_edges() {
    let shape = Shape::Box { size: DVec3::new(4.0, 6.0, 3.0) };
    let grid = DistanceGrid::new(&of_shape(shape.clone(), 0.0, 4), 0.13).unwrap();
    let solid = Solid::new(shape, 0.0).unwrap();
    let mut dice = fastrand::Rng::with_seed(4);
    let mut seen = 0;
    for _ in 0..20_000 {
        let y = place(&mut dice, DVec3::ZERO, 3.2);
        let (distance, gradient) = solid.distance(y);
        let (found, direction) = grid.distance(y);
        assert!((found - distance).abs() < 0.1, "at {y}: {found}, {distance}");
        // faces are flat: where nothing else is near, the grid is exact
        let is_plain = |at: DVec3| solid.distance(at).1 == gradient;
        if DVec3::AXES.iter().all(|axis| is_plain(y + 0.25 * axis) && is_plain(y - 0.25 * axis)) {
            assert!((found - distance).abs() < 1e-6 && direction.distance(gradient) < 1e-5, "at {y}");
            seen += 1;
        }
    }
    assert!(seen > 5000, "{seen}");
    // at the corners
    assert!((0.01..0.066).contains(&grid.surface_error()), "{}", grid.surface_error());
    assert!((grid.depth() - 1.5).abs() < 0.07 && grid.notes().is_empty(), "{:?}", grid.notes());
}

#[test]
fn points_of_the_grid_are_as_far_as_the_nearest_triangle_and_inside_where_triangles_go_round_them() {
    // not convex, with a hole, a cavity and long thin triangles
    let tube = of_shape(Shape::Tube { length: 2.0, inner: 0.4, outer: 0.9, bevel: 30.0 }, 0.05, 9);
    let mut cavity = moved(cube(), DVec3::new(5.0, 0.0, 0.0));
    cavity.triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
    let hollow = together(torus(4.0, 1.2, 7, 5), tube);
    let outer = of_shape(Shape::Sphere { radius: 8.0 }, 0.0, 11);
    let outer = together(moved(outer, DVec3::new(-10.0, 0.0, 0.0)), moved(cavity, DVec3::new(-15.0, 0.0, 0.0)));
    for surface in [hollow, outer] {
        let grid = DistanceGrid::new(&surface, DistanceGrid::usual_spacing(&surface)).unwrap_or_else(|e| panic!("{e}"));
        let brute = (surface.points.clone(), surface.triangles.clone());
        let mut dice = fastrand::Rng::with_seed(5);
        let mut inside = 0;
        for _ in 0..1500 {
            let [i, j, k] = grid.counts().to_array().map(|count| dice.u32(0..count));
            let y = grid.origin() + grid.spacing() * DVec3::new(i.into(), j.into(), k.into());
            let (nx, ny) = (grid.counts().x, grid.counts().y);
            let value = f64::from(grid.values()[(i + nx * (j + ny * k)) as usize]);
            let distance = to_triangles(y, &brute);
            assert!((value.abs() - distance).abs() < 1e-6 * (1.0 + distance), "at {y}: {value}, {distance}");
            assert_eq!(value < 0.0, winding(y, &brute) > 0.5, "at {y}: {value}");
            inside += usize::from(value < 0.0);
        }
        assert!(inside > 80, "{inside}");
    }
}

#[test]
fn outside_its_grid_a_surface_is_where_it_is() {
    let grid = DistanceGrid::new(&torus(4.0, 1.5, 60, 30), 0.3).unwrap();
    let mut dice = fastrand::Rng::with_seed(6);
    for _ in 0..3000 {
        let y = place(&mut dice, DVec3::ZERO, 30.0);
        let (distance, gradient) = grid.distance(y);
        let exact = (y.truncate().length() - 4.0).hypot(y.z) - 1.5;
        let slack = if exact > 2.0 { 0.12 * exact } else { 0.35 };
        assert!(distance - exact < slack && distance - exact > -0.2, "at {y}: {distance}, {exact}");
        assert!((gradient.length() - 1.0).abs() < 1e-12);
        // goes on where the grid ends
        let border = y.clamp(grid.origin(), grid.origin() + grid.spacing() * (grid.counts() - 1).as_dvec3());
        let [beside, at] = [border + 1e-9 * (y - border), border].map(|y| grid.distance(y));
        assert!((beside.0 - at.0).abs() < 1e-7 && beside.1.distance(at.1) < 1e-6);
    }
    for y in [DVec3::MAX, DVec3::MIN, DVec3::splat(1e-300), DVec3::ZERO] {
        let (distance, gradient) = grid.distance(y);
        assert!(distance.is_finite() && distance > 0.0 && (gradient.length() - 1.0).abs() < 1e-12, "{y}");
    }
}

#[test]
fn the_same_bits_on_any_number_of_threads() {
    let surface = torus(4.0, 1.5, 30, 20);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| DistanceGrid::new(&surface, 0.2).unwrap())
    };
    let [one, three] = [1, 3].map(on);
    assert!(one == three && one.values().iter().zip(three.values()).all(|(a, b)| a.to_bits() == b.to_bits()));
}

#[test]
fn what_is_not_closed_is_refused_with_its_edges() {
    let refused = |surface: Triangles| DistanceGrid::new(&surface, 0.2).unwrap_err();
    let mut open = cube();
    open.triangles.truncate(open.triangles.len() - 1);
    let told = refused(open.clone()).to_string();
    assert!(told.contains("3 edges belong to one triangle only: (") && told.contains(" m to ("), "{told}");
    let mut turned = cube();
    turned.triangles[3].swap(0, 1);
    let SurfaceError::Edges(faults) = refused(turned) else { panic!("another error") };
    assert_eq!((faults.len(), faults[0].count, faults[0].first.len()), (1, 3, 3));
    assert!(faults[0].what.contains("opposite orientation"));
    let twice = refused(together(cube(), cube())).to_string();
    assert!(twice.contains("edges belong to more than two triangles") && twice.ends_with(", ..."), "{twice}");
    let beside = refused(together(cube(), moved(cube(), DVec3::new(2.0, 2.0, 0.0)))).to_string();
    assert!(beside.contains("1 edges belong to more than two"), "{beside}");
    assert_eq!(refused(Triangles::default()), SurfaceError::Empty);
    let mut flat = cube();
    flat.points.iter_mut().for_each(|point| point.z = 0.0);
    assert!(matches!(refused(flat), SurfaceError::Edges(_) | SurfaceError::Flat));
    let mut lost = cube();
    lost.points[2].y = f64::NAN;
    assert!(matches!(refused(lost), SurfaceError::Place { point: 2, .. }));
    let mut beyond = cube();
    beyond.triangles[1][2] = 99;
    assert_eq!(refused(beyond), SurfaceError::Row { triangle: 1, point: 99, points: cube().points.len() });
}

#[test]
fn what_crosses_itself_is_refused_with_a_place() {
    let across = together(cube(), moved(cube(), DVec3::new(1.1, 1.2, 1.3)));
    let within = together(of_shape(Shape::Sphere { radius: 4.0 }, 0.0, 20), cube());
    let mut inside_out = moved(cube(), DVec3::new(9.0, 0.0, 0.0));
    inside_out.triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
    let beside = together(of_shape(Shape::Sphere { radius: 4.0 }, 0.0, 20), inside_out);
    for surface in [across, within, beside] {
        let error = DistanceGrid::new(&surface, 0.2).unwrap_err();
        assert!(matches!(error, SurfaceError::Crosses { count: 1.., .. }), "{error}");
    }
}

/// Nearer to each other than cells of the grid, so that none of these sees an inside and an outside too many.
#[test]
fn a_shell_close_beneath_another_that_is_turned_outwards_too_is_refused() {
    let ball = |radius: f64| of_shape(Shape::Sphere { radius }, 0.0, 48);
    let error = DistanceGrid::new(&together(ball(1.0), ball(0.97)), 0.1).map(drop).unwrap_err();
    let is_twice = |enclosed: f64, inside: f64| enclosed > 1.7 * inside && (3.5..5.0).contains(&inside);
    assert!(matches!(error, SurfaceError::Twice { enclosed, inside } if is_twice(enclosed, inside)), "{error}");
    let mut hollow = ball(0.7);
    hollow.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    assert!(DistanceGrid::new(&together(ball(1.0), hollow), 0.1).is_ok());
}

#[test]
fn a_grid_that_is_too_large_is_refused_with_the_spacing_that_is_not() {
    for spacing in [1e-3, 1e-300, 0.0, -1.0, f64::NAN, f64::INFINITY] {
        let SurfaceError::Spacing { least, most, .. } = DistanceGrid::new(&cube(), spacing).unwrap_err() else {
            panic!("another error")
        };
        assert!((0.0079..0.0082).contains(&least) && most == 1 << 24, "{spacing}: {least}");
    }
    assert!(DistanceGrid::new(&cube(), 0.05).unwrap().counts().cmpeq(glam::UVec3::splat(45)).all());
}

#[test]
fn a_surface_that_is_inside_out_is_turned_round() {
    let mut surface = cube();
    surface.triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
    let (turned, plain) = (DistanceGrid::new(&surface, 0.1).unwrap(), DistanceGrid::new(&cube(), 0.1).unwrap());
    assert!(turned.notes()[0].contains("inside out") && apart(&turned, &plain) < 1e-6);
}

#[test]
fn triangles_without_area_change_nothing() {
    let plain = DistanceGrid::new(&cube(), 0.1).unwrap();
    // one with two equal corners, and one whose corners lie on an edge of the cube, that fills a gap of no width
    let mut surface = cube();
    let [a, b, c] = surface.triangles[0];
    let other = (0..surface.triangles.len())
        .find(|&t| (0..3).any(|i| [surface.triangles[t][i], surface.triangles[t][(i + 1) % 3]] == [b, a]))
        .unwrap();
    assert!(other > 0);
    let middle = surface.points.len() as u32;
    surface.points.push((surface.points[a as usize] + surface.points[b as usize]) / 2.0);
    surface.triangles[0] = [a, middle, c];
    surface.triangles.extend([[middle, b, c], [a, b, middle], [c, c, a]]);
    let grid = DistanceGrid::new(&surface, 0.1).unwrap();
    assert_eq!(grid.notes().len(), 2, "{:?}", grid.notes());
    assert!(grid.notes()[0].starts_with("1 triangles with two") && grid.notes()[1].starts_with("1 triangles without"));
    assert!(apart(&grid, &plain) < 1e-6);
    // slivers have normals of their own
    surface.points[middle as usize] *= 1.0 + 1e-6;
    let grid = DistanceGrid::new(&surface, 0.1).unwrap();
    // the grid is another
    let finer = DistanceGrid::new(&cube(), 0.0999).unwrap();
    assert!(grid.notes().len() == 1 && apart(&grid, &finer) < 0.03, "{} {:?}", apart(&grid, &finer), grid.notes());
}

/// A blade is as thin as it is, whatever is beside it; what is round or has right angles only is as thin as it is deep.
#[test]
fn half_of_the_thickness_is_told_where_it_is_least() {
    let of_box = |size: DVec3| of_shape(Shape::Box { size }, 0.0, 4);
    let beside = |thick: DVec3| moved(of_box(thick), DVec3::new(7.5, 0.0, 0.0));
    let blade = together(of_box(DVec3::new(8.0, 8.0, 0.2)), beside(DVec3::new(6.0, 6.0, 6.0)));
    let grid = DistanceGrid::new(&blade, 0.1).unwrap();
    let thinnest = grid.thinnest();
    assert!((thinnest - 0.1).abs() < 0.0501 && (grid.depth() - 3.0).abs() < 0.0501, "{thinnest}");
    assert_eq!(Geometry::Grid(Arc::new(grid)).smallest_radius(), Some(thinnest));
    let ball = of_shape(Shape::Sphere { radius: 1.0 }, 0.0, 80);
    let turned = |mut surface: Triangles| {
        let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -0.7, 1.1);
        surface.points.iter_mut().for_each(|point| *point = turn * *point);
        surface
    };
    for spacing in [0.1, 0.0837, 0.07] {
        for surface in [cube(), turned(cube()), ball.clone(), turned(of_box(DVec3::new(3.0, 2.0, 2.4)))] {
            let grid = DistanceGrid::new(&surface, spacing).unwrap();
            let (thinnest, depth) = (grid.thinnest(), grid.depth());
            assert!(thinnest <= depth && thinnest > 1.0 - 1.5 * spacing, "{spacing}: {thinnest}, {depth} deep");
        }
        let plate = DistanceGrid::new(&turned(of_box(DVec3::new(3.0, 3.0, 0.4))), spacing).unwrap();
        assert!((plate.thinnest() - 0.2).abs() < spacing, "{spacing}: {}", plate.thinnest());
    }
    // too thin for its grid: no less than can be known
    let lost = together(of_box(DVec3::new(8.0, 8.0, 0.05)), beside(DVec3::new(6.0, 6.0, 6.0)));
    let lost = DistanceGrid::new(&lost, 0.2).unwrap();
    assert!(lost.thinnest() <= lost.depth(), "{}", lost.thinnest());
}

#[test]
fn walls_thinner_than_the_spacing_are_told() {
    // wherever planes of the grid are, most of these are between two
    let notes = [0.03, 0.083, 0.12].map(|height| {
        let plate = of_shape(Shape::Box { size: DVec3::new(2.0, 2.0, 0.05) }, 0.0, 4);
        let both = together(moved(plate, height * DVec3::Z), moved(cube(), DVec3::new(3.0, 0.0, 0.0)));
        DistanceGrid::new(&both, 0.2).unwrap().notes().concat()
    });
    let told = notes.iter().filter(|note| note.contains("thinner than the spacing of the grid")).count();
    assert!(told >= 2, "{notes:?}");
}

#[test]
fn surfaces_that_touch_at_a_point_keep_their_normals() {
    let surface = together(cube(), moved(cube(), DVec3::splat(2.0)));
    let closed = Closed::new(&surface).unwrap();
    let brute = (closed.surface.points.clone(), closed.surface.triangles.clone());
    assert_eq!(brute.0.len() + 1, surface.points.len());
    for (triangle, normals) in corners(&brute).zip(&closed.normals) {
        // from the centre of its cube outwards
        let center = if triangle.iter().any(|corner| corner.max_element() > 1.5) { 2.0 } else { 0.0 };
        for (corner, normal) in triangle.iter().zip(&normals[4..]) {
            assert!((corner - DVec3::splat(center)).dot(*normal) > 0.0);
        }
    }
    let grid = DistanceGrid::new(&surface, 0.1).unwrap();
    let geometry = Geometry::Grid(Arc::new(grid));
    assert!(geometry.distance(DVec3::splat(0.9)).0 < 0.0 && geometry.distance(DVec3::new(1.2, 0.8, 1.0)).0 > 0.0);
}
