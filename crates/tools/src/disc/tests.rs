use super::share_in_disc;
use glam::{DVec2, dvec2};
use std::f64::consts::PI;

/// By places on a grid that are within both.
fn counted(corners: &[DVec2], radius: f64) -> f64 {
    let (mut within, mut both) = (0.0, 0.0);
    let (low, high) = corners.iter().fold((corners[0], corners[0]), |(low, high), &x| (low.min(x), high.max(x)));
    let count = 1000;
    for i in 0..count {
        for j in 0..count {
            let at = low + (high - low) * (dvec2(f64::from(i), f64::from(j)) + 0.5) / f64::from(count);
            let sides = corners.iter().zip(corners.iter().cycle().skip(1));
            // by the even-odd rule: whatever its shape
            let crossed = sides
                .filter(|(p, q)| (p.y > at.y) != (q.y > at.y) && at.x < p.x + (at.y - p.y) * (q.x - p.x) / (q.y - p.y));
            if crossed.count() % 2 == 1 {
                within += 1.0;
                both += f64::from(u8::from(at.length() <= radius));
            }
        }
    }
    both / within
}

#[test]
fn shares_are_those_of_fine_grids() {
    let triangle = [dvec2(-0.7, -0.4), dvec2(1.1, -0.2), dvec2(0.2, 0.9)];
    let arrow = [dvec2(-1.0, -1.0), dvec2(1.2, -0.1), dvec2(-0.9, 0.8), dvec2(-0.2, -0.1)];
    let square = [dvec2(-0.5, -0.5), dvec2(0.5, -0.5), dvec2(0.5, 0.5), dvec2(-0.5, 0.5)];
    for corners in [&triangle[..], &arrow, &square] {
        for shift in [dvec2(0.0, 0.0), dvec2(0.3, -0.2), dvec2(-0.6, 0.5), dvec2(2.0, 0.1)] {
            let corners: Vec<DVec2> = corners.iter().map(|corner| *corner + shift).collect();
            for radius in [0.05, 0.3, 0.6, 1.0, 3.0] {
                let (found, expected) = (share_in_disc(&corners, radius), counted(&corners, radius));
                assert!((found - expected).abs() < 2e-3, "{corners:?}, {radius}: {found}, counted {expected}");
            }
        }
    }
}

/// Whatever they are cut into, faces have together what is in the disc.
#[test]
fn faces_of_any_size_close_the_whole_disc() {
    for count in 1..40 {
        let side = 2.4 / f64::from(count);
        let mut sum = 0.0;
        for i in 0..count {
            for j in 0..count {
                let low = dvec2(-1.3, -1.1) + side * dvec2(f64::from(i), f64::from(j));
                let [right, up] = [DVec2::X * side, DVec2::Y * side];
                for corners in [[low, low + right, low + right + up], [low, low + right + up, low + up]] {
                    sum += share_in_disc(&corners, 1.0) * 0.5 * side * side;
                }
            }
        }
        assert!((sum / PI - 1.0).abs() < 1e-13, "{count} across: {sum}");
    }
}

#[test]
fn what_lies_on_the_edge_or_is_turned_away_is_right_too() {
    let square = [dvec2(0.0, 0.0), dvec2(1.0, 0.0), dvec2(1.0, 1.0), dvec2(0.0, 1.0)];
    // a corner at the middle, sides through it, corners on the edge
    assert!((share_in_disc(&square, 1.0) - PI / 4.0).abs() < 1e-15);
    assert_eq!(share_in_disc(&square, 2.0_f64.sqrt() * (1.0 + 1e-15)), 1.0);
    let turned = [square[3], square[2], square[1], square[0]];
    assert_eq!(share_in_disc(&turned, 1.0), 0.0);
    assert_eq!(share_in_disc(&turned, 10.0), 0.0);
    assert_eq!(share_in_disc(&square.map(|x| x + 5.0), 1.0), 0.0);
    assert_eq!(share_in_disc(&[DVec2::ZERO; 3], 1.0), 0.0);
    assert_eq!(share_in_disc(&square.map(|x| x * f64::NAN), 1.0), 0.0);
    // a side that only touches
    let beside = square.map(|x| x + dvec2(1.0, -0.5));
    assert!(share_in_disc(&beside, 1.0) < 1e-15);
    // a triangle that repeats its last corner
    let [a, b, c, _] = square;
    assert_eq!(share_in_disc(&[a, b, c, c], 1.0), share_in_disc(&[a, b, c], 1.0));
}
