// θ of a patch's nodes in workgroup memory, for elements with averaged nodal pressure.
@group(0) @binding(0) var<storage, read> nodal_volume_change: array<f32>;

var<workgroup> patch_volume_change: array<f32, PATCH_NODES>;

fn bring_volume_change(local_node: u32, node: u32) {
    patch_volume_change[local_node] = nodal_volume_change[node];
}

fn corner_volume_change(element: u32, corner: u32) -> f32 {
    return patch_volume_change[corner_word(element, corner) & PLACE_BITS];
}
