// What kernels of contact between surfaces share: the surfaces, what may be near what, and how contacts lie. Twin of
// systems/surface_contact/device.rs. All numbers stand as words, floats as their bits. motion is in
// surface_motion.wgsl, or in surface_motion_turns.wgsl.
struct SurfaceContact {
    nodes: u32, // of all surfaces; each is a point that may meet others
    triangles: u32,
    bodies: u32,
    first: u32, // first node of the body whose columns are bound
    count: u32, // how many it has
    body: u32, // its number
    around: u32, // where in surface_faces are: starts of the triangles around each node, and these
    meetings: u32, // four words for each pair of bodies: whether they meet, friction that sticks and slides, thickness
    apart: u32, // starts of the triangles that are never in a point's way, and these
    list: u32, // where in surface_lists are: starts of the triangles near each point, and these
    inverse: u32, // starts of the points that are near a triangle of a node, and these
    displacements: u32, // when the lists were made (m)
    edge: f32, // (m)
    settling: f32, // how fast points come out that begin inside (m/s)
    margin: f32, // how far triangles are looked at beyond thickness and motion (m)
    rounding: f32, // of a place, and more (m)
    thickness: f32, // the largest (m)
    depth: f32, // the deepest inside (m)
    relaxed: u32, // whether it is a static analysis
}
@group(0) @binding(0) var<uniform> surface: SurfaceContact;
@group(0) @binding(0) var<storage, read> surface_faces: array<u32>; // eight a triangle: corners, who is beside, body, depth; more behind
@group(0) @binding(0) var<storage, read> surface_lists: array<u32>; // the radius (m), and what is said above

const NODE_NUMBERS: u32 = 12u; // place, next step, last step, response
const CONTACT_WORDS: u32 = 24u;
const TRIANGLE: u32 = 0u; // places of words of a contact
const WEIGHTS: u32 = 1u;
const NORMAL: u32 = 4u;
const GAP: u32 = 7u;
const FRICTION: u32 = 8u;
const SLIP: u32 = 9u;
const PRESSING: u32 = 12u;
const RUBBING: u32 = 13u;
const SLIDING: u32 = 16u;
const YIELDS: u32 = 17u;
const YIELDS_ALONG: u32 = 18u;
const CHANGE: u32 = 19u;
const OUTSIDE: u32 = 22u;
const ACTIVE: u32 = 23u;
const BY_STEP: u32 = 1u; // what a contact acts by: the step that is predicted, or a spring
const BY_SPRING: u32 = 2u;
const MEETING_WORDS: u32 = 6u; // of two bodies: whether they meet, friction that sticks and slides, thickness, share and damping of a spring
const NONE: u32 = 0xffffffffu;

fn largest_step() -> f32 {
    return sqrt(bitcast<f32>(motion(step.number & 1u)));
}

fn reach_of_step() -> f32 {
    return 4.0 * largest_step() + surface.margin;
}

// Whether all that may be near is in the lists. If not, all triangles and points are gone through: slow, and right.
fn lists_hold() -> bool {
    let nearer = 2.0 * sqrt(bitcast<f32>(motion(2u + (step.number & 1u))));
    let farthest = max(surface.thickness + reach_of_step(), surface.depth);
    return 1.0001 * (farthest + nearer) <= bitcast<f32>(surface_lists[0]);
}
