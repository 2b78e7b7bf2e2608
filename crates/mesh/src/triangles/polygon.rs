//! Polygons of files become triangles.

use earcut::Earcut;
use glam::DVec3;
use std::collections::HashSet;

/// The most corners of a polygon that is no fan: which diagonals lie within it is tried one by one.
const MOST_CORNERS: usize = 1000;

/// What rounding may make of an area, as a share of the polygon's.
const ROUNDING: f64 = 1e-9;

/// By what share the areas of triangles may sum up to another than the polygon's.
const OFF: f64 = 1e-6;

/// What to do about a polygon that cannot be cut.
pub(super) const RULE: &str = "a polygon is flat, or nearly so, and its edges do not cross; triangles always do";

/// The triangles of a polygon, by the numbers of its corners (their places in m), turned as it is: a fan about its
/// first corner where that does not fold, as of convex polygons, else what `earcut` makes of it, seen along its normal.
/// All corners remain, those on straight edges too: neighbours may have them.
///
/// # Errors
/// What is wrong with a polygon that cannot be cut, as the end of a sentence on it.
pub(super) fn triangles(corners: &[DVec3]) -> Result<Vec<[usize; 3]>, String> {
    let fan: Vec<[usize; 3]> = (2..corners.len()).map(|corner| [0, corner - 1, corner]).collect();
    let normal = |[a, b, c]: [usize; 3]| (corners[b] - corners[a]).cross(corners[c] - corners[a]);
    let all: f64 = fan.iter().map(|&triangle| normal(triangle).length()).sum();
    let across = corners.iter().map(|corner| corner.distance_squared(corners[0])).fold(0.0, f64::max);
    // what is no more than a line has no area to lose; what is beyond numbers is told of with its points
    if fan.len() < 2 || !all.is_finite() || all <= ROUNDING * across {
        return Ok(fan);
    }
    let whole: DVec3 = fan.iter().map(|&triangle| normal(triangle)).sum();
    let crosses = || "crosses itself".to_string();
    let up = whole.try_normalize().filter(|_| whole.length() > ROUNDING * all).ok_or_else(crosses)?;
    if fan.iter().all(|&triangle| normal(triangle).dot(up) >= -ROUNDING * all) {
        return Ok(fan);
    }
    if corners.len() > MOST_CORNERS {
        return Err(format!("has {} corners and is not convex; {MOST_CORNERS} are allowed", corners.len()));
    }
    let right = up.any_orthonormal_vector();
    let on_plane = |corner: usize| {
        let place = corners[corner] - corners[0];
        [place.dot(right), place.dot(up.cross(right))]
    };
    // corners one after the other in one place are one
    let mut ring: Vec<usize> = (0..corners.len()).collect();
    ring.dedup_by_key(|corner| corners[*corner]);
    if ring.len() > 1 && corners[ring[0]] == corners[ring[ring.len() - 1]] {
        ring.pop();
    }
    let flat: Vec<[f64; 2]> = ring.iter().map(|&corner| on_plane(corner)).collect();
    let cut = cut(&flat, whole.length()).ok_or_else(crosses)?;
    Ok(cut.into_iter().map(|triangle| triangle.map(|corner| ring[corner])).collect())
}

/// The triangles of a polygon in a plane, counter-clockwise, of twice this area; `None` where it crosses itself.
fn cut(corners: &[[f64; 2]], area: f64) -> Option<Vec<[usize; 3]>> {
    let twice = |&[a, b, c]: &[usize; 3]| {
        let [[ax, ay], [bx, by], [cx, cy]] = [a, b, c].map(|corner| corners[corner]);
        (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    };
    let mut rows: Vec<usize> = Vec::new();
    Earcut::new().earcut(corners.iter().copied(), &[], &mut rows);
    let mut all: Vec<[usize; 3]> = rows.chunks_exact(3).map(|row| [row[0], row[1], row[2]]).collect();
    // all are turned the same way, whichever the polygon is
    if all.iter().map(twice).sum::<f64>() < 0.0 {
        all.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    let all = with_all_corners(all, corners.len())?;
    let sum: f64 = all.iter().map(|triangle| twice(triangle).abs()).sum();
    ((sum - area).abs() <= OFF * area).then_some(all)
}

/// Puts corners back that lie on straight edges and were left out: the triangle at such an edge is split. `None` where
/// not all come back.
fn with_all_corners(triangles: Vec<[usize; 3]>, corners: usize) -> Option<Vec<[usize; 3]>> {
    let edges = |[a, b, c]: [usize; 3]| [[a, b], [b, c], [c, a]];
    let mut inner: HashSet<[usize; 2]> = triangles.iter().flat_map(|&triangle| edges(triangle)).collect();
    let (mut open, mut all) = (triangles, Vec::new());
    while let Some(triangle) = open.pop() {
        let passes_corners = |&[from, to]: &[usize; 2]| (from + 1) % corners != to && !inner.contains(&[to, from]);
        let Some(side) = edges(triangle).iter().position(passes_corners) else {
            all.push(triangle);
            continue;
        };
        let [from, to, opposite] = [0, 1, 2].map(|corner| triangle[(side + corner) % 3]);
        let mut at = from;
        while at != to {
            let next = (at + 1) % corners;
            open.push([at, next, opposite]);
            inner.extend([[next, opposite], [opposite, next]]);
            at = next;
            // more than there can be
            if open.len() + all.len() > corners {
                return None;
            }
        }
    }
    (all.len() + 2 == corners).then_some(all)
}
