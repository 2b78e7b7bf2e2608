// What the kernels of conjugate gradients have in common; twin of src/simulation/implicit/device. An iteration is
// direct, reach_along, displace, the kernels of forces, image_of, step_length, advance, then restrict_residual and
// solve_coarse where there is a coarse level, precondition and turn_direction. Sums are trees in workgroup memory, of
// 64 nodes each, whose results one workgroup adds: in a fixed order, without atomics. RUNNING and what follows is
// generated.
struct Solve {
    product: f32, // r·z
    length: f32, // α: how far x goes along p
    turn: f32, // β: how much of the last p is in the next
    reach: f32, // how far (in units of p) a difference of forces goes
    left: f32, // r·r
    enough: f32, // r·r at which the solve ends
    ended: u32, // how, or RUNNING
    iterations: u32,
}
@group(0) @binding(0) var<storage, read_write> solve: Solve;

struct Extent {
    nodes: u32,
    groups: u32, // workgroups of the nodes of all bodies
    image_groups: u32, // the same, body by body
    aggregates: u32,
    unknowns: u32, // of the coarse level
    stiffness: f32, // share of the stiffness in the operator
}
@group(0) @binding(1) var<uniform> extent: Extent;
@group(0) @binding(2) var<storage, read_write> partials: array<vec2<f32>>; // a workgroup each

var<workgroup> sums: array<vec2<f32>, 64>;

// The sum over a workgroup of 64, which all of them must ask for.
fn sum_of_group(local: u32, own: vec2<f32>) -> vec2<f32> {
    sums[local] = own;
    workgroupBarrier();
    for (var width = 32u; width > 0u; width /= 2u) {
        if local < width {
            sums[local] += sums[local + width];
        }
        workgroupBarrier();
    }
    return sums[0];
}

fn is_number(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}
