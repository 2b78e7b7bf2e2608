// Whether the time of an element has come; also of one that has gone.
fn is_due(element: u32) -> bool {
    let due = removal_step[element];
    return due != 0xffffffffu && due <= max(step.number, step.number + 1u);
}
