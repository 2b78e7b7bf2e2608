// The share of the mouth that the faces close which suction_mouth.wgsl has marked, and the pressure that follows it.
// One workgroup; criterion_due is generated, the mouth is in suction_tool.wgsl.
@group(0) @binding(1) var<storage, read_write> suction_marks: array<u32>;
@group(0) @binding(2) var<storage, read> parts: array<u32>; // six each: nodes, face, weight
@group(0) @binding(3) var<storage, read> rest_points: array<f32>; // of nodes, from the reference (m)
@group(0) @binding(4) var<storage, read> displacement: array<f32>;
@group(0) @binding(5) var<storage, read_write> suction_pressure: array<f32>; // (Pa), and the share

var<workgroup> sums: array<f32, 256>;

fn place_of(node: u32) -> vec3<f32> {
    let at = 3u * node;
    return vec3<f32>(rest_points[at], rest_points[at + 1u], rest_points[at + 2u])
        + vec3<f32>(displacement[at], displacement[at + 1u], displacement[at + 2u]);
}

@compute @workgroup_size(256)
fn suction_pressure_of(@builtin(local_invocation_index) lane: u32) {
    if criterion_due() {
        let axis = vec3<f32>(
            step.signals[mouth.pose].z, step.signals[mouth.pose + 1u].z, step.signals[mouth.pose + 2u].z);
        var sum = 0.0;
        for (var part = lane; part < mouth.parts; part += 256u) {
            let at = 6u * part;
            let share = bitcast<f32>(suction_marks[mouth.first + parts[at + 4u]]);
            if share > 0.0 {
                let across = place_of(parts[at + 2u]) - place_of(parts[at]);
                let other = place_of(parts[at + 3u]) - place_of(parts[at + 1u]);
                sum += share * bitcast<f32>(parts[at + 5u]) * 0.5 * dot(cross(across, other), axis);
            }
        }
        sums[lane] = sum;
        workgroupBarrier();
        for (var half = 128u; half > 0u; half /= 2u) {
            if lane < half {
                sums[lane] += sums[lane + half];
            }
            workgroupBarrier();
        }
        if lane == 0u {
            suction_pressure[mouth.numbers + 1u] = clamp(sums[0] / mouth.area, 0.0, 1.0);
        }
    }
    if lane == 0u {
        let share = suction_pressure[mouth.numbers + 1u];
        var follows = 1.0;
        if mouth.delay > step.time_step {
            follows = step.time_step / mouth.delay;
        }
        let now = suction_pressure[mouth.numbers];
        suction_pressure[mouth.numbers] = now + follows * (step.signals[mouth.pressure].x * share * share - now);
    }
}
