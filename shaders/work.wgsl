// Work booked for energies, for integrate: by loads, against damping, by constraints, by internal forces (J).
@group(0) @binding(0) var<storage, read_write> work: array<f32>;

fn book_work(
    node: u32,
    before: vec3<f32>,
    after: vec3<f32>,
    constrained: vec3<bool>,
    inner: vec3<f32>,
    outer: vec3<f32>,
) {
    // the mean of the steps before and after makes the balance exact; constrained axes have only the step after
    let along = select(0.5 * (before + after), after, constrained);
    let lost = coefficient_of(node) * step.rate * along * along;
    let held = select(vec3<f32>(0.0), (inner - outer) * along + lost, constrained);
    work[4u * node] += dot(outer, along);
    work[4u * node + 1u] += lost.x + lost.y + lost.z;
    work[4u * node + 2u] += held.x + held.y + held.z;
    work[4u * node + 3u] += dot(inner, along);
}
