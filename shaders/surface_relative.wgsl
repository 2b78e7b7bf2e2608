// How a contact's point goes against what it faces.
@group(0) @binding(0) var<storage, read> surface_nodes: array<f32>;

fn at_node(node: u32, number: u32) -> vec3<f32> {
    let at = NODE_NUMBERS * node + number;
    return vec3<f32>(surface_nodes[at], surface_nodes[at + 1u], surface_nodes[at + 2u]);
}

// Of so many numbers of nodes on: the next step (m), or the last.
fn relative(contact: u32, of_nodes: u32) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var part = 0u; part < PARTS; part++) {
        let weight = part_weight(contact, part);
        if weight != 0.0 {
            sum += weight * at_node(part_node(contact, part), of_nodes);
        }
    }
    return sum;
}

fn along_surface(v: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return v - normal * dot(v, normal);
}
