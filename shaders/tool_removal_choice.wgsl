// What a tool takes in, and which elements go for it: the second part of tool_removal.wgsl. One workgroup;
// criterion_due and CRITERION_STEPS are generated.
struct Choice {
    rate: u32, // slot of the volume a second (m³/s)
    intake: u32, // where the tool's numbers begin in tool_intake
    burst: u32, // elements that go at most
    chosen: u32, // where they are told in tool_reach: how many, then their numbers
    largest: f32, // volume of the largest element that may go (m³)
}
@group(0) @binding(0) var<uniform> choice: Choice;
@group(0) @binding(1) var<storage, read_write> tool_intake: array<f32>;
@group(0) @binding(2) var<storage, read_write> tool_reach: array<u32>;

var<workgroup> best: array<vec3<u32>, 64>; // key, number, place in the list
var<workgroup> is_over: u32;

// Nearest first, of equally near ones that of the lower number.
fn first_of(a: vec3<u32>, b: vec3<u32>) -> vec3<u32> {
    return select(b, a, a.x < b.x || (a.x == b.x && a.y <= b.y));
}

@compute @workgroup_size(64)
fn tool_removal_choice(@builtin(local_invocation_index) lane: u32) {
    // nothing is given back
    let of_step = max(step.signals[choice.rate].x * step.time_step, 0.0);
    if lane == 0u && tool_intake[choice.intake + 1u] != 0.0 {
        tool_intake[choice.intake] += of_step;
    }
    if !criterion_due() {
        return;
    }
    let found = tool_reach[0];
    if lane == 0u {
        tool_reach[choice.chosen] = 0u;
        tool_intake[choice.intake + 1u] = select(0.0, 1.0, found > 0u);
        is_over = select(0u, 1u, found == 0u || of_step <= 0.0);
    }
    for (var turn = 0u; turn < choice.burst; turn++) {
        if workgroupUniformLoad(&is_over) == 1u {
            break;
        }
        var own = vec3<u32>(0xffffffffu);
        for (var i = lane; i < found; i += 64u) {
            own = first_of(own, vec3<u32>(tool_reach[1u + 3u * i], tool_reach[2u + 3u * i], i));
        }
        best[lane] = own;
        workgroupBarrier();
        if lane == 0u {
            for (var i = 1u; i < 64u; i++) {
                own = first_of(own, best[i]);
            }
            is_over = 1u;
            if own.z != 0xffffffffu {
                let volume = bitcast<f32>(tool_reach[3u + 3u * own.z]);
                if tool_intake[choice.intake] >= volume {
                    tool_intake[choice.intake] -= volume;
                    let count = tool_reach[choice.chosen] + 1u;
                    tool_reach[choice.chosen] = count;
                    tool_reach[choice.chosen + count] = own.y;
                    // not again
                    tool_reach[1u + 3u * own.z] = 0xffffffffu;
                    tool_reach[2u + 3u * own.z] = 0xffffffffu;
                    is_over = 0u;
                }
            }
        }
        storageBarrier();
    }
    if lane == 0u {
        // nothing is left in reach: what is more was no tissue
        if tool_reach[choice.chosen] == found {
            let most = choice.largest + f32(CRITERION_STEPS) * of_step;
            tool_intake[choice.intake] = min(tool_intake[choice.intake], most);
        }
        tool_reach[0] = 0u;
    }
}
