// What becomes of ties, a thread a tie: their forces, what they take, and which break. Twin of systems/glue.rs, after
// glue_apply.wgsl.
@group(0) @binding(0) var<storage, read> glue_nodes: array<f32>;
@group(0) @binding(0) var<storage, read_write> glue_found: array<f32>;
@group(0) @binding(0) var<storage, read_write> tie_state: array<f32>;

fn is_exceeded(tie: u32, force: vec3<f32>, out: vec3<f32>) -> bool {
    let bounded = tie_word(tie, STRENGTH);
    let first = bitcast<f32>(tie_word(tie, STRENGTH + 1u));
    let second = bitcast<f32>(tie_word(tie, STRENGTH + 2u));
    if bounded == 1u {
        return length(force) >= first;
    }
    if bounded == 2u {
        // what is pulled off is held back towards the face
        let pulled = dot(force, out);
        let off = max(-pulled, 0.0) * first;
        let along = length(force - pulled * out) * second;
        return off * off + along * along >= 1.0;
    }
    return false;
}

// The point's last step against its face.
fn last_step(tie: u32) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var number = tie_word(tie, PART); number < tie_word(tie, PART + 1u); number++) {
        let of_tie = part(number);
        let at = NODE_NUMBERS * of_tie.index + WENT;
        sum += of_tie.weight * vec3<f32>(glue_nodes[at], glue_nodes[at + 1u], glue_nodes[at + 2u]);
    }
    return sum;
}

// What is counted of the work of the last step's forces: see systems/glue.rs.
fn work_factor_before() -> f32 {
    return (2.0 * step.work_factor - 1.0) * select(1.0, 0.5, step.number == 1u);
}

@compute @workgroup_size(64)
fn glue_note(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= glue_of.tie_count {
        return;
    }
    let tie = glue_of.first_tie + i;
    let at = FOUND_NUMBERS * tie;
    if glue_found[at + ACTIVE] == 0.0 {
        return;
    }
    let state = TIE_NUMBERS * tie_word(tie, PLACE);
    let force_before = vec3<f32>(tie_state[state + 2u], tie_state[state + 3u], tie_state[state + 4u]);
    var force = vec3<f32>(glue_found[at + FORCE], glue_found[at + FORCE + 1u], glue_found[at + FORCE + 2u]);
    let out = vec3<f32>(glue_found[at + OUT], glue_found[at + OUT + 1u], glue_found[at + OUT + 2u]);
    // in a static analysis nothing breaks, and no work is counted
    if glue_of.relaxed == 0u {
        if is_exceeded(tie, force, out) {
            tie_state[state] = BROKE;
            tie_state[state + 1u] = step.time;
            glue_found[at + ACTIVE] = 0.0;
            force = vec3<f32>(0.0);
        }
        // what a step comes to is only known after it: of the last one, both ends have their forces now
        let forces = work_factor_before() * force_before + step.work_factor * force;
        tie_state[state + 5u] -= 0.5 * dot(forces, last_step(tie));
    }
    for (var k = 0u; k < 3u; k++) {
        tie_state[state + 2u + k] = force[k];
    }
}
