// Which nodes a kernel works on.
struct PassRows {
    count: u32, // where its rows end
    first: u32, // row
}
@group(0) @binding(0) var<uniform> pass_rows: PassRows;
