// Dead loads on the surface; twin of systems/traction.rs. bears is in alive.wgsl, or generated where no element ever
// goes; factor_of is in load_factor.wgsl, or generated where all nodes get the same.
// signal: slot of the force per area (Pa); areas: that fall to the node from each of its faces (m²); behind: row of the
// element behind each of them.
fn traction(i: u32, node: u32) {
    var area = 0.0;
    for (var at = starts[i]; at < starts[i + 1u]; at++) {
        if bears(behind[at]) {
            area += areas[at];
        }
    }
    add_load(node, factor_of(i) * step.signals[parameters.signal].xyz * area);
}
