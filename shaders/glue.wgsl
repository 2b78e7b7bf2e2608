// How far points are off from where they are tied to; twin of systems/glue.rs. After glue_place.wgsl and
// surface_contact_foresee.wgsl, before glue_share.wgsl. Places are differences at rest, which the host rounds once, and
// displacements.
@group(0) @binding(0) var<storage, read> glue_nodes: array<f32>;
@group(0) @binding(0) var<storage, read> tie_state: array<f32>;
@group(0) @binding(0) var<storage, read_write> glue_found: array<f32>;

fn moved(node: u32) -> vec3<f32> {
    let at = NODE_NUMBERS * node;
    return vec3<f32>(glue_nodes[at], glue_nodes[at + 1u], glue_nodes[at + 2u]);
}

fn unit_or_none(v: vec3<f32>) -> vec3<f32> {
    let size = length(v);
    return select(vec3<f32>(0.0), v / max(size, 1e-37), size > 0.0);
}

fn write(tie: u32, number: u32, v: vec3<f32>) {
    let at = FOUND_NUMBERS * tie + number;
    glue_found[at] = v.x;
    glue_found[at + 1u] = v.y;
    glue_found[at + 2u] = v.z;
}

@compute @workgroup_size(64)
fn glue(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i >= glue_of.tie_count {
        return;
    }
    let tie = glue_of.first_tie + i;
    let holds = tie_state[TIE_NUMBERS * tie_word(tie, PLACE)] == HOLDS;
    glue_found[FOUND_NUMBERS * tie + ACTIVE] = select(0.0, 1.0, holds);
    if !holds {
        return;
    }
    var off = tie_vector(tie, OFF_AT_REST);
    for (var number = tie_word(tie, PART); number < tie_word(tie, PART + 1u); number++) {
        let of_tie = part(number);
        off += of_tie.weight * moved(of_tie.index);
    }
    let first = moved(tie_word(tie, CORNERS));
    let side = tie_vector(tie, SIDES) + (moved(tie_word(tie, CORNERS + 1u)) - first);
    let other = tie_vector(tie, SIDES + 3u) + (moved(tie_word(tie, CORNERS + 2u)) - first);
    let along = unit_or_none(side);
    let out = unit_or_none(cross(along, unit_or_none(other)));
    let gap = tie_vector(tie, GAP);
    // a face without area has no frame
    if dot(out, out) > 0.0 {
        off -= gap.x * along + gap.y * cross(out, along) + gap.z * out;
    }
    write(tie, OFF, off);
    write(tie, FORCE, vec3<f32>(0.0));
    write(tie, OUT, out);
}
