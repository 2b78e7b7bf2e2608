// Goes through the contacts that act on a node, in the order in which the CPU adds them up: by points ascending, then
// by edges. collect is of who asks.

// The sum over contacts of a node.
fn collect_all(node: u32) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    let hold = lists_hold();
    let starts = surface.inverse + node;
    let begin = select(0u, surface_lists[starts], hold);
    let end = select(surface.items, surface_lists[starts + 1u], hold);
    let items = surface.inverse + surface.nodes + 1u;
    for (var place = begin; place < end; place++) {
        var item = place;
        if hold {
            item = surface_lists[items + place];
        }
        let of_item = contacts_of(item, hold);
        for (var contact = of_item.x; contact < of_item.y; contact++) {
            if !is_active(contact) {
                continue;
            }
            for (var part = 0u; part < PARTS; part++) {
                if part_node(contact, part) == node {
                    sum += collect(contact, part_weight(contact, part));
                }
            }
        }
    }
    return sum;
}
