// Damping proportional to mass, centred, for integrate: with a = cΔt/(2m), a step d changes by (push − 2a d)/(1 + a).
@group(0) @binding(0) var<storage, read> damping_coefficient: array<f32>;

fn coefficient_of(node: u32) -> f32 {
    return damping_coefficient[node];
}

fn damped(node: u32, before: vec3<f32>, pushed: vec3<f32>, per_mass: f32) -> vec3<f32> {
    let a = coefficient_of(node) * step.half_step * per_mass;
    return (pushed - (1.0 + step.after_first) * a * before) / (1.0 + step.after_first * a);
}
