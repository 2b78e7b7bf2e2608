// Signed distances on grids, linear along each axis between points; twin of crates/tools/src/grid.rs.
struct ToolGrid {
    x: f32, // the first point (m)
    y: f32,
    z: f32,
    spacing: f32, // m
    nx: u32, // points along each axis
    ny: u32,
    nz: u32,
    first: u32, // the row of its first value
}

// distances (m) of all grids, along x first, then y
@group(0) @binding(0) var<storage, read> tool_grid_values: array<f32>;

// Beyond one and below the other (m) squares are no numbers.
const GRID_FAR: f32 = 1e15;
const GRID_NEAR: f32 = 1e-18;

// Distance (m) and slope along x (times the spacing).
fn grid_along_x(row: u32, t: f32) -> vec2<f32> {
    let slope = tool_grid_values[row + 1u] - tool_grid_values[row];
    return vec2<f32>(tool_grid_values[row] + t * slope, slope);
}

// The same, and the slope along y.
fn grid_along_y(row: u32, nx: u32, t: vec2<f32>) -> vec3<f32> {
    let a = grid_along_x(row, t.x);
    let b = grid_along_x(row + nx, t.x);
    return vec3<f32>(a + t.y * (b - a), b.x - a.x);
}

// The unit gradient, and in w the distance (m), at a place in the grid.
fn tool_grid_within(grid: ToolGrid, y: vec3<f32>) -> vec4<f32> {
    let place = (y - vec3<f32>(grid.x, grid.y, grid.z)) / grid.spacing;
    let last = vec3<f32>(vec3<u32>(grid.nx, grid.ny, grid.nz) - vec3<u32>(2u));
    let cell = clamp(floor(place), vec3<f32>(0.0), last);
    let t = place - cell;
    let i = vec3<u32>(cell);
    let row = grid.first + i.x + grid.nx * (i.y + grid.ny * i.z);
    let a = grid_along_y(row, grid.nx, t.xy);
    let b = grid_along_y(row + grid.nx * grid.ny, grid.nx, t.xy);
    let found = a + t.z * (b - a);
    let slope = vec3<f32>(found.yz, b.x - a.x);
    let size = length(slope);
    // where sides are as near there may be none
    if size > 1e-6 * grid.spacing {
        return vec4<f32>(slope / size, found.x);
    }
    return vec4<f32>(1.0, 0.0, 0.0, found.x);
}

// The unit gradient, and in w the signed distance (m) from a place in the tool's frame (m); outside the grid the
// distance to where the surface is nearest to the nearest place of the grid.
fn tool_grid_distance(grid: ToolGrid, far_place: vec3<f32>) -> vec4<f32> {
    let y = clamp(far_place, vec3<f32>(-GRID_FAR), vec3<f32>(GRID_FAR));
    let origin = vec3<f32>(grid.x, grid.y, grid.z);
    let cells = vec3<f32>(vec3<u32>(grid.nx, grid.ny, grid.nz) - vec3<u32>(1u));
    let inside = clamp(y, origin, origin + grid.spacing * cells);
    let found = tool_grid_within(grid, inside);
    if all(inside == y) {
        return found;
    }
    let way = y - (inside - found.w * found.xyz);
    let size = length(way);
    if size > GRID_NEAR {
        return vec4<f32>(way / size, size);
    }
    return vec4<f32>(found.xyz, size);
}
