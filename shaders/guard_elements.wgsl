// What a block's elements come to, sixty-four at a time: energies (J), the smallest J and its element; twin of
// src/backend/cpu/guard_kernel.rs. `displacement` is in the middle of the last step, as guard_nodes.wgsl has left it.
@group(0) @binding(0) var<storage, read> rest_shape: array<f32>;
@group(0) @binding(1) var<storage, read_write> element_sums: array<u32>; // four words a workgroup

var<workgroup> energies: array<vec2<f32>, 64>;
var<workgroup> ratios: array<f32, 64>;
var<workgroup> elements: array<u32, 64>;

@compute @workgroup_size(64)
fn guard_elements(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let element = row(id, groups);
    energies[local] = vec2<f32>(0.0);
    ratios[local] = 3.0e38;
    elements[local] = 0xffffffffu;
    if element < block.count {
        let e = element_of(element);
        if e.volume > 0.0 {
            var least = 3.0e38;
            for (var point = 0u; point < POINTS; point++) {
                least = min(least, elastic_kinematics(at_point(e, point).gradient).true_j);
            }
            for (var point = POINTS; point < CHECKED_POINTS; point++) {
                least = min(least, 1.0 + volume_change_of(at_point(e, point).gradient));
            }
            energies[local] = vec2<f32>(energy_density(element, e) * e.volume, hourglass_energy(element, e));
            ratios[local] = least;
            elements[local] = element;
        }
    }
    workgroupBarrier();
    for (var width = 32u; width > 0u; width /= 2u) {
        if local < width {
            energies[local] += energies[local + width];
            if ratios[local + width] < ratios[local] {
                ratios[local] = ratios[local + width];
                elements[local] = elements[local + width];
            }
        }
        workgroupBarrier();
    }
    if local == 0u && element < block.count {
        let at = element / 16u;
        element_sums[at] = bitcast<u32>(energies[0].x);
        element_sums[at + 1u] = bitcast<u32>(energies[0].y);
        element_sums[at + 2u] = bitcast<u32>(ratios[0]);
        element_sums[at + 3u] = elements[0];
    }
}
