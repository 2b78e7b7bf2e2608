// Wind along x, in gusts that travel with it: the drag of the air on every node, by its speed past the node.
//   F = m d |w − v| (w − v)
// The force is shared out by mass, so that it does not depend on the mesh.
struct Wind {
    speed: f32, // mean speed of the air (m/s)
    gust: f32, // the share of it by which gusts are faster and lulls slower
    period: f32, // time between two gusts (s)
    drag: f32, // d = ½ ρ c A/M (1/m): density of the air (kg/m³), drag coefficient, area (m²) and mass (kg) of the body
}
@group(0) @binding(0) var<uniform> parameters: Wind;

const TURN = 6.283185307179586;

// Speed of the air at a place and a time (m/s).
fn air(x: f32, time: f32) -> f32 {
    let phase = TURN * (time - x / parameters.speed) / parameters.period;
    return parameters.speed * (1.0 + parameters.gust * sin(phase));
}

// The force on a node (N).
fn wind(node: Node) -> vec3<f32> {
    let place = node.rest_position + node.displacement;
    let past = vec3<f32>(node.curve * air(place.x, node.time), 0.0, 0.0) - node.velocity;
    return node.mass * parameters.drag * length(past) * past;
}
