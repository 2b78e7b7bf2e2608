// Means of the change of volume around nodes, for elements with averaged nodal pressure; twin of
// systems/nodal_volume.rs.
@group(0) @binding(0) var<storage, read> rest_shape: array<f32>;
@group(0) @binding(1) var<storage, read_write> element_volume: array<f32>;

// Each element's volume (m³), and that times θ.
@compute @workgroup_size(64)
fn element_volumes(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let element = row(id, groups);
    if element >= block.count {
        return;
    }
    let at = at_point(element_of(element), 0u);
    let theta = elastic_volume_measure(elastic_kinematics(at.gradient));
    element_volume[place(element, 2u, 0u)] = at.volume;
    element_volume[place(element, 2u, 1u)] = at.volume * theta;
}
