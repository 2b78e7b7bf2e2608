// Corners of elements in the body's columns; patches.wgsl has them patch-local.
@group(0) @binding(0) var<storage, read> displacement: array<f32>;
@group(0) @binding(1) var<storage, read> connectivity: array<u32>;

// Displacement (m) of an element's corner.
fn corner_displacement(element: u32, corner: u32) -> vec3<f32> {
    let at = 3u * connectivity[place(element, NODES, corner)];
    return vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
}
