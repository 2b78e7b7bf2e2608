// The numbers of conjugate gradients, each by one workgroup from the sums of all; see conjugate_gradients.wgsl. STRAIN
// is generated.
const ADDING: u32 = 256u;
var<workgroup> added: array<vec2<f32>, ADDING>;
var<workgroup> largest: array<f32, ADDING>;

// Uniform: all invocations of the workgroup. The sum is known to the first.
fn sum_of_partials(local: u32, count: u32) -> vec2<f32> {
    var sum = vec2<f32>(0.0);
    for (var i = local; i < count; i += ADDING) {
        sum += partials[i];
    }
    added[local] = sum;
    workgroupBarrier();
    for (var width = ADDING / 2u; width > 0u; width /= 2u) {
        if local < width {
            added[local] += added[local + width];
        }
        workgroupBarrier();
    }
    return added[0];
}

// β of the next direction; ends where the residual is small enough.
@compute @workgroup_size(ADDING)
fn turn_direction(@builtin(local_invocation_index) local: u32) {
    let sum = sum_of_partials(local, extent.groups);
    if local != 0u || solve.ended != RUNNING {
        return;
    }
    solve.left = sum.y;
    solve.turn = 0.0;
    if !is_number(sum.x) || !is_number(sum.y) {
        solve.ended = NOT_FINITE;
    } else if solve.iterations > 0u {
        solve.turn = sum.x / solve.product;
        if sum.y <= solve.enough {
            solve.ended = CONVERGED;
        }
    }
    solve.product = sum.x;
}

// How far along p forces are taken: so that no element is strained by more than STRAIN.
@compute @workgroup_size(ADDING)
fn reach_along(@builtin(local_invocation_index) local: u32) {
    var most = 0.0;
    for (var i = local; i < extent.groups; i += ADDING) {
        most = max(most, partials[i].x);
    }
    largest[local] = most;
    workgroupBarrier();
    for (var width = ADDING / 2u; width > 0u; width /= 2u) {
        if local < width {
            largest[local] = max(largest[local], largest[local + width]);
        }
        workgroupBarrier();
    }
    if local == 0u {
        solve.reach = 0.0;
        if largest[0] > 0.0 {
            solve.reach = STRAIN / largest[0];
        }
    }
}

// α; 0 where the solve has ended. Along a first direction that bodies do not resist x is that direction.
@compute @workgroup_size(ADDING)
fn step_length(@builtin(local_invocation_index) local: u32) {
    let curvature = sum_of_partials(local, extent.image_groups).x;
    if local != 0u {
        return;
    }
    solve.length = 0.0;
    if solve.ended != RUNNING {
        return;
    }
    solve.iterations += 1u;
    if !is_number(curvature) {
        solve.ended = NOT_FINITE;
    } else if curvature <= 0.0 {
        solve.ended = NEGATIVE_CURVATURE;
        solve.length = select(0.0, 1.0, solve.iterations == 1u);
    } else {
        solve.length = solve.product / curvature;
    }
}
