// What kernels of glue share: the ties, their nodes, and the ties of each node. Twin of systems/glue/kernels.rs. All
// numbers stand as words, floats as their bits.
struct GlueTies {
    nodes: u32, // of all bodies, each once
    ties: u32,
    first_node: u32, // of the body whose columns are bound
    node_count: u32,
    first_tie: u32, // of those whose points are of that body
    tie_count: u32,
    parts: u32, // where in glue_ties are: nodes of ties with their signed weights
    inverse: u32, // starts of the ties of each node, and these with its weights
    relaxed: u32, // whether it is a static analysis
}
@group(0) @binding(0) var<uniform> glue_of: GlueTies;
@group(0) @binding(0) var<storage, read> glue_ties: array<u32>;

const NODE_NUMBERS: u32 = 16u; // displacement, next step, last step, response, last step for work, one of nobody
const NEXT: u32 = 3u;
const LAST: u32 = 6u;
const RESPONSE: u32 = 9u;
const WENT: u32 = 12u;

const TIE_WORDS: u32 = 21u;
const PART: u32 = 0u; // places of words of a tie: its first part, and the end of them
const CORNERS: u32 = 2u; // the nodes of its face
const GAP: u32 = 5u; // where the point is in the frame of the face (m)
const SIDES: u32 = 8u; // two sides of the face at rest (m)
const OFF_AT_REST: u32 = 14u; // from the place on the face to the point (m)
const STRENGTH: u32 = 17u; // what bounds the force, and two numbers
const PLACE: u32 = 20u; // in tie_state

const FOUND_NUMBERS: u32 = 13u; // numbers that a step finds of a tie
const ACTIVE: u32 = 0u; // 1 if it holds
const OFF: u32 = 1u; // how far the point is off (m)
const FORCE: u32 = 4u; // the force on it (N)
const CHANGE: u32 = 7u; // what that has changed by in a sweep (N)
const OUT: u32 = 10u; // the normal of the face

fn tie_word(tie: u32, word: u32) -> u32 {
    return glue_ties[TIE_WORDS * tie + word];
}

fn tie_vector(tie: u32, word: u32) -> vec3<f32> {
    let at = TIE_WORDS * tie + word;
    return bitcast<vec3<f32>>(vec3<u32>(glue_ties[at], glue_ties[at + 1u], glue_ties[at + 2u]));
}

struct Part {
    index: u32, // of the node, or of the tie
    weight: f32,
}

// Of the nodes of all ties.
fn part(number: u32) -> Part {
    let at = glue_of.parts + 2u * number;
    return Part(glue_ties[at], bitcast<f32>(glue_ties[at + 1u]));
}

// The first of the ties of a node and the end of them, for tie_of_node.
fn ties_of(node: u32) -> vec2<u32> {
    let at = glue_of.inverse + node;
    return vec2<u32>(glue_ties[at], glue_ties[at + 1u]);
}

fn tie_of_node(number: u32) -> Part {
    let at = glue_of.inverse + glue_of.nodes + 1u + 2u * number;
    return Part(glue_ties[at], bitcast<f32>(glue_ties[at + 1u]));
}
