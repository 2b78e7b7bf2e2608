// Fibres of a direction of their own in each element.
@group(0) @binding(0) var<storage, read> fibre_direction: array<f32>;

fn fibre_direction_of(element: u32) -> vec3<f32> {
    let at = place(element, 3u, 0u);
    return vec3<f32>(fibre_direction[at], fibre_direction[at + LANES], fibre_direction[at + 2u * LANES]);
}
