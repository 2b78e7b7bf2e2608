// Directions of each element's own, for the families that have them. VARYING is generated: how many they are.
@group(0) @binding(0) var<storage, read> fibre_direction: array<f32>;

fn varying_direction(element: u32, family: u32) -> vec3<f32> {
    let at = place(element, 3u * VARYING, 3u * family);
    return vec3<f32>(fibre_direction[at], fibre_direction[at + LANES], fibre_direction[at + 2u * LANES]);
}
