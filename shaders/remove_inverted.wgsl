// Elements turned inside out exert nothing any more and go before the coming step.
@group(0) @binding(0) var<storage, read_write> removal_step: array<u32>;

fn is_removed_inverted(element: u32) -> bool {
    if step.trying == 0u {
        removal_step[element] = min(removal_step[element], max(step.number, step.number + 1u));
    }
    return true;
}
