// Whether an element's time has come.
fn is_due(element: u32) -> bool {
    let due = removal_step[element];
    return alive[element] == 1u && due != 0xffffffffu && due <= max(step.number, step.number + 1u);
}
