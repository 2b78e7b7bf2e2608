// Columns of an element block, as src/components/block.rs lays them out. LANES, NODES and ROWS are generated.
struct Block {
    count: u32, // elements
    force_offset: u32, // where the block's forces begin
}
@group(0) @binding(0) var<uniform> block: Block;

// Place of number k of `numbers` of an element.
fn place(element: u32, numbers: u32, k: u32) -> u32 {
    return (element / LANES * numbers + k) * LANES + element % LANES;
}

// Three numbers of an element's rest shape, from row k on.
fn shape_vector(element: u32, k: u32) -> vec3<f32> {
    let at = place(element, ROWS, k);
    return vec3<f32>(rest_shape[at], rest_shape[at + LANES], rest_shape[at + 2u * LANES]);
}
