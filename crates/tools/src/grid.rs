//! Closed surfaces of triangles as tools: signed distances on a grid. `shaders/tool_grid.wgsl` is the twin.

use super::closed::Closed;
use super::form::{FAR, NEAR};
use super::lost::Lost;
use super::mass::{self, Moments};
use super::tree::{SLACK, Tree};
use glam::{DMat3, DVec3, UVec3};
use rayon::prelude::*;
use sinew_mesh::{SurfaceError, Triangles};

/// Cells of the grid between it and the surface, on all sides.
const MARGIN: f64 = 2.0;

/// Cells along the longest side of a surface where nothing is said, at least: 64 points with the margin.
const USUAL_CELLS: usize = 59;

/// So many points a grid has at most where nothing is said and these cells do not ask for more.
const USUAL_NODES: f64 = 64.0 * 64.0 * 64.0;

/// Up to so many cells from the surface distances are exact, beyond nearly so; more than the diagonal of a cell.
const EXACT: f64 = 3.0;

/// Off its triangles by more than this part of its spacing, on average, a grid is too coarse.
const COARSE: f64 = 0.1;

/// By so much of a spacing a neighbour may be deeper of a point that is halfway between two sides: planes that are
/// tilted pass beside the points.
const DEEPER: f64 = 0.1;

/// The cosine between the directions to two sides from which on a place is between these, and not beside an edge.
const OPPOSITE: f64 = -0.8;

/// What grows deeper by more than this part of the way along it tapers to an edge: an opening of 14°.
const TAPER: f64 = 0.125;

/// Signed distances to a closed surface at the points of a grid, linear along each axis between them.
#[derive(Clone, Debug, PartialEq)]
pub struct DistanceGrid {
    /// The first point (m).
    origin: DVec3,
    /// Between points (m).
    spacing: f64,
    /// Points along x, y and z.
    counts: UVec3,
    /// Distances (m), along x first, then y.
    values: Vec<f32>,
    /// The bounds of the surface (m).
    bounds: [DVec3; 2],
    /// Of what the triangles enclose.
    moments: Moments,
    thinnest: f64,
    surface_error: f64,
    notes: Vec<String>,
}

impl DistanceGrid {
    /// The most points a grid may have: 256 along each axis, 64 MiB.
    pub const MOST_NODES: usize = 256 * 256 * 256;

    /// The spacing (m) by which the surface's longest side has as many whole cells as 64³ points allow, the margin
    /// among them, and 59 at least: that of a cube has 59, what is slender has finer cells at the same cost.
    pub fn usual_spacing(surface: &Triangles) -> f64 {
        let [low, high] = surface.bounds();
        let spacing = |cells: usize| (high - low).max_element() / cells as f64;
        let fits = |cells: usize| points(high - low, spacing(cells)).element_product() <= USUAL_NODES;
        // the points grow with the cells; a line of 64³ cells has more
        let (mut cells, mut more) = (USUAL_CELLS, USUAL_NODES as usize);
        while more - cells > 1 {
            let middle = cells.midpoint(more);
            *(if fits(middle) { &mut cells } else { &mut more }) = middle;
        }
        spacing(cells)
    }

    /// The distances to a surface on a grid of a spacing (m), which should be no more than a quarter of the smallest
    /// radius of the surface: between points they err by about spacing² / (8 radius), and by up to 0.2 % more farther
    /// than three spacings away. The same bits on any number of threads.
    ///
    /// # Errors
    /// When the surface is not closed, crosses itself or has no volume, when the grid would have more points than
    /// [`Self::MOST_NODES`], and when it is so coarse that it has nothing of the surface.
    pub fn new(surface: &Triangles, spacing: f64) -> Result<Self, SurfaceError> {
        let closed = Closed::new(surface)?;
        let bounds = closed.surface.bounds();
        let (origin, counts) = frame(bounds, spacing)?;
        let triangles =
            (0..closed.surface.triangles.len() as u32).filter(|&t| closed.normals[t as usize][0] != DVec3::ZERO);
        let tree = Tree::new(|triangle| closed.surface.corners(triangle as usize), triangles.collect());
        let mut values = vec![0.0f32; counts.x as usize * counts.y as usize * counts.z as usize];
        values.par_chunks_mut(counts.x as usize).enumerate().for_each(|(row, values)| {
            let (j, k) = (row % counts.y as usize, row / counts.y as usize);
            let (mut near, mut sign) = (None, 1.0);
            for (i, value) in values.iter_mut().enumerate() {
                let y = origin + spacing * DVec3::new(i as f64, j as f64, k as f64);
                near = tree.nearest(y, near, EXACT * spacing);
                let Some(nearest) = near else { continue };
                let distance = nearest.square.sqrt();
                // far away no surface lies between two points of the grid
                if distance <= EXACT * spacing {
                    let normal = closed.normals[tree.number(nearest)][nearest.part];
                    sign = 1f64.copysign(normal.dot(y - nearest.at));
                }
                *value = (sign * distance) as f32;
            }
        });
        let moments = mass::enclosed(&closed.surface);
        let (thinnest, surface_error, notes) = (0.0, 0.0, Vec::new());
        let mut grid = Self { origin, spacing, counts, values, bounds, moments, thinnest, surface_error, notes };
        grid.check()?;
        grid.thinnest = grid.halfway().max(0.5 * spacing).min(grid.depth());
        let (farthest, mean) = grid.off(&closed.surface);
        grid.surface_error = farthest;
        let lost = Lost::of(&grid, &closed, &tree)?;
        grid.check_volume(&closed.surface)?;
        grid.notes = closed.notes;
        if mean > COARSE * spacing {
            grid.notes.push(format!(
                "the grid's surface is {mean:.2e} m off the triangles on average, {:.0} % of its spacing, {spacing} m: \
                 radii below four spacings are blunt, and what is thinner than one is lost",
                100.0 * mean / spacing
            ));
        }
        let is_possible = |finer| frame(bounds, finer).is_ok();
        grid.notes.extend(lost.map(|lost| lost.note(spacing, is_possible)));
        Ok(grid)
    }

    /// That no two neighbours differ by more than the way between them, and that all is outside at the border.
    fn check(&self) -> Result<(), SurfaceError> {
        let [nx, ny, nz] = self.counts.to_array().map(|count| count as usize);
        let [low, high] = self.bounds;
        let most = 1.001 * self.spacing + 1e-6 * low.abs().max(high.abs()).max_element();
        let wrong_in_row = |row: usize| {
            let (j, k) = (row % ny, row / ny);
            let at = |i: usize, j: usize, k: usize| f64::from(self.values[i + nx * (j + ny * k)]);
            let is_wrong = move |i: &usize| {
                let value = at(*i, j, k);
                let is_jump = |next: f64| (next - value).abs() > most + 2.0 * SLACK * value.abs();
                let is_last = [*i + 1 == nx, j + 1 == ny, k + 1 == nz];
                let at_border = is_last.contains(&true) || [*i, j, k].contains(&0);
                (at_border && value < 0.0)
                    || (!is_last[0] && is_jump(at(i + 1, j, k)))
                    || (!is_last[1] && is_jump(at(*i, j + 1, k)))
                    || (!is_last[2] && is_jump(at(*i, j, k + 1)))
            };
            (0..nx).filter(is_wrong).map(move |i| DVec3::new(i as f64, j as f64, k as f64))
        };
        let wrong: Vec<DVec3> = (0..ny * nz).into_par_iter().flat_map_iter(wrong_in_row).collect();
        match wrong.first() {
            Some(&first) => Err(SurfaceError::Crosses { at: self.origin + self.spacing * first, count: wrong.len() }),
            None => Ok(()),
        }
    }

    /// That it has as much inside as the triangles enclose, but for what may be lost at a surface: half a spacing on
    /// either side.
    fn check_volume(&self, surface: &Triangles) -> Result<(), SurfaceError> {
        let area_of = |triangle: usize| {
            let [a, b, c] = surface.corners(triangle);
            (b - a).cross(c - a).length() / 2.0
        };
        let area: f64 = (0..surface.triangles.len()).map(area_of).sum();
        let share = |value: &f32| (0.5 - f64::from(*value) / self.spacing).clamp(0.0, 1.0);
        let inside = self.values.iter().map(share).sum::<f64>() * self.spacing.powi(3);
        let enclosed = self.moments.0;
        if (enclosed - inside).abs() > area * self.spacing {
            return Err(SurfaceError::Twice { enclosed, inside });
        }
        Ok(())
    }

    /// How deep the shallowest point is (m) that lies halfway between two sides: none of its neighbours is deeper, the
    /// surface is the other way on either side of it, and it is as deep farther away from both. Infinite where there is
    /// none.
    fn halfway(&self) -> f64 {
        let [nx, ny, nz] = self.counts.to_array().map(|count| count as usize);
        let (ways, spacing) = ([1, nx, nx * ny], self.spacing);
        let at = |row: usize| f64::from(self.values[row]);
        let normal = |row: usize| DVec3::from_array(ways.map(|way| at(row + way) - at(row - way))).normalize_or_zero();
        let is_even = |row: usize, outwards: DVec3| {
            let [i, j, k] = [row % nx, row / nx % ny, row / (nx * ny)].map(|count| count as f64);
            let mut y = self.origin + spacing * (DVec3::new(i, j, k) - 2.0 * outwards.normalize_or_zero());
            // and farther from what is nearest there
            (0..4).all(|_| {
                let (distance, gradient) = self.within(y);
                y -= spacing * gradient;
                distance >= at(row) - 2.0 * TAPER * spacing
            })
        };
        let is_halfway = |row: usize| {
            let least = at(row) - DEEPER * spacing;
            at(row) < 0.0
                && ways.into_iter().all(|way| at(row - way) >= least && at(row + way) >= least)
                && ways.into_iter().any(|way| {
                    let [one, other] = [normal(row - 2 * way), normal(row + 2 * way)];
                    one.dot(other) < OPPOSITE && is_even(row, one + other)
                })
        };
        // what is inside is three points from the border at least
        let inner = |count: usize| 3..count.saturating_sub(3);
        let of_line = |line: usize| {
            let is_inner = inner(ny).contains(&(line % ny)) && inner(nz).contains(&(line / ny));
            let rows = inner(if is_inner { nx } else { 0 }).map(|i| i + nx * line);
            rows.filter(|&row| is_halfway(row)).map(|row| -at(row)).fold(f64::INFINITY, f64::min)
        };
        (0..ny * nz).into_par_iter().map(of_line).reduce(|| f64::INFINITY, f64::min)
    }

    /// The largest distance (m) at corners and middles of triangles, where there should be none, and the mean of those
    /// at middles, weighted with areas.
    fn off(&self, surface: &Triangles) -> (f64, f64) {
        let of_triangle = |triangle: usize| {
            let [a, b, c] = surface.corners(triangle);
            let [at_a, at_b, at_c, middle] = [a, b, c, (a + b + c) / 3.0].map(|place| self.distance(place).0.abs());
            (at_a.max(at_b).max(at_c).max(middle), middle, (b - a).cross(c - a).length())
        };
        // added up in one order
        let all: Vec<(f64, f64, f64)> = (0..surface.triangles.len()).into_par_iter().map(of_triangle).collect();
        let [farthest, sum, area] = all.iter().fold([0.0_f64; 3], |[farthest, sum, area], &(most, middle, own)| {
            [farthest.max(most), sum + own * middle, area + own]
        });
        (farthest, sum / area)
    }

    /// φ, the signed distance (m) from a place in the tool's frame to the surface, negative inside, and the direction
    /// of its gradient, a unit vector. Outside the grid it is the distance to where the surface is nearest to the
    /// nearest place of the grid: no less than it is, and never inside.
    #[inline]
    pub fn distance(&self, y: DVec3) -> (f64, DVec3) {
        let y = y.clamp(DVec3::splat(-FAR), DVec3::splat(FAR));
        let cells = (self.counts - 1).as_dvec3();
        let inside = y.clamp(self.origin, self.origin + self.spacing * cells);
        let (distance, gradient) = self.within(inside);
        if inside == y {
            return (distance, gradient);
        }
        let way = y - (inside - distance * gradient);
        let length = way.length();
        (length, if length > NEAR { way / length } else { gradient })
    }

    /// The same for a place in the grid.
    fn within(&self, y: DVec3) -> (f64, DVec3) {
        let place = (y - self.origin) / self.spacing;
        let last = (self.counts - 2).as_dvec3();
        let cell = place.floor().clamp(DVec3::ZERO, last);
        let t = place - cell;
        let [i, j, k] = cell.to_array().map(|cell| cell as usize);
        let [nx, ny] = [self.counts.x as usize, self.counts.y as usize];
        let first = i + nx * (j + ny * k);
        let value = |row: usize| f64::from(self.values[row]);
        let along_x = |row: usize| {
            let (a, b) = (value(row), value(row + 1));
            [a + t.x * (b - a), b - a]
        };
        let along_y = |row: usize| {
            let ([a, a_x], [b, b_x]) = (along_x(row), along_x(row + nx));
            [a + t.y * (b - a), a_x + t.y * (b_x - a_x), b - a]
        };
        let ([a, a_x, a_y], [b, b_x, b_y]) = (along_y(first), along_y(first + nx * ny));
        let slope = DVec3::new(a_x + t.z * (b_x - a_x), a_y + t.z * (b_y - a_y), b - a);
        let length = slope.length();
        // where sides are as near there may be none
        let gradient = if length > 1e-6 * self.spacing { slope / length } else { DVec3::X };
        (a + t.z * (b - a), gradient)
    }

    /// As the WGSL struct `ToolGrid` has it: the first point (m), the spacing (m), the points along x, y and z as the
    /// bits of `u32`, and so the row of its first value in the buffer.
    pub fn packed(&self, first: u32) -> [f32; 8] {
        let [x, y, z] = self.origin.as_vec3().to_array();
        let [nx, ny, nz] = self.counts.to_array().map(f32::from_bits);
        [x, y, z, self.spacing as f32, nx, ny, nz, f32::from_bits(first)]
    }

    /// The distances (m) at its points, along x first, then y.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The first point (m).
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Between points (m).
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Points along x, y and z.
    pub fn counts(&self) -> UVec3 {
        self.counts
    }

    /// Centre and radius (m) of a ball around the surface.
    pub fn bounding_sphere(&self) -> (DVec3, f64) {
        let [low, high] = self.bounds;
        ((low + high) / 2.0, low.distance(high) / 2.0)
    }

    /// Volume (m³), centre (m) and, for a density of one, moments of inertia about it (m⁵) of what the triangles
    /// enclose, hollows left out: to rounding, whatever the grid is.
    pub(super) fn volume_moments(&self) -> (f64, DVec3, DMat3) {
        self.moments
    }

    /// Half of its thickness where it is thinnest (m), to about a spacing: half of a spacing at least, and no more than
    /// [`Self::depth`]. What tapers to an edge, by more than 14°, counts as it is where it ends to grow.
    pub fn thinnest(&self) -> f64 {
        self.thinnest
    }

    /// How deep inside its deepest point is (m): half of the thickness where it is thickest.
    pub fn depth(&self) -> f64 {
        -f64::from(self.values.iter().copied().fold(0.0, f32::min))
    }

    /// How far off the triangles the grid's own surface is at most (m), at their corners and middles.
    pub fn surface_error(&self) -> f64 {
        self.surface_error
    }

    /// What the author of the surface should know, one sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }
}

/// How many points there are along each axis for a size (m).
fn points(size: DVec3, spacing: f64) -> DVec3 {
    (size / spacing).ceil() + 1.0 + 2.0 * MARGIN
}

/// The first point, and how many there are along each axis.
fn frame([low, high]: [DVec3; 2], spacing: f64) -> Result<(DVec3, UVec3), SurfaceError> {
    let points = |spacing: f64| points(high - low, spacing);
    let nodes = |spacing: f64| points(spacing).element_product();
    let most = DistanceGrid::MOST_NODES;
    // also where it is no number
    if !(spacing > 0.0 && nodes(spacing) <= most as f64) || spacing.is_infinite() {
        // the product falls with the spacing
        let (mut less, mut more) = (0.0, (high - low).max_element());
        for _ in 0..60 {
            let middle = (less + more) / 2.0;
            *(if nodes(middle) <= most as f64 { &mut more } else { &mut less }) = middle;
        }
        // two digits, rounded up
        let unit = 10f64.powf(more.log10().floor() - 1.0);
        return Err(SurfaceError::Spacing { spacing, nodes: nodes(spacing), most, least: (more / unit).ceil() * unit });
    }
    let counts = points(spacing);
    Ok(((low + high) / 2.0 - spacing / 2.0 * (counts - 1.0), counts.as_uvec3()))
}
