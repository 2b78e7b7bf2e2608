// Keeps the last step along prescribed axes, which boundary is about to write over, for the work that integrate counts.
// PREVIOUS_PRESCRIBED_AT is generated.
@group(0) @binding(0) var<storage, read_write> node_diagnostics: array<atomic<u32>>;

fn keep_previous_step(at: u32) {
    atomicStore(&node_diagnostics[PREVIOUS_PRESCRIBED_AT + at], bitcast<u32>(displacement_increment[at]));
}
