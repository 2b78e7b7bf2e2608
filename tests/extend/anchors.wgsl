// Springs to goals, one for each row of a list; twin of anchors.rs.
fn anchors(i: u32, node: u32) {
    for (var k = 0u; k < 3u; k++) {
        let axis = axes[k];
        var pull = vec3<f32>(0.0);
        pull[axis] = mass[node] * parameters.stiffness * (goal_at(i, axis) - displacement[3u * node + axis]);
        add_load(node, pull);
    }
}
