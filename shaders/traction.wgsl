// Dead loads on the surface; twin of systems/traction.rs. bears is in alive.wgsl, or generated where no element ever goes.
struct TractionLoad {
    count: u32, // loaded nodes
    signal: u32, // slot of the force per area (Pa)
}
@group(0) @binding(0) var<uniform> load: TractionLoad;
@group(0) @binding(1) var<storage, read> rows: array<u32>;
@group(0) @binding(2) var<storage, read> starts: array<u32>;
@group(0) @binding(3) var<storage, read> areas: array<f32>; // that fall to the node from each of its faces (m²)
@group(0) @binding(4) var<storage, read> behind: array<u32>; // row of the element behind each of them

@compute @workgroup_size(64)
fn traction(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= load.count {
        return;
    }
    var area = 0.0;
    for (var at = starts[i]; at < starts[i + 1u]; at++) {
        if bears(behind[at]) {
            area += areas[at];
        }
    }
    add_load(rows[i], step.signals[load.signal].xyz * area);
}
