// Mass times acceleration along z: a load as a scene may have it, for `sinew bench --loads wgsl`.
struct Weight {
    acceleration: f32, // m/s²
}
@group(0) @binding(0) var<uniform> parameters: Weight;

fn weight(node: Node) -> vec3<f32> {
    return vec3<f32>(0.0, 0.0, node.mass * parameters.acceleration);
}
