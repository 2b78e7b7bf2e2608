// What rounding has left out of the displacement, for kernels that only look at it.
@group(0) @binding(0) var<storage, read> displacement_compensation: array<f32>;

fn compensation_of(node: u32, axis: u32) -> f32 {
    return displacement_compensation[3u * node + axis];
}
