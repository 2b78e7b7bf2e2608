// Faces in the mouth of a tool are sucked into it; twin of systems/suction.rs. suction_mouth.wgsl marks them;
// face_area_at is in face_area.wgsl.
struct SuctionLoad {
    faces: u32, // of the body
    first: u32, // where the tool's marks begin
    pressure: u32, // and its numbers in suction_pressure
    lists: u32, // where corners begin in lists
}
@group(0) @binding(0) var<uniform> load: SuctionLoad;
@group(0) @binding(1) var<storage, read> lists: array<u32>; // where each node's corners begin; face times four plus corner
@group(0) @binding(2) var<storage, read> suction_marks: array<u32>; // bits of shares of faces; 1 at their nodes
@group(0) @binding(3) var<storage, read> suction_pressure: array<f32>;

fn suction(i: u32, node: u32) {
    if suction_marks[load.first + load.faces + i] == 0u {
        return;
    }
    var area = vec3<f32>(0.0);
    for (var at = lists[i]; at < lists[i + 1u]; at++) {
        let corner = lists[load.lists + at];
        let face = corner / 4u;
        let share = bitcast<f32>(suction_marks[load.first + faces[6u * face + 4u]]);
        if share > 0.0 {
            area += share * bitcast<f32>(faces[6u * face + 5u]) * face_area_at(face, corner % 4u);
        }
    }
    add_load(node, suction_pressure[load.pressure] * area);
}
