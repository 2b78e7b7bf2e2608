// A tool that is a grid of distances, for tool_row.wgsl.
fn grid_distance(row: ToolRow, y: vec3<f32>) -> vec4<f32> {
    return tool_grid_distance(
        ToolGrid(row.size_0, row.size_1, row.size_2, row.spacing, row.nx, row.ny, row.nz, row.first), y);
}
