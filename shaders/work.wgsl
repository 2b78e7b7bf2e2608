// Work counted for energies, for integrate: by loads, against damping, by constraints, by internal forces (J), then the
// last step along constrained axes (m), which boundary has written over.
@group(0) @binding(0) var<storage, read_write> work: array<f32>;

fn accumulate_work(
    node: u32,
    before: vec3<f32>,
    after: vec3<f32>,
    constrained: vec3<bool>,
    inner: vec3<f32>,
    outer: vec3<f32>,
) {
    let first = 7u * node;
    let kept = vec3<f32>(work[first + 4u], work[first + 5u], work[first + 6u]);
    // in the middle of each step the balance is exact: from middle to middle, in the first step half of it
    let mean = 0.5 * (select(before, kept, constrained) + after);
    let along = step.work_factor * mean;
    let compensation = coefficient_of(node) * step.rate * mean * along;
    let held = select(vec3<f32>(0.0), (inner - outer) * along + compensation, constrained);
    work[first] += dot(outer, along);
    work[first + 1u] += compensation.x + compensation.y + compensation.z;
    work[first + 2u] += held.x + held.y + held.z;
    work[first + 3u] += dot(inner, along);
    let last = select(kept, after, constrained);
    work[first + 4u] = last.x;
    work[first + 5u] = last.y;
    work[first + 6u] = last.z;
}
