//! Parts of a surface that a grid of distances does not have: thinner than its cells, they lie between its points.

use super::closed::Closed;
use super::grid::DistanceGrid;
use super::tree::Tree;
use glam::DVec3;
use rayon::prelude::*;
use sinew_mesh::SurfaceError;

/// So deep (spacings) a grid is asked whether it has something there. Around a place farther from a surface than
/// √3/2 of them there is a point of the grid inside.
const DEPTHS: [f64; 5] = [0.125, 0.25, 0.5, 0.75, 1.0];

/// Edges that are blunted end no farther (spacings) beyond what the grid has, but where they are sharp.
const BLUNTED: f64 = 1.75;

/// What grows thicker by less than this part of the way along it is a thin part, not the end of a thick one: an
/// opening of 14°.
const TAPER: f64 = 0.25;

/// A ball that touches a surface may reach through it elsewhere by so much of its radius: round sides have edges.
const THROUGH: f64 = 0.1;

/// Halvings of a spacing until a radius is known.
const HALVINGS: usize = 12;

/// A part that is lost: of that place (m) which is farthest from what the grid has, how far (m), and the radius (m) of
/// the largest ball that fits there.
pub(super) struct Lost {
    at: DVec3,
    beyond: f64,
    radius: f64,
}

/// A place of the surface (m), and its normal.
type Place = (DVec3, DVec3);

impl Lost {
    /// What a grid has not of its surface, if that is more than the blunted edges that are to be expected. Places no
    /// more than a spacing apart are looked at one by one.
    ///
    /// # Errors
    /// That it has nothing of it.
    pub fn of(grid: &DistanceGrid, closed: &Closed, tree: &Tree) -> Result<Option<Self>, SurfaceError> {
        let count = closed.surface.triangles.len();
        let of_triangle = |triangle: usize| places(closed, triangle, grid.spacing());
        let with_fate = |place: Place| (place, is_kept(grid, tree, place));
        let all: Vec<(Place, bool)> = (0..count).into_par_iter().flat_map_iter(of_triangle).map(with_fate).collect();
        let [kept, lost] = [true, false].map(|fate| -> Vec<Place> {
            all.iter().filter(|(_, is_kept)| *is_kept == fate).map(|(place, _)| *place).collect()
        });
        if kept.is_empty() {
            return Err(SurfaceError::Lost { spacing: grid.spacing() });
        }
        let [to_kept, to_lost] = [&kept, &lost].map(|places| tree_of(places));
        let spacing = grid.spacing();
        let part = |&(at, normal): &Place| {
            let kept = to_kept.nearest(at, None, f64::INFINITY)?;
            let beyond = kept.square.sqrt();
            if beyond <= BLUNTED * spacing {
                return None;
            }
            // where it begins to be lost
            let root = to_lost.nearest(kept.at, None, f64::INFINITY)?;
            let [own, root] = [(at, normal), lost[to_lost.number(root)]].map(|place| radius(tree, place, spacing));
            let is_sharp = TAPER * (beyond - BLUNTED * spacing) <= 2.0 * (root - own);
            (!is_sharp).then_some((at, beyond, own.max(root)))
        };
        let parts: Vec<(DVec3, f64, f64)> = lost.par_iter().filter_map(part).collect();
        // the first of those that are as far
        let farthest = parts.into_iter().reduce(|best, next| if next.1 > best.1 { next } else { best });
        Ok(farthest.map(|(at, beyond, radius)| Self { at, beyond, radius }))
    }

    /// What the author of the surface should know; whether a grid can have a spacing is asked.
    pub fn note(&self, spacing: f64, is_possible: impl Fn(f64) -> bool) -> String {
        let &Self { at, beyond, radius } = self;
        let [x, y, z] = at.to_array().map(|part| format!("{part:.3e}"));
        let advice = if is_possible(radius) {
            format!("a `spacing` of {radius:.1e} m, the radius there, or less has it")
        } else {
            format!(
                "with a radius of {radius:.1e} m there it is too thin for a grid of all of the surface: make it thicker, \
                 or a tool of its own"
            )
        };
        format!(
            "a part that is thinner than the spacing of the grid, {spacing:.2e} m, is lost: at ({x}, {y}, {z}) m it \
             reaches {beyond:.1e} m beyond what the grid has; {advice}"
        )
    }
}

/// Places of a triangle in rows along its longest side, none farther than a spacing from the next.
fn places(closed: &Closed, triangle: usize, spacing: f64) -> impl Iterator<Item = Place> + use<> {
    let corners = closed.surface.corners(triangle);
    let normal = closed.normals[triangle][0];
    let length = |side: usize| corners[side].distance(corners[(side + 1) % 3]);
    let longest = (0..3).fold(0, |best, side| if length(side) > length(best) { side } else { best });
    let [a, b, c] = [0, 1, 2].map(|i| corners[(longest + i) % 3]);
    let height = (b - a).cross(c - a).length() / length(longest);
    let parts = move |size: f64| (size / spacing).ceil().max(1.0);
    // what has no area has no normal
    let rows = if normal == DVec3::ZERO { 0.0 } else { parts(height) };
    (0..rows as usize).flat_map(move |row| {
        // of one row the centroid's
        let up = (row as f64 + 1.0 / 3.0) / rows;
        let [from, to] = [a.lerp(c, up), b.lerp(c, up)];
        let count = parts(from.distance(to));
        (0..count as usize).map(move |i| (from.lerp(to, (i as f64 + 0.5) / count), normal))
    })
}

/// Whether the grid has something inside behind a place, and not behind another side of what is thin there.
fn is_kept(grid: &DistanceGrid, tree: &Tree, (at, normal): Place) -> bool {
    DEPTHS.iter().map(|depth| depth * grid.spacing()).any(|depth| {
        let inside = at - depth * normal;
        // as deep as it is behind the place, or near an edge
        let is_behind = |square: f64| square >= (0.5 * depth).powi(2);
        grid.distance(inside).0 < 0.0
            && tree.nearest(inside, None, f64::INFINITY).is_some_and(|nearest| is_behind(nearest.square))
    })
}

/// The radius (m) of the largest ball inside that touches the surface at a place, up to a spacing (m).
fn radius(tree: &Tree, (at, normal): Place, spacing: f64) -> f64 {
    let fits = |radius: f64| {
        let nearest = tree.nearest(at - radius * normal, None, f64::INFINITY);
        nearest.is_some_and(|nearest| nearest.square >= (radius * (1.0 - THROUGH)).powi(2))
    };
    let (mut less, mut more) = (0.0, spacing);
    for _ in 0..HALVINGS {
        let middle = (less + more) / 2.0;
        *(if fits(middle) { &mut less } else { &mut more }) = middle;
    }
    less
}

fn tree_of(places: &[Place]) -> Tree {
    Tree::new(|place| [places[place as usize].0; 3], (0..places.len() as u32).collect())
}
