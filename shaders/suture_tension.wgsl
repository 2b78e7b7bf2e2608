// How hard threads pull, and which tear, a thread a suture; twin of systems/suture_tension.rs. After
// suture_tension_place.wgsl, before suture_tension_pull.wgsl.
struct ThreadsOf {
    first: u32, // of the threads whose first end the body has
    count: u32,
    relaxed: u32, // whether it is a static analysis
}
@group(0) @binding(0) var<uniform> threads: ThreadsOf;
@group(0) @binding(0) var<storage, read> suture_threads: array<u32>;
@group(0) @binding(0) var<storage, read> suture_places: array<f32>;
@group(0) @binding(0) var<storage, read_write> suture_pulls: array<f32>; // forces on first ends (N)
@group(0) @binding(0) var<storage, read_write> suture_state: array<f32>;

const THREAD_WORDS: u32 = 11u;
const ENDS: u32 = 0u; // places of words of a thread
const WAY: u32 = 2u; // from one end to the other at rest (m)
const STIFFNESS: u32 = 5u;
const LENGTH: u32 = 6u;
const TIGHTEN: u32 = 7u;
const STRENGTH: u32 = 8u;
const SIGNAL: u32 = 9u;
const PLACE: u32 = 10u;

fn number(thread: u32, word: u32) -> f32 {
    return bitcast<f32>(suture_threads[THREAD_WORDS * thread + word]);
}

fn end_of(thread: u32, side: u32) -> vec4<f32> {
    let at = 4u * suture_threads[THREAD_WORDS * thread + ENDS + side];
    return vec4<f32>(suture_places[at], suture_places[at + 1u], suture_places[at + 2u], suture_places[at + 3u]);
}

fn pull(thread: u32, force: vec3<f32>) {
    suture_pulls[3u * thread] = force.x;
    suture_pulls[3u * thread + 1u] = force.y;
    suture_pulls[3u * thread + 2u] = force.z;
}

@compute @workgroup_size(64)
fn suture_tension(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= threads.count {
        return;
    }
    let thread = threads.first + i;
    let state = SUTURE_NUMBERS * suture_threads[THREAD_WORDS * thread + PLACE];
    if suture_state[state] != HOLDS {
        pull(thread, vec3<f32>(0.0));
        return;
    }
    let one = end_of(thread, 0u);
    let other = end_of(thread, 1u);
    let at_rest = vec3<f32>(number(thread, WAY), number(thread, WAY + 1u), number(thread, WAY + 2u));
    let way = at_rest + (other.xyz - one.xyz);
    let size = length(way);
    let factor = step.signals[suture_threads[THREAD_WORDS * thread + SIGNAL]].x;
    let rest = max(number(thread, LENGTH) - number(thread, TIGHTEN) * factor, 0.0);
    let stiffness = number(thread, STIFFNESS);
    let whole = stiffness * max(size - rest, 0.0);
    let left = min(one.w, other.w);
    let tension = left * whole;
    var becomes = HOLDS;
    // in a static analysis nothing tears
    if threads.relaxed == 0u {
        if left <= 0.0 {
            becomes = CAME_OUT;
        } else if tension >= number(thread, STRENGTH) {
            becomes = TORE;
        }
    }
    let pulls = becomes == HOLDS && tension > 0.0;
    pull(thread, select(vec3<f32>(0.0), way * (tension / max(size, 1e-37)), pulls));
    suture_state[state + 2u] = select(0.0, tension, becomes == HOLDS);
    // of what comes out length and energy are those of when it was last drawn
    if becomes != CAME_OUT {
        suture_state[state + 3u] = size;
        suture_state[state + 4u] = 0.5 * tension * whole / stiffness;
    }
    if becomes != HOLDS {
        suture_state[state] = becomes;
        suture_state[state + 1u] = step.time;
    }
}
