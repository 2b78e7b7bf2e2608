// A tool at a body, and how far places are from it; twin of systems/tool_contact/row.rs. tool_distance is in
// tool_shape.wgsl, grid_distance in tool_of_grid.wgsl, or generated where no tool is a grid.
struct ToolRow {
    kind: u32,
    size_0: f32,
    size_1: f32,
    size_2: f32,
    size_3: f32,
    size_4: f32,
    size_5: f32,
    rounding: f32,
    signal: u32, // first of six slots: where it is, and how that differs from where it was
    sticking: f32, // coefficients of friction
    sliding: f32,
    spacing: f32, // of a grid, whose first point is at the first three sizes (m)
    nx: u32,
    ny: u32,
    nz: u32,
    first: u32,
    share: f32, // of a spring in place of the kinematic law; 0: there is none
    damping: f32,
    swept: f32, // how far a node must go for its way to be looked at (m); 0: it never is
    room: u32,
}

const TOOL_GRID: u32 = 0xffffffffu;

// The unit gradient, and in w the distance (m), at a place in the tool's frame.
fn distance_to(row: ToolRow, y: vec3<f32>) -> vec4<f32> {
    if row.kind == TOOL_GRID {
        return grid_distance(row, y);
    }
    return tool_distance(
        ToolShape(row.kind, row.size_0, row.size_1, row.size_2, row.size_3, row.size_4, row.size_5, row.rounding), y);
}

// A point of the scene in the frame of a pose whose rows and places are in three slots, from where it was at rest and
// how far it has moved since: in this order digits of small motions are kept near a tool that stands still.
fn into_frame(rows: array<vec4<f32>, 3>, rest: vec3<f32>, moved: vec3<f32>) -> vec3<f32> {
    let y = (rest - vec3<f32>(rows[0].w, rows[1].w, rows[2].w)) + moved;
    return y.x * rows[0].xyz + y.y * rows[1].xyz + y.z * rows[2].xyz;
}
