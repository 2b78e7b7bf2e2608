// How far surfaces have moved: see surface_contact_place.wgsl.
@group(0) @binding(0) var<storage, read> surface_motion: array<u32>;

fn motion(word: u32) -> u32 {
    return surface_motion[word];
}
