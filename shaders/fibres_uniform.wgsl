// Fibres of one direction in the whole block.
struct UniformDirection {
    x: f32,
    y: f32,
    z: f32,
}
@group(0) @binding(0) var<uniform> uniform_direction: UniformDirection;

fn fibre_direction_of(element: u32) -> vec3<f32> {
    return vec3<f32>(uniform_direction.x, uniform_direction.y, uniform_direction.z);
}
