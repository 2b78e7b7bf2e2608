// Central differences in velocity form; twin of systems/integrate.rs. What a body has no column for is a line generated
// in place of a fragment: damped, coefficient_of, accumulate_work, add_internal_work, add_up_internal_work,
// add_to_step, add_step, forget_step.
@group(0) @binding(1) var<storage, read> mass: array<f32>; // that resists acceleration
@group(0) @binding(3) var<storage, read> constrained_axes: array<u32>;
@group(0) @binding(4) var<storage, read_write> displacement: array<f32>;
@group(0) @binding(5) var<storage, read_write> displacement_increment: array<f32>;
@group(0) @binding(6) var<storage, read_write> node_diagnostics: array<atomic<u32>>;

fn step_of(node: u32) -> vec3<f32> {
    let at = 3u * node;
    return vec3<f32>(displacement_increment[at], displacement_increment[at + 1u], displacement_increment[at + 2u]);
}

fn constrained_at(node: u32) -> vec3<bool> {
    return (vec3<u32>(constrained_axes[node]) & vec3<u32>(1u, 2u, 4u)) != vec3<u32>(0u);
}

// Whether a node has no mass, by its bits: comparisons of floats might be turned round, and park what is no number.
fn is_inactive(node: u32) -> bool {
    let bits = bitcast<u32>(mass[node]);
    let size = bits & 0x7fffffffu;
    return size == 0u || (bits != size && size <= 0x7f800000u);
}

// The node's next step (m); constrained axes keep what boundary wrote, nodes without mass are inactive.
fn push(node: u32) -> vec3<f32> {
    let at = 3u * node;
    let inner = internal_force_of(node);
    let outer = external_force_of(node);
    var after = vec3<f32>(0.0);
    if !is_inactive(node) {
        let per_mass = 1.0 / mass[node];
        let before = step_of(node);
        let change = damped(node, before, step.force_factor * ((outer - inner) * per_mass), per_mass);
        let constrained = constrained_at(node);
        after = select(add_to_step(node, before, change), before, constrained);
        accumulate_work(node, before, after, constrained, inner, outer);
        add_internal_work(node, before, after, constrained, inner);
    } else {
        forget_step(node);
    }
    displacement_increment[at] = after.x;
    displacement_increment[at + 1u] = after.y;
    displacement_increment[at + 2u] = after.z;
    return after;
}

fn move_on(node: u32, d: vec3<f32>) {
    let at = 3u * node;
    let before = vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
    let u = add_step(node, before, d, constrained_at(node));
    displacement[at] = u.x;
    displacement[at + 1u] = u.y;
    displacement[at + 2u] = u.z;
    // an exponent of all ones: infinite, or no number; comparisons of floats might be optimized away
    let exponent = vec3<u32>(0x7f800000u);
    if any((bitcast<vec3<u32>>(u) & exponent) == exponent) {
        // the lowest node of the first step in which there is one: later steps find an earlier one noted
        if atomicMin(&node_diagnostics[1], step.number) >= step.number {
            atomicMin(&node_diagnostics[0], node);
        }
    }
}

fn integrate(node: u32) {
    move_on(node, push(node));
}

// The same in two, for bodies with more columns than a kernel may have buffers.
fn integrate_push(node: u32) {
    push(node);
}

fn integrate_move(node: u32) {
    move_on(node, step_of(node));
}
