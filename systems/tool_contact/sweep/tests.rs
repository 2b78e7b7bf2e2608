#![allow(clippy::unwrap_used)]

use super::*;
use crate::tools::{Shape, Solid};

fn needle() -> Geometry {
    Geometry::Analytic(Solid::new(Shape::Capsule { length: 1.0, radius: 0.1 }, 0.0).unwrap())
}

/// Ways across a needle, beside its middle by some part of its radius.
#[test]
fn a_way_meets_a_tool_where_it_first_comes_to_its_surface() {
    for beside in [0.0, 0.05, 0.09, 0.0999] {
        for long in [0.3, 1.0, 40.0] {
            let ends = [DVec3::new(-0.15, beside, 0.5), DVec3::new(-0.15 + long, beside, 0.5)];
            let (normal, place) = first_touch(&needle(), 0.05, ends).unwrap();
            let x = -(0.1_f64 * 0.1 - beside * beside).sqrt();
            // it stops within a thousandth of what it may go unseen, and nearly along the surface farther off
            assert!((place - DVec3::new(x, beside, 0.5)).length() < 2e-3, "{beside}, {long}: {place}");
            assert!((normal - DVec3::new(x, beside, 0.0) / 0.1).length() < 2e-2, "{beside}, {long}: {normal}");
            assert!((ends[0] - place).dot(normal) > 0.0 && (ends[1] - place).dot(normal) < 0.0);
        }
    }
}

#[test]
fn ways_that_are_free_or_short_meet_nothing() {
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.5);
    let meets = |from, to| first_touch(&needle(), 0.05, [from, to]).is_some();
    assert!(!meets(at(-0.15, 0.101), at(1.0, 0.101)), "beside it");
    assert!(!meets(at(-0.15, 0.0), at(-0.1001, 0.0)), "before it");
    assert!(!meets(at(-0.12, 0.0), at(-0.08, 0.0)), "short");
    assert!(!meets(at(f64::NAN, 0.0), at(0.5, 0.0)) && !meets(at(-0.15, 0.0), at(f64::NAN, 0.0)));
    // who lies on the surface but for rounding is not inside
    assert!(meets(at(-0.1 + 1e-9, 0.0), at(0.5, 0.0)));
    assert!(first_touch(&needle(), 0.0, [at(-0.15, 0.0), at(1.0, 0.0)]).is_none(), "not asked for");
}

#[test]
fn a_way_that_begins_inside_comes_out_where_it_began() {
    let ends = [DVec3::new(-0.06, 0.0, 0.5), DVec3::new(0.5, 0.0, 0.5)];
    let (normal, place) = first_touch(&needle(), 0.05, ends).unwrap();
    assert!((place - DVec3::new(-0.1, 0.0, 0.5)).length() < 1e-12 && normal == -DVec3::X, "{place}, {normal}");
}
