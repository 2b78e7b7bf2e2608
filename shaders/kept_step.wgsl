// Keeps the last step along prescribed axes, which boundary is about to write over, for the work that integrate books.
// BEFORE_AT is generated.
@group(0) @binding(0) var<storage, read_write> first_non_finite: array<atomic<u32>>;

fn keep_step(at: u32) {
    atomicStore(&first_non_finite[BEFORE_AT + at], bitcast<u32>(displacement_step[at]));
}
