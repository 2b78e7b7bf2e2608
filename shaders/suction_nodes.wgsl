// Marks the nodes of the faces that suction_mouth.wgsl has marked. criterion_due is generated, the mouth is in
// suction_tool.wgsl.
@group(0) @binding(1) var<storage, read_write> suction_marks: array<u32>;
@group(0) @binding(2) var<storage, read> faces_of_nodes: array<u32>; // where each node's begin, then they

@compute @workgroup_size(64)
fn suction_nodes(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= mouth.nodes || !criterion_due() {
        return;
    }
    var mark = 0u;
    for (var at = faces_of_nodes[i]; at < faces_of_nodes[i + 1u]; at++) {
        if suction_marks[mouth.first + faces_of_nodes[at]] != 0u {
            mark = 1u;
        }
    }
    suction_marks[mouth.first + mouth.faces + i] = mark;
}
