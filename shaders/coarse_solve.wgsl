// The coarse level: forces and moments on aggregates, and the dense inverse of their matrix times them; see
// coarse_level.wgsl. A workgroup an aggregate, and an unknown.
// where the nodes of each aggregate begin, and the end; behind these, the nodes
@group(0) @binding(10) var<storage, read> aggregate_nodes: array<u32>;
@group(0) @binding(11) var<storage, read> residual: array<f32>;
@group(0) @binding(12) var<storage, read_write> coarse_forces: array<f32>;
// of an unknown the first of its piece, how many those are, and where its row of the inverse begins
@group(0) @binding(13) var<storage, read> coarse_rows: array<u32>;
@group(0) @binding(14) var<storage, read> coarse_inverse: array<f32>;
@group(0) @binding(15) var<storage, read_write> coarse_motions: array<f32>;

var<workgroup> forces: array<vec3<f32>, 64>;
var<workgroup> moments: array<vec3<f32>, 64>;

@compute @workgroup_size(64)
fn restrict_residual(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let aggregate = patch_row(group_id, groups);
    var force = vec3<f32>(0.0);
    var moment = vec3<f32>(0.0);
    if aggregate < extent.aggregates {
        let back = transpose(turn_of(aggregate));
        for (var i = aggregate_nodes[aggregate] + local; i < aggregate_nodes[aggregate + 1u]; i += 64u) {
            let node = aggregate_nodes[i];
            let r = back * vec3<f32>(residual[3u * node], residual[3u * node + 1u], residual[3u * node + 2u]);
            force += r;
            moment += cross(arms[node].xyz, r);
        }
    }
    forces[local] = force;
    moments[local] = moment;
    workgroupBarrier();
    for (var width = 32u; width > 0u; width /= 2u) {
        if local < width {
            forces[local] += forces[local + width];
            moments[local] += moments[local + width];
        }
        workgroupBarrier();
    }
    if local == 0u && aggregate < extent.aggregates {
        for (var axis = 0u; axis < 3u; axis++) {
            coarse_forces[6u * aggregate + axis] = forces[0][axis];
            coarse_forces[6u * aggregate + 3u + axis] = moments[0][axis];
        }
    }
}

@compute @workgroup_size(64)
fn solve_coarse(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let unknown = patch_row(group_id, groups);
    var product = 0.0;
    if unknown < extent.unknowns {
        let first = coarse_rows[3u * unknown];
        let size = coarse_rows[3u * unknown + 1u];
        let at = coarse_rows[3u * unknown + 2u];
        for (var i = local; i < size; i += 64u) {
            product += coarse_inverse[at + i] * coarse_forces[first + i];
        }
    }
    let of_group = sum_of_group(local, vec2<f32>(product, 0.0));
    if local == 0u && unknown < extent.unknowns {
        coarse_motions[unknown] = of_group.x;
    }
}
