// What rounding has left out of the displacement, for kernels that only look at it.
fn compensation_of(node: u32, axis: u32) -> f32 {
    return displacement_compensation[3u * node + axis];
}
