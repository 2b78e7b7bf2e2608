// Work against internal forces (J), summed over sixty-four invocations and kept in the place of the first one's node, for integrate:
// what the guards compare with the energy that elements hold. SPENT_AT, SPENT_ROWS and step_before are generated; INVOCATIONS of the
// kernel are whole sixty-fours.
var<private> spent: f32;
var<workgroup> spent_parts: array<f32, INVOCATIONS>;

// Forces at the beginning of the step along the mean of the steps before and after; counted by the
// time between the middles of both.
fn spend(node: u32, before: vec3<f32>, after: vec3<f32>, constrained: vec3<bool>, inner: vec3<f32>) {
    let last = select(before, step_before(node), constrained);
    spent += 0.5 * step.booked * dot(inner, last + after);
}

// The same number, in a way that no compiler can look through.
fn kept(x: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) ^ step.zero);
}

// Adds what each sixty-four invocations have spent since the last time to their sum and to what rounding has left out of it (Kahan
// 1965); all invocations must call it.
fn add_up_spent(local: u32, node: u32) {
    spent_parts[local] = spent;
    spent = 0.0;
    let lane = local % 64u;
    workgroupBarrier();
    for (var width = 32u; width > 0u; width /= 2u) {
        if lane < width {
            spent_parts[local] += spent_parts[local + width];
        }
        workgroupBarrier();
    }
    if lane == 0u && node < pass_rows.count {
        let at = SPENT_AT + 2u * (node / SPENT_ROWS);
        let before = bitcast<f32>(atomicLoad(&first_non_finite[at]));
        let part = kept(spent_parts[local] + bitcast<f32>(atomicLoad(&first_non_finite[at + 1u])));
        let after = kept(before + part);
        atomicStore(&first_non_finite[at], bitcast<u32>(after));
        atomicStore(&first_non_finite[at + 1u], bitcast<u32>(part - kept(after - before)));
    }
}
