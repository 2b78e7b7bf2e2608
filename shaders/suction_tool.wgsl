// What a tool sucks by, as the kernels see it that find its faces, their nodes and its pressure.
struct SuctionMouth {
    faces: u32, // of the body
    nodes: u32, // of these faces
    parts: u32, // flat faces that they are loaded as
    first: u32, // where the tool's marks begin: of faces, then of nodes
    numbers: u32, // and its numbers in suction_pressure
    pose: u32, // first slot of where it is
    pressure: u32, // slot of the pressure with a closed mouth (Pa)
    bore: f32, // (m)
    reach: f32, // (m)
    delay: f32, // (s)
    area: f32, // of the mouth (m²)
}
@group(0) @binding(0) var<uniform> mouth: SuctionMouth;
