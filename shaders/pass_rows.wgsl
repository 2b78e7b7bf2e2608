// How many nodes a kernel works on.
struct NodePass {
    count: u32, // rows
}
@group(0) @binding(0) var<uniform> pass_rows: NodePass;
