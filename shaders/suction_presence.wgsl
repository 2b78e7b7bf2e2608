// Which faces of a block's elements are there: the first part of suction_mouth.wgsl. criterion_due is generated.
struct Presence {
    count: u32, // elements of the block
}
@group(0) @binding(3) var<uniform> presence: Presence;
@group(0) @binding(0) var<storage, read> faces_of_elements: array<u32>; // where each element's begin, then they
@group(0) @binding(1) var<storage, read> alive: array<u32>;
@group(0) @binding(2) var<storage, read_write> face_presence: array<u32>;

@compute @workgroup_size(64)
fn suction_presence(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let element = row(id, groups);
    if element >= presence.count || !criterion_due() {
        return;
    }
    for (var at = faces_of_elements[element]; at < faces_of_elements[element + 1u]; at++) {
        face_presence[faces_of_elements[at]] = alive[element];
    }
}
