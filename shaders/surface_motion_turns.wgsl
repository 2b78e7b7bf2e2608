// How far surfaces have moved, for who begins the next step's: see surface_contact_place.wgsl.
@group(0) @binding(0) var<storage, read_write> surface_motion: array<atomic<u32>>;

fn motion(word: u32) -> u32 {
    return atomicLoad(&surface_motion[word]);
}
