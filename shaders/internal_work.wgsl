// Work against internal forces (J), summed over sixty-four invocations and kept in the place of the first one's node,
// for integrate: what the guards compare with the energy that elements hold. INTERNAL_WORK_AT, GROUP_ROWS and
// step_before are generated; INVOCATIONS of the kernel are whole sixty-fours.
var<private> internal_work: f32;
var<workgroup> internal_work_parts: array<f32, INVOCATIONS>;

// Forces at the beginning of the step along the mean of the steps before and after; counted by the
// time between the middles of both.
fn add_internal_work(node: u32, before: vec3<f32>, after: vec3<f32>, constrained: vec3<bool>, inner: vec3<f32>) {
    let last = select(before, step_before(node), constrained);
    internal_work += 0.5 * step.work_factor * dot(inner, last + after);
}

// The same number, in a way that no compiler can look through.
fn kept(x: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) ^ step.zero);
}

// Adds what each sixty-four invocations have done since the last time to their sum and to what rounding has left out of
// it (Kahan 1965); all invocations must call it.
fn add_up_internal_work(local: u32, node: u32) {
    internal_work_parts[local] = internal_work;
    internal_work = 0.0;
    let lane = local % 64u;
    workgroupBarrier();
    for (var width = 32u; width > 0u; width /= 2u) {
        if lane < width {
            internal_work_parts[local] += internal_work_parts[local + width];
        }
        workgroupBarrier();
    }
    if lane == 0u && node < pass_rows.count {
        let at = INTERNAL_WORK_AT + 2u * (node / GROUP_ROWS);
        let before = bitcast<f32>(atomicLoad(&node_diagnostics[at]));
        let part = kept(internal_work_parts[local] + bitcast<f32>(atomicLoad(&node_diagnostics[at + 1u])));
        let after = kept(before + part);
        atomicStore(&node_diagnostics[at], bitcast<u32>(after));
        atomicStore(&node_diagnostics[at + 1u], bitcast<u32>(part - kept(after - before)));
    }
}
