// Faces of removed elements bear no load.
@group(0) @binding(0) var<storage, read> alive: array<u32>;

fn bears(element: u32) -> bool {
    return alive[element] == 1u;
}
