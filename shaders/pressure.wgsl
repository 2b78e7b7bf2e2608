// A pressure that follows the surface; twin of systems/pressure.rs. bears is in alive.wgsl, or generated where no
// element ever goes; face_area_at is in face_area.wgsl.
// signal: slot of the pressure (Pa); corners: face times four plus corner.
fn pressure(i: u32, node: u32) {
    var area = vec3<f32>(0.0);
    for (var at = starts[i]; at < starts[i + 1u]; at++) {
        let face = corners[at] / 4u;
        if bears(faces[6u * face + 4u]) {
            area += bitcast<f32>(faces[6u * face + 5u]) * face_area_at(face, corners[at] % 4u);
        }
    }
    add_load(node, -step.signals[parameters.signal].x * area);
}
