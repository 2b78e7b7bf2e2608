// Finds elements that pass a limit and makes the coming step the one before which they go. LIMITS, CRITERION_STEPS and
// passes_a_limit are generated from the block's criteria.
@group(0) @binding(0) var<uniform> limits: array<vec4<f32>, LIMITS>;
@group(0) @binding(1) var<storage, read> rest_shape: array<f32>;
@group(0) @binding(2) var<storage, read> alive: array<u32>;
@group(0) @binding(3) var<storage, read_write> removal_step: array<u32>;
@group(0) @binding(4) var<storage, read> criteria: array<u32>; // bit i: criterion i concerns the element

// Tangent, cosine and sine of the rotation that makes the entry between two axes of a symmetric matrix zero.
fn rotation(app: f32, aqq: f32, apq: f32) -> vec3<f32> {
    if abs(apq) <= 1e-12 * (abs(app) + abs(aqq)) {
        return vec3<f32>(0.0, 1.0, 0.0);
    }
    let theta = (aqq - app) / (2.0 * apq);
    let t = select(-1.0, 1.0, theta >= 0.0) / (abs(theta) + sqrt(theta * theta + 1.0));
    let c = 1.0 / sqrt(t * t + 1.0);
    return vec3<f32>(t, c, t * c);
}

// The largest principal stretch, by Jacobi's rotations: an arc cosine of f32 loses half the digits.
fn largest_stretch(strain: Sym3) -> f32 {
    var d = strain.diagonal;
    var o = strain.others;
    for (var sweep = 0u; sweep < 5u; sweep++) {
        let a = rotation(d.x, d.y, o.x);
        d = vec3<f32>(d.x - a.x * o.x, d.y + a.x * o.x, d.z);
        o = vec3<f32>(0.0, a.z * o.z + a.y * o.y, a.y * o.z - a.z * o.y);
        let b = rotation(d.y, d.z, o.y);
        d = vec3<f32>(d.x, d.y - b.x * o.y, d.z + b.x * o.y);
        o = vec3<f32>(b.y * o.x - b.z * o.z, 0.0, b.z * o.x + b.y * o.z);
        let c = rotation(d.x, d.z, o.z);
        d = vec3<f32>(d.x - c.x * o.z, d.y, d.z + c.x * o.z);
        o = vec3<f32>(c.y * o.x - c.z * o.y, c.z * o.x + c.y * o.y, 0.0);
    }
    return sqrt(max(0.0, 1.0 + 2.0 * max(d.x, max(d.y, d.z))));
}

// The largest of all points.
fn stretch_of(e: Element) -> f32 {
    var largest = 0.0;
    for (var point = 0u; point < POINTS; point++) {
        largest = max(largest, largest_stretch(elastic_kinematics(at_point(e, point).gradient).green_strain));
    }
    return largest;
}

// J: mean over the points.
fn volume_ratio_of(e: Element) -> f32 {
    var sum = 0.0;
    var volume = 0.0;
    for (var point = 0u; point < POINTS; point++) {
        let at = at_point(e, point);
        sum += at.volume * elastic_kinematics(at.gradient).true_j;
        volume += at.volume;
    }
    return sum / volume;
}

@compute @workgroup_size(64)
fn criterion(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let element = row(id, groups);
    let coming = max(step.number, step.number + 1u);
    if element >= block.count || coming % CRITERION_STEPS != 0u || alive[element] == 0u || criteria[element] == 0u {
        return;
    }
    if passes_a_limit(element, criteria[element], element_of(element)) {
        removal_step[element] = min(removal_step[element], coming);
    }
}
