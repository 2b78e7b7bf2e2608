// How contacts between surfaces lie: words that do not depend on what meets, then nodes and their signed weights, as
// many as PARTS, which is generated.
@group(0) @binding(0) var<storage, read_write> surface_contacts: array<u32>;

const NORMAL: u32 = 0u; // places of words of a contact
const GAP: u32 = 3u;
const FRICTION: u32 = 4u;
const SLIP: u32 = 5u;
const PRESSING: u32 = 8u;
const RUBBING: u32 = 9u;
const SLIDING: u32 = 12u;
const YIELDS: u32 = 13u;
const YIELDS_ALONG: u32 = 14u;
const CHANGE: u32 = 15u;
const ACTIVE: u32 = 18u;
const PART: u32 = 19u;
const CONTACT_WORDS: u32 = PART + 2u * PARTS;
const BY_STEP: u32 = 1u; // what a contact acts by: the step that is predicted, or a spring
const BY_SPRING: u32 = 2u;

const NODE_NUMBERS: u32 = 16u; // of a node: place, next step, last step, response, last step for work, shares
const NEXT: u32 = 3u;
const LAST: u32 = 6u;
const RESPONSE: u32 = 9u;
const WENT: u32 = 12u;
const SHARE: u32 = 15u;

fn number(contact: u32, word: u32) -> f32 {
    return bitcast<f32>(surface_contacts[CONTACT_WORDS * contact + word]);
}

fn vector(contact: u32, word: u32) -> vec3<f32> {
    let at = CONTACT_WORDS * contact + word;
    return bitcast<vec3<f32>>(vec3<u32>(surface_contacts[at], surface_contacts[at + 1u], surface_contacts[at + 2u]));
}

fn set_number(contact: u32, word: u32, value: f32) {
    surface_contacts[CONTACT_WORDS * contact + word] = bitcast<u32>(value);
}

fn set_vector(contact: u32, word: u32, value: vec3<f32>) {
    let at = CONTACT_WORDS * contact + word;
    let bits = bitcast<vec3<u32>>(value);
    surface_contacts[at] = bits.x;
    surface_contacts[at + 1u] = bits.y;
    surface_contacts[at + 2u] = bits.z;
}

fn is_active(contact: u32) -> bool {
    return surface_contacts[CONTACT_WORDS * contact + ACTIVE] != 0u;
}

fn part_node(contact: u32, part: u32) -> u32 {
    return surface_contacts[CONTACT_WORDS * contact + PART + part];
}

fn part_weight(contact: u32, part: u32) -> f32 {
    return number(contact, PART + PARTS + part);
}
