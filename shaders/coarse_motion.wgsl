// What the coarse level moves a node by (m).
@group(0) @binding(9) var<storage, read> coarse_motions: array<f32>; // translation and rotation of an aggregate

fn coarse_motion_of(node: u32) -> vec3<f32> {
    let arm = arms[node];
    if arm.w < 0.0 {
        return vec3<f32>(0.0);
    }
    let aggregate = u32(arm.w);
    let at = 6u * aggregate;
    let translation = vec3<f32>(coarse_motions[at], coarse_motions[at + 1u], coarse_motions[at + 2u]);
    let rotation = vec3<f32>(coarse_motions[at + 3u], coarse_motions[at + 4u], coarse_motions[at + 5u]);
    return turn_of(aggregate) * (translation + cross(rotation, arm.xyz));
}
