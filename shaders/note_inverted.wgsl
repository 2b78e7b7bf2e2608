// Elements turned inside out are noted, the lowest of the first step in which there is one; guards stop the run, or the
// material recovers.
@group(0) @binding(0) var<storage, read_write> first_inverted: array<atomic<u32>>;

fn is_removed_inverted(element: u32) -> bool {
    if atomicMin(&first_inverted[1], step.number) >= step.number {
        atomicMin(&first_inverted[0], element);
    }
    return false;
}
