// Wind that blows above a height; twin of wind.rs.
fn wind(node: u32) {
    let z = rest_position[3u * node + 2u] + displacement[3u * node + 2u];
    let share = clamp(z / (2.0 * parameters.height), 0.0, 1.0);
    add_load(node, mass[node] * share * parameters.acceleration);
}
