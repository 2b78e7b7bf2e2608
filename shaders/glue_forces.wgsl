// What ties do to a node, in a fixed order: the sum of a vector that a step finds of each.
@group(0) @binding(0) var<storage, read> glue_found: array<f32>;

fn sum_of_ties(node: u32, word: u32) -> vec3<f32> {
    let of_node = ties_of(node);
    var sum = vec3<f32>(0.0);
    for (var number = of_node.x; number < of_node.y; number++) {
        let tie = tie_of_node(number);
        let found = FOUND_NUMBERS * tie.index;
        if glue_found[found + ACTIVE] != 0.0 {
            let at = found + word;
            sum += tie.weight * vec3<f32>(glue_found[at], glue_found[at + 1u], glue_found[at + 2u]);
        }
    }
    return sum;
}
