// θ at corners of elements, in the block's column; patch_volume.wgsl has it patch-local.
@group(0) @binding(0) var<storage, read> nodal_volume_change: array<f32>;

fn corner_volume_change(element: u32, corner: u32) -> f32 {
    return nodal_volume_change[connectivity[place(element, NODES, corner)]];
}
