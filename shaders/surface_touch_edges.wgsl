// Notes what edges that cross others came to, with the node where they begin; in surface_contact_touch.wgsl.
fn note_edges(node: u32, at: u32) {
    let hold = lists_hold();
    let starts = surface.begins + node;
    let all = surface.begins + surface.nodes + 1u;
    for (var place = surface_faces[starts]; place < surface_faces[starts + 1u]; place++) {
        let of_edge = contacts_of(surface.points + surface_faces[all + place], hold);
        for (var contact = of_edge.x; contact < of_edge.y; contact++) {
            note(contact, at, false);
        }
    }
}
