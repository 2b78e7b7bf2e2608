//! What a file of fields holds.

use crate::mesh::Cells;
use glam::DVec3;

/// The mesh that bodies began with, of a run whose first frame lacks some of it already.
pub const WHOLE: &str = "whole_mesh.vtu";

/// The state of all bodies at one time, as slices of what the engine holds.
pub struct Frame<'a> {
    /// Time (s).
    pub time: f64,
    /// Rest positions (m), one row a point.
    pub points: &'a [DVec3],
    /// Cells by rows of `points`.
    pub cells: &'a Cells,
    /// One row a point.
    pub point_arrays: Vec<Array<'a>>,
    /// One row a cell.
    pub cell_arrays: Vec<Array<'a>>,
}

/// A surface at one time, a row a point in all but `triangles`.
pub struct SurfaceFrame<'a> {
    /// Time (s).
    pub time: f64,
    /// Where the points are (m).
    pub points: &'a [DVec3],
    /// Outward normals, of length 1.
    pub normals: &'a [DVec3],
    /// Texture coordinates (u, v), v upwards; nothing of surfaces without.
    pub texture: &'a [[f32; 2]],
    /// By rows of `points`.
    pub triangles: &'a [[u32; 3]],
}

/// A named array of a [`Frame`].
pub struct Array<'a> {
    /// What ParaView shows.
    pub name: &'a str,
    /// Values a row: 1, 3 (a vector) or 6 (a symmetric tensor: xx, yy, zz, xy, yz, xz).
    pub components: usize,
    /// The values, row by row.
    pub values: Values<'a>,
}

/// Values of an [`Array`], as many as rows times components.
#[derive(Clone, Copy)]
#[allow(missing_docs)]
pub enum Values<'a> {
    F32(&'a [f32]),
    F64(&'a [f64]),
    U8(&'a [u8]),
    U32(&'a [u32]),
    I64(&'a [i64]),
}
