//! A tool as kernels see it.

use crate::backend::kernel::uniform;
use crate::components::ToolContact;
use crate::tools::Geometry;

/// A tool at a body, as kernels see it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct ToolRow {
    kind: u32,
    size_0: f32,
    size_1: f32,
    size_2: f32,
    size_3: f32,
    size_4: f32,
    size_5: f32,
    rounding: f32,
    signal: u32,
    sticking: f32,
    sliding: f32,
    spacing: f32,
    nx: u32,
    ny: u32,
    nz: u32,
    first: u32,
    share: f32,
    damping: f32,
    swept: f32,
    room: u32,
}
uniform!(ToolRow {
    kind,
    size_0,
    size_1,
    size_2,
    size_3,
    size_4,
    size_5,
    rounding,
    signal,
    sticking,
    sliding,
    spacing,
    nx,
    ny,
    nz,
    first,
    share,
    damping,
    swept,
    room
});

/// The kind of what is known by a grid of distances.
const GRID: u32 = u32::MAX;

/// As it is in a uniform. `first`: where the values of its grid begin, if it has one.
pub(super) fn row_of(contact: &ToolContact, first: u32) -> ToolRow {
    let (kind, sizes, rounding, grid) = match &contact.geometry {
        Geometry::Analytic(solid) => {
            let [kind, sizes @ .., rounding] = solid.packed();
            (kind.to_bits(), sizes, rounding, [0.0; 5])
        }
        Geometry::Grid(grid) => {
            let [x, y, z, grid @ ..] = grid.packed(first);
            (GRID, [x, y, z, 0.0, 0.0, 0.0], 0.0, grid)
        }
    };
    let [size_0, size_1, size_2, size_3, size_4, size_5] = sizes;
    let [spacing, nx, ny, nz, first] = grid;
    let [nx, ny, nz, first] = [nx, ny, nz, first].map(f32::to_bits);
    let [sticking, sliding] = contact.friction.map(|number| number as f32);
    let signal = contact.signal as u32;
    let [share, damping] = contact.spring.map_or([0.0; 2], |of| [of.share as f32, of.damping as f32]);
    ToolRow {
        kind,
        size_0,
        size_1,
        size_2,
        size_3,
        size_4,
        size_5,
        rounding,
        signal,
        sticking,
        sliding,
        spacing,
        nx,
        ny,
        nz,
        first,
        share,
        damping,
        swept: contact.swept.min(f64::from(f32::MAX)) as f32,
        // rows are whole vectors
        room: 0,
    }
}
