//! Surfaces of triangles as files hold them.

#[cfg(not(feature = "files"))]
mod absent;
#[cfg(feature = "files")]
mod gltf;
#[cfg(feature = "files")]
mod obj;
#[cfg(feature = "files")]
mod ply;
#[cfg(feature = "files")]
mod polygon;
#[cfg(feature = "files")]
mod read;

use glam::DVec3;
use std::collections::HashMap;

/// The largest coordinate of a point (m).
const MOST_PLACE: f64 = 1e6;

/// How many places a message names.
const NAMED: usize = 4;

/// A surface of triangles: no solid yet, whatever it may be.
#[derive(Clone, Debug, Default, PartialEq)]
#[doc(hidden)]
pub struct Triangles {
    /// Points (m).
    pub points: Vec<DVec3>,
    /// Rows of `points`, so that the right-hand normal points outwards.
    pub triangles: Vec<[u32; 3]>,
    /// Texture coordinates (u, v) at the corners of each triangle, v upwards; nothing of surfaces without.
    pub texture: Vec<[[f32; 2]; 3]>,
}

/// Why triangles are no tool.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[doc(hidden)]
pub enum SurfaceError {
    /// There are none.
    #[error("the surface has no triangles")]
    Empty,
    /// A corner is no point.
    #[error("triangle {triangle} names point {point}; there are {points} (all counted from 0)")]
    Row {
        /// The triangle.
        triangle: usize,
        /// The point that it names.
        point: u32,
        /// How many there are.
        points: usize,
    },
    /// A point lies nowhere, or too far off.
    #[error(
        "point {point} is at {at}; coordinates must be numbers of at most {MOST_PLACE:e} m (points counted from 0)"
    )]
    Place {
        /// The point.
        point: usize,
        /// Where it is (m).
        at: DVec3,
    },
    /// Edges that do not join two triangles of the same orientation.
    #[error("the surface of a tool must be closed, and this one is not:{}", list(.0))]
    Edges(
        /// One for each kind of fault.
        Vec<EdgeFault>,
    ),
    /// All of it lies in a plane.
    #[error("the surface has no volume")]
    Flat,
    /// A grid of its distances has nothing of it.
    #[error(
        "all of it is thinner than the spacing of the grid, {spacing:.2e} m: there is nothing inside. Take a finer \
         `spacing`"
    )]
    Lost {
        /// Between points of the grid (m).
        spacing: f64,
    },
    /// It crosses itself, or a part of it is inside out.
    #[error(
        "the surface crosses itself or is inside out in part: at {count} places of the grid inside and outside meet \
         with no surface between them, first at {}; let it be the boundary of one solid", place(*.at)
    )]
    Crosses {
        /// The first place (m).
        at: DVec3,
        /// How many pairs of grid points.
        count: usize,
    },
    /// A part of it lies in another and is turned outwards as that is.
    #[error(
        "the surface encloses {enclosed:.3e} m³, and {inside:.3e} m³ are inside: a part of it lies close beneath \
         another, and is turned outwards, too; let it be the boundary of one solid, hollows turned inwards"
    )]
    Twice {
        /// The volume that its triangles enclose, what is enclosed twice counted so (m³).
        enclosed: f64,
        /// What of the grid is inside (m³).
        inside: f64,
    },
    /// The grid would be too large, or there is no spacing.
    #[error("a grid of spacing {spacing} m would have {nodes:e} points; allowed are {most}, here from {least} m on")]
    Spacing {
        /// What was asked for (m).
        spacing: f64,
        /// The points that it would have.
        nodes: f64,
        /// How many may be.
        most: usize,
        /// The smallest spacing that this surface may have (m).
        least: f64,
    },
}

/// Edges with one and the same fault.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct EdgeFault {
    /// What is wrong with them.
    pub what: &'static str,
    /// How many.
    pub count: usize,
    /// The ends of the first few (m).
    pub first: Vec<[DVec3; 2]>,
}

fn list(faults: &[EdgeFault]) -> String {
    let one = |fault: &EdgeFault| {
        let edges: Vec<String> = fault.first.iter().map(|[a, b]| format!("{} to {}", place(*a), place(*b))).collect();
        let more = if fault.count > edges.len() { ", ..." } else { "" };
        format!("\n  {} {}: {}{more}", fault.count, fault.what, edges.join(", "))
    };
    faults.iter().map(one).collect()
}

fn place(at: DVec3) -> String {
    format!("({}, {}, {}) m", at.x, at.y, at.z)
}

impl Triangles {
    /// Makes points of equal coordinates one, and leaves out those of no triangle.
    pub fn merge_points(&mut self) {
        let mut rows = HashMap::new();
        let mut points = Vec::new();
        for corner in self.triangles.iter_mut().flatten() {
            let Some(&point) = self.points.get(*corner as usize) else { continue };
            // zero has two signs
            let bits = (point + DVec3::ZERO).to_array().map(f64::to_bits);
            *corner = *rows.entry(bits).or_insert_with(|| {
                points.push(point);
                (points.len() - 1) as u32
            });
        }
        self.points = points;
    }

    /// The least and the largest coordinates (m); of no points, zero.
    pub fn bounds(&self) -> [DVec3; 2] {
        let Some(&first) = self.points.first() else { return [DVec3::ZERO; 2] };
        self.points.iter().fold([first; 2], |[low, high], &point| [low.min(point), high.max(point)])
    }

    /// The corners of a triangle (m). Panics on a row that is not there.
    #[doc(hidden)]
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|row| self.points[row as usize])
    }

    /// Volume within (m³), by the divergence theorem about a place near by.
    #[doc(hidden)]
    pub fn volume(&self) -> f64 {
        let center = self.bounds()[0];
        let sixfold = |triangle| {
            let [a, b, c] = self.corners(triangle).map(|corner| corner - center);
            a.dot(b.cross(c))
        };
        (0..self.triangles.len()).map(sixfold).sum::<f64>() / 6.0
    }

    /// That rows and places are such as can be reckoned with.
    #[doc(hidden)]
    pub fn check_numbers(&self) -> Result<(), SurfaceError> {
        let points = self.points.len();
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if let Some(&point) = corners.iter().find(|&&row| row as usize >= points) {
                return Err(SurfaceError::Row { triangle, point, points });
            }
        }
        let fits = |at: &DVec3| at.abs().cmple(DVec3::splat(MOST_PLACE)).all();
        match self.points.iter().position(|at| !fits(at)) {
            Some(point) => Err(SurfaceError::Place { point, at: self.points[point] }),
            None => Ok(()),
        }
    }

    /// Which triangle passes an edge in this direction; or what is wrong with edges.
    #[doc(hidden)]
    pub fn edges(&self) -> Result<HashMap<[u32; 2], u32>, SurfaceError> {
        let mut sides: Vec<([u32; 2], bool, u32)> = Vec::with_capacity(3 * self.triangles.len());
        for (triangle, &[a, b, c]) in (0..).zip(&self.triangles) {
            let side = |[p, q]: [u32; 2]| ([p.min(q), p.max(q)], p < q, triangle);
            sides.extend([[a, b], [b, c], [c, a]].map(side));
        }
        sides.sort_unstable();
        let mut faults = [
            "edges belong to one triangle only",
            "edges belong to more than two triangles",
            "edges belong to two triangles of opposite orientation",
        ]
        .map(|what| EdgeFault { what, count: 0, first: Vec::new() });
        for same in sides.chunk_by(|one, next| one.0 == next.0) {
            let kind = match same {
                [_] => 0,
                [one, other] if one.1 != other.1 => continue,
                [_, _] => 2,
                _ => 1,
            };
            faults[kind].count += 1;
            if faults[kind].first.len() < NAMED {
                faults[kind].first.push(same[0].0.map(|row| self.points[row as usize]));
            }
        }
        let faults: Vec<EdgeFault> = faults.into_iter().filter(|fault| fault.count > 0).collect();
        if !faults.is_empty() {
            return Err(SurfaceError::Edges(faults));
        }
        let directed = sides.into_iter().map(|([low, high], ascends, triangle)| {
            let edge = if ascends { [low, high] } else { [high, low] };
            (edge, triangle)
        });
        Ok(directed.collect())
    }
}
