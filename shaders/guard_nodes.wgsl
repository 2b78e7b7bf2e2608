// What a body's nodes come to, sixty-four at a time: ½ m d² (kg m²), the longest step, the square of the largest
// displacement (m²); and displacements in the middle of the last step, where velocities are, for guard_elements.wgsl.
// Twin of the sums in src/observation/sample.rs.
struct GuardNodes {
    count: u32,
}
@group(0) @binding(0) var<uniform> nodes: GuardNodes;
@group(0) @binding(1) var<storage, read> mass: array<f32>;
@group(0) @binding(2) var<storage, read> displacement: array<f32>;
@group(0) @binding(3) var<storage, read> displacement_increment: array<f32>;
@group(0) @binding(4) var<storage, read_write> middle_displacement: array<f32>;
@group(0) @binding(5) var<storage, read_write> node_sums: array<u32>; // four words a workgroup

var<workgroup> motions: array<f32, 64>;
var<workgroup> squares: array<f32, 64>;
var<workgroup> fastest: array<u32, 64>;
var<workgroup> reaches: array<f32, 64>;

@compute @workgroup_size(64)
fn guard_nodes(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let node = row(id, groups);
    motions[local] = 0.0;
    squares[local] = -1.0;
    fastest[local] = 0xffffffffu;
    reaches[local] = 0.0;
    if node < nodes.count {
        let at = 3u * node;
        let d = vec3<f32>(displacement_increment[at], displacement_increment[at + 1u], displacement_increment[at + 2u]);
        middle_displacement[at] = displacement[at] - 0.5 * d.x;
        middle_displacement[at + 1u] = displacement[at + 1u] - 0.5 * d.y;
        middle_displacement[at + 2u] = displacement[at + 2u] - 0.5 * d.z;
        squares[local] = dot(d, d);
        motions[local] = 0.5 * mass[node] * squares[local];
        fastest[local] = node;
        let u = vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
        reaches[local] = dot(u, u);
    }
    workgroupBarrier();
    for (var width = 32u; width > 0u; width /= 2u) {
        if local < width {
            motions[local] += motions[local + width];
            reaches[local] = max(reaches[local], reaches[local + width]);
            if squares[local + width] > squares[local] {
                squares[local] = squares[local + width];
                fastest[local] = fastest[local + width];
            }
        }
        workgroupBarrier();
    }
    if local == 0u && node < nodes.count {
        let at = node / 16u;
        node_sums[at] = bitcast<u32>(motions[0]);
        node_sums[at + 1u] = bitcast<u32>(squares[0]);
        node_sums[at + 2u] = fastest[0];
        node_sums[at + 3u] = bitcast<u32>(reaches[0]);
    }
}
