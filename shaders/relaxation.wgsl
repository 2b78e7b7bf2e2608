// Damping of a static analysis, for integrate: centred, the same a for all nodes.
fn damped(node: u32, before: vec3<f32>, pushed: vec3<f32>, per_mass: f32) -> vec3<f32> {
    let a = step.relaxation;
    return (pushed - (1.0 + step.after_first) * a * before) / (1.0 + step.after_first * a);
}
