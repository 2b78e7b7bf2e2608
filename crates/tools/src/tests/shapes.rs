//! Signed distances to shapes, against their definition and against their surface.

use super::super::{Shape, Solid};
use super::{assert_closed, place, to_triangles, volume, winding};
use glam::DVec3;
use std::f64::consts::PI;

const MM: f64 = 1e-3;

/// All kinds, with the numbers of instruments.
fn shapes() -> Vec<Shape> {
    vec![
        Shape::Sphere { radius: 5.0 * MM },
        Shape::Box { size: DVec3::new(4.0, 6.0, 2.0) * MM },
        Shape::Capsule { length: 12.0 * MM, radius: 2.0 * MM },
        Shape::Capsule { length: 4.0 * MM, radius: 2.0 * MM },
        Shape::Cylinder { length: 8.0 * MM, radius: 3.0 * MM },
        Shape::Cone { length: 9.0 * MM, tip: 1.0 * MM, base: 3.0 * MM },
        Shape::Cone { length: 3.0 * MM, tip: 4.0 * MM, base: 2.0 * MM },
        Shape::Cone { length: 9.0 * MM, tip: 0.0, base: 3.0 * MM },
        Shape::Cone { length: 4.0 * MM, tip: 6.0 * MM, base: 0.0 },
        Shape::Cone { length: 5.0 * MM, tip: 2.0 * MM, base: 2.0 * MM },
        Shape::Tube { length: 7.0 * MM, inner: 2.0 * MM, outer: 3.0 * MM, bevel: 0.0 },
        Shape::Tube { length: 12.0 * MM, inner: 2.0 * MM, outer: 3.0 * MM, bevel: 40.0 },
    ]
}

/// Sharp, and rounded a little and much.
fn solids() -> Vec<Solid> {
    let rounded = |shape: Shape| {
        let most = [0.0, 0.2 * MM, 0.45 * MM];
        most.map(|rounding| {
            Solid::new(shape.clone(), rounding).unwrap_or_else(|problem| panic!("{shape:?}: {problem}"))
        })
    };
    shapes().into_iter().flat_map(rounded).collect()
}

fn is_bevelled(solid: &Solid) -> bool {
    matches!(solid.shape(), Shape::Tube { bevel, .. } if *bevel > 0.0)
}

/// Places in and about a solid, some of them at its surface.
fn places(solid: &Solid, count: usize) -> Vec<DVec3> {
    let mut dice = fastrand::Rng::with_seed(1);
    let (center, radius) = solid.bounding_sphere().unwrap_or((DVec3::ZERO, 5.0 * MM));
    let each = (0..count).map(|i| {
        let y = place(&mut dice, center, 1.5 * radius);
        let (distance, gradient) = solid.distance(y);
        if i % 4 == 0 { y - (1.0 + 1e-3 * (dice.f64() - 0.5)) * distance * gradient } else { y }
    });
    each.collect()
}

/// Whether a place is in a shape with sharp edges, as its description says it.
fn is_inside(shape: &Shape, y: DVec3) -> bool {
    let rho = y.truncate().length();
    let within = |length: f64| (0.0..length).contains(&y.z);
    match *shape {
        Shape::Plane {} => y.z < 0.0,
        Shape::Sphere { radius } => y.length() < radius,
        Shape::Box { size } => y.abs().cmplt(size / 2.0).all(),
        Shape::Capsule { length, radius } => {
            let rest = (y.z - length / 2.0).abs() - (length / 2.0 - radius);
            rho.hypot(rest.max(0.0)) < radius
        }
        Shape::Cylinder { length, radius } => within(length) && rho < radius,
        Shape::Cone { length, tip, base } => within(length) && rho < tip + (base - tip) * y.z / length,
        Shape::Tube { length, inner, outer, bevel } => {
            within(length) && inner < rho && rho < outer && y.z > (outer - y.x) * bevel.to_radians().tan()
        }
    }
}

#[test]
fn gradients_are_unit_vectors_and_slopes() {
    let plane = Solid::new(Shape::Plane {}, 1.0 * MM).unwrap();
    for solid in solids().into_iter().chain([plane]) {
        let mut compared = 0;
        for y in places(&solid, 2000) {
            let (distance, gradient) = solid.distance(y);
            assert!(distance.is_finite() && (gradient.length() - 1.0).abs() < 1e-12, "{solid:?} at {y}: {gradient}");
            let h = 1e-8;
            let around = DVec3::AXES.map(|axis| [y + h * axis, y - h * axis].map(|y| solid.distance(y)));
            // ridges and edges are where the gradient jumps or turns fast
            if around.iter().flatten().all(|(_, other)| other.distance(gradient) < 1e-3) {
                let slope = DVec3::from_array(around.map(|[a, b]| (a.0 - b.0) / (2.0 * h)));
                assert!(slope.distance(gradient) < 1e-5, "{solid:?} at {y}: {gradient}, slope {slope}");
                compared += 1;
            }
        }
        assert!(compared > 1200, "{solid:?}: {compared}");
    }
}

#[test]
fn the_sign_is_that_of_inside_and_outside() {
    for shape in shapes().into_iter().chain([Shape::Plane {}]) {
        let solid = Solid::new(shape.clone(), 0.0).unwrap();
        let inside = |y: &DVec3| is_inside(&shape, *y);
        let all = places(&solid, 2000);
        let wrong = all.iter().find(|y| (solid.distance(**y).0 < 0.0) != inside(y));
        assert!(wrong.is_none(), "{shape:?} at {wrong:?}");
        assert!((50..1900).contains(&all.iter().filter(|y| inside(y)).count()), "{shape:?}");
    }
}

#[test]
fn a_rounded_shape_is_all_balls_of_that_radius_in_the_sharp_one() {
    for solid in solids() {
        let sharp = Solid::new(solid.shape().clone(), 0.0).unwrap();
        let r = solid.rounding();
        for y in places(&solid, 2000) {
            let (round, sharp) = (solid.distance(y).0, sharp.distance(y).0);
            // a centre of such a ball is as deep in either
            assert!((round <= -r) == (sharp <= -r) || (sharp + r).abs() < 1e-12, "{solid:?} at {y}: {round} {sharp}");
            assert!(round >= sharp - 1e-12, "{solid:?} at {y}: {round} {sharp}");
        }
    }
}

#[test]
fn distances_are_those_to_the_surface() {
    for solid in solids() {
        let surface = solid.surface(96, 0.0);
        let (center, radius) = solid.bounding_sphere().unwrap();
        // chords of 96 segments lie so much deeper than their arcs, in either direction
        let chord = 2.0 * radius * (1.0 - (PI / 96.0).cos());
        let [mut worst, mut far] = [0.0_f64; 2];
        let mut dice = fastrand::Rng::with_seed(2);
        for _ in 0..100 {
            let y = place(&mut dice, center, 1.4 * radius);
            let (distance, _) = solid.distance(y);
            let measured = to_triangles(y, &surface) * if winding(y, &surface) > 0.5 { -1.0 } else { 1.0 };
            if is_bevelled(&solid) {
                assert!(distance.abs() <= measured.abs() + chord, "{solid:?} at {y}: {distance}, not {measured}");
                far = far.max((distance - measured).abs());
            } else {
                worst = worst.max((distance - measured).abs());
            }
        }
        assert!(worst < 1.01 * chord, "{solid:?}: {worst} of {chord}");
        assert!(far < 0.3 * radius, "{solid:?}: {far}");
    }
}

#[test]
fn surfaces_are_closed_and_lie_where_the_distance_is_zero() {
    for solid in solids() {
        for segments in [0, 4, 7, 48] {
            let surface = solid.surface(segments, 0.0);
            assert_closed(&surface);
            assert!(volume(&surface) > 0.0);
            for &point in &surface.0 {
                let (distance, _) = solid.distance(point);
                assert!(distance.abs() < 1e-15, "{solid:?} at {point}: {distance}");
            }
        }
    }
    let (points, triangles) = Solid::new(Shape::Plane {}, 0.0).unwrap().surface(9, 0.5);
    assert_eq!((points[2], triangles.len()), (DVec3::new(0.5, 0.5, 0.0), 2));
}

#[test]
fn surfaces_hold_the_volume_of_the_shape() {
    for shape in shapes() {
        let expected = match shape {
            Shape::Plane {} => 0.0,
            Shape::Sphere { radius } => 4.0 / 3.0 * PI * radius.powi(3),
            Shape::Box { size } => size.element_product(),
            Shape::Capsule { length, radius } => PI * radius * radius * (length - 2.0 / 3.0 * radius),
            Shape::Cylinder { length, radius } => PI * radius * radius * length,
            Shape::Cone { length, tip, base } => PI / 3.0 * length * (tip * tip + tip * base + base * base),
            // the cut halves what is before its middle
            Shape::Tube { length, inner, outer, bevel } => {
                PI * (outer * outer - inner * inner) * (length - outer * bevel.to_radians().tan())
            }
        };
        let measured = volume(&Solid::new(shape.clone(), 0.0).unwrap().surface(400, 0.0));
        assert!((measured / expected - 1.0).abs() < 2e-4, "{shape:?}: {measured:e}, {expected:e}");
    }
}

#[test]
fn special_places_have_a_distance_and_a_direction() {
    for solid in solids() {
        let (points, _) = solid.surface(8, 0.0);
        let axis = [-1.0, -0.001, 0.0, 0.0002, 0.001, 0.002, 0.004, 0.0045, 0.006, 0.008, 0.009, 0.012, 1.0];
        let on_axis = axis.map(|z| DVec3::new(0.0, 0.0, z));
        let far = [1e-320, 1e-160, 1e9, 1e30, f64::MAX].map(DVec3::splat);
        let negative = far.map(|y| -y);
        for y in points.into_iter().chain(on_axis).chain(far).chain(negative) {
            for y in [y, y.with_x(0.0), y.with_y(-0.0), y.with_z(0.0), y / 2.0] {
                let (distance, gradient) = solid.distance(y);
                let is_sound = distance.is_finite() && (gradient.length() - 1.0).abs() < 1e-12;
                assert!(is_sound, "{solid:?} at {y}: {distance} {gradient}");
            }
        }
    }
    let at = |shape: Shape, y: [f64; 3]| Solid::new(shape, 0.0).unwrap().distance(DVec3::from_array(y));
    // the first in a fixed order
    assert_eq!(at(Shape::Sphere { radius: 1.0 }, [0.0; 3]), (-1.0, DVec3::X));
    assert_eq!(at(Shape::Box { size: DVec3::splat(2.0) }, [0.0; 3]), (-1.0, DVec3::X));
    assert_eq!(at(Shape::Box { size: DVec3::splat(2.0) }, [-0.5, 0.5, -0.5]), (-0.5, DVec3::NEG_X));
    assert_eq!(at(Shape::Cylinder { length: 2.0, radius: 1.0 }, [0.0, 0.0, 1.0]), (-1.0, DVec3::X));
    let tube = Shape::Tube { length: 9.0, inner: 1.0, outer: 3.0, bevel: 0.0 };
    assert_eq!(at(tube.clone(), [0.0, 2.0, 4.0]), (-1.0, DVec3::Y));
    assert_eq!(at(tube, [0.0, 0.0, 4.0]), (1.0, DVec3::NEG_X));
}

#[test]
fn balls_around_solids_hold_their_surfaces_and_touch_the_sharp_ones() {
    for solid in solids() {
        let (center, radius) = solid.bounding_sphere().unwrap();
        let (points, _) = solid.surface(64, 0.0);
        let farthest = points.into_iter().map(|point| point.distance(center)).fold(0.0, f64::max);
        assert!(farthest <= radius * (1.0 + 1e-12), "{solid:?}: {farthest}, {radius}");
        assert!(solid.rounding() > 0.0 || is_bevelled(&solid) || farthest > 0.999 * radius, "{solid:?}");
    }
    let plane = Solid::new(Shape::Plane {}, 0.0).unwrap();
    assert_eq!((plane.bounding_sphere(), plane.smallest_radius()), (None, None));
}

/// Discs, washers and short cones are as thin as they are long.
#[test]
fn the_smallest_radius_is_half_of_the_least_that_a_solid_measures() {
    let of = |shape: Shape| Solid::new(shape, 0.0).unwrap().smallest_radius();
    assert_eq!(of(Shape::Cylinder { length: 0.1, radius: 0.01 }), Some(0.01));
    assert_eq!(of(Shape::Cylinder { length: 0.001, radius: 0.01 }), Some(0.0005));
    assert_eq!(of(Shape::Tube { length: 0.1, inner: 0.01, outer: 0.02, bevel: 0.0 }), Some(0.005));
    assert_eq!(of(Shape::Tube { length: 0.004, inner: 0.01, outer: 0.02, bevel: 0.0 }), Some(0.002));
    assert_eq!(of(Shape::Cone { length: 0.1, tip: 0.01, base: 0.02 }), Some(0.01));
    assert_eq!(of(Shape::Cone { length: 0.001, tip: 0.01, base: 0.02 }), Some(0.0005));
}

#[test]
fn what_is_wrong_with_a_shape_is_told_by_field() {
    let told = |shape: Shape, rounding: f64| {
        let problem = shape.problem(rounding).map(|problem| (problem.field, problem.message));
        assert_eq!(Solid::new(shape, rounding).is_err(), problem.is_some());
        problem.unwrap_or(("", String::new()))
    };
    let tube = |inner, outer, bevel| Shape::Tube { length: 0.01, inner, outer, bevel };
    let cases = [
        (Shape::Sphere { radius: 0.0 }, 0.0, "radius", "`radius` must be between 1e-9 m and 1e6 m, found 0 m"),
        (Shape::Sphere { radius: f64::NAN }, 0.0, "radius", "found NaN m"),
        (Shape::Box { size: DVec3::new(1.0, -1.0, 1.0) }, 0.0, "size", "found -1 m"),
        (Shape::Capsule { length: 1.0, radius: 0.6 }, 0.0, "length", "at least twice `radius`, 1.2 m, found 1 m"),
        (Shape::Cone { length: 1.0, tip: 0.0, base: 0.0 }, 0.0, "base", "above 0 m where `tip` is 0 m, found 0 m"),
        (Shape::Cone { length: 1.0, tip: -0.1, base: 0.0 }, 0.0, "tip", "`tip` must be 0, or between"),
        (tube(0.003, 0.003, 0.0), 0.0, "outer", "`outer` must be more than `inner`, 0.003 m, found 0.003 m"),
        (tube(0.001, 0.003, -1.0), 0.0, "bevel", "`bevel` must be between 0° and 80°, found -1°"),
        (tube(0.001, 0.003, 80.0), 0.0, "length", "which the bevel takes away on one side, found 0.01 m"),
        (tube(0.002, 0.003, 0.0), 0.0005, "rounding", "must be less than 0.0005 m, the radius of the largest ball"),
        (Shape::Sphere { radius: 1.0 }, 1.0, "rounding", "found 1 m"),
        (Shape::Plane {}, f64::INFINITY, "rounding", "found inf m"),
        (Shape::Plane {}, -1.0, "rounding", "`rounding` must be between 0 m and 1e6 m, found -1 m"),
        // a ball of radius 1.5 tan 15° touches the base and the mantle of an equilateral cone: a third of its height
        (Shape::Cone { length: 3.0, tip: 0.0, base: 3f64.sqrt() }, 1.0, "rounding", "found 1 m"),
        (Shape::Cone { length: 3.0, tip: 0.0, base: 3f64.sqrt() }, 0.999, "", ""),
    ];
    for (shape, rounding, field, message) in cases {
        let found = told(shape.clone(), rounding);
        assert!(found.0 == field && found.1.contains(message), "{shape:?}: {found:?}");
    }
}

#[test]
fn shapes_are_read_as_scenes_write_them() {
    let read = |text: &str| ron::from_str::<Shape>(text);
    assert_eq!(read("Plane()").unwrap(), Shape::Plane {});
    assert_eq!(read("Box(size: (1.0, 2.0, 3.0))").unwrap(), Shape::Box { size: DVec3::new(1.0, 2.0, 3.0) });
    let tube = Shape::Tube { length: 0.1, inner: 0.001, outer: 0.002, bevel: 0.0 };
    assert_eq!(read("Tube(inner: 0.001, outer: 0.002, length: 0.1)").unwrap(), tube);
    assert!(read("Sphere(radius: 1.0, size: 2.0)").is_err());
}

#[test]
fn packed_numbers_are_those_of_the_smaller_shape() {
    let solid = Solid::new(Shape::Cylinder { length: 8.0, radius: 3.0 }, 0.5).unwrap();
    let [kind, sizes @ ..] = solid.packed();
    assert_eq!((kind.to_bits(), sizes), (4, [2.5, 0.5, 7.5, 0.0, 0.0, 0.0, 0.5]));
}
