// What kernels of contact between surfaces share: the surfaces, and what may be near what. Twin of
// systems/surface_contact/words.rs. All numbers stand as words, floats as their bits. motion is in
// surface_motion.wgsl, or in surface_motion_turns.wgsl.
struct SurfaceContact {
    nodes: u32, // of all surfaces
    points: u32, // that may meet others: the nodes, then points of faces
    items: u32, // that have contacts: the points, then edges
    contacts: u32, // that there is room for
    triangles: u32,
    bodies: u32,
    first: u32, // first node, point or edge that the kernel is for
    count: u32, // how many
    body: u32, // the body whose columns are bound
    around: u32, // where in surface_faces are: starts of the triangles around each node, and these
    meetings: u32, // words for each pair of bodies
    apart: u32, // starts of the triangles that are never in a point's way, and these
    face_points: u32, // words for each point of a face
    facets: u32, // the corners of the facet that each triangle is of
    edges: u32, // words for each edge
    begins: u32, // starts of the edges that begin at each node, and these
    list: u32, // where in surface_lists are: starts of what is near each item (triangles, of edges edges), and these
    inverse: u32, // starts of the items that may have contacts at a node, and these
    displacements: u32, // when the lists were made (m)
    margin: f32, // how far triangles are looked at beyond thickness and motion, at most (m)
    rounding: f32, // of a place, and more (m)
    thickness: f32, // the largest (m)
    depth: f32, // the deepest inside of the shallowest body (m): of others more is in lists
    relaxed: u32, // whether it is a static analysis
}
@group(0) @binding(0) var<uniform> surface: SurfaceContact;
@group(0) @binding(0) var<storage, read> surface_faces: array<u32>; // eight a triangle: corners, who is beside, body, depth; more behind
// the radius (m), whether contacts of edges lie as what is near them, and what is said above
@group(0) @binding(0) var<storage, read> surface_lists: array<u32>;

// of two bodies: what meets, friction that sticks and slides, thickness, share and damping of a spring, the smaller
// edge of both, how far triangles are looked at beyond thickness and motion, how fast points come out that begin inside
const MEETING_WORDS: u32 = 9u;
const EDGE: u32 = 6u; // (m)
const MARGIN: u32 = 7u; // (m)
const SETTLING: u32 = 8u; // (m/s)
const NODES_MEET: u32 = 1u;
const FACES_MEET: u32 = 2u;
const EDGES_MEET: u32 = 4u;
const FACE_POINT_WORDS: u32 = 9u; // corners of its facet, what each has of it, the triangle that it is on
const EDGE_WORDS: u32 = 7u; // ends, the triangles beside it, their corners across from it, body
const EDGE_CONTACTS: u32 = 4u; // that each edge has room for where they do not lie so
const NONE: u32 = 0xffffffffu;

fn largest_step() -> f32 {
    return sqrt(bitcast<f32>(motion(step.number & 1u)));
}

// Whether all that may be near is in the lists. If not, everything is gone through: slow, and right.
fn lists_hold() -> bool {
    let nearer = 2.0 * sqrt(bitcast<f32>(motion(2u + (step.number & 1u))));
    let reach = 4.0 * largest_step() + surface.margin;
    let farthest = max(surface.thickness + reach, surface.depth);
    return 1.0001 * (farthest + nearer) <= bitcast<f32>(surface_lists[0]);
}

// The first contact of an item and the end of them: two of a point; of an edge as many as there are others near it, as
// long as there is room for that.
fn contacts_of(item: u32, hold: bool) -> vec2<u32> {
    if item < surface.points {
        return vec2<u32>(2u * item, 2u * item + 2u);
    }
    let of_edges = 2u * surface.points;
    if hold && surface_lists[1] != 0u {
        let before = surface_lists[surface.list + surface.points];
        let of_item = vec2<u32>(surface_lists[surface.list + item], surface_lists[surface.list + item + 1u]);
        return of_edges + of_item - before;
    }
    let first = of_edges + EDGE_CONTACTS * (item - surface.points);
    return vec2<u32>(first, first + EDGE_CONTACTS);
}
