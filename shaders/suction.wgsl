// Faces in the mouth of a tool are sucked into it; twin of systems/suction.rs. suction_mouth.wgsl marks them;
// face_area_at is in face_area.wgsl.
// load: faces of the body, where the tool's marks begin (first) and its numbers in suction_pressure (pressure), where
// corners begin in lists; lists: where each node's corners begin, then face times four plus corner; suction_marks: bits
// of shares of faces, and 1 at their nodes.
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
