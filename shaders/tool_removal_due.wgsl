// Elements that tool_removal_choice.wgsl has chosen are due. criterion_due and step_that_comes are generated.
struct Chosen {
    count: u32, // elements of the block
    chosen: u32, // where the chosen are told in tool_reach: how many, then their numbers
}
@group(0) @binding(0) var<uniform> due: Chosen;
@group(0) @binding(1) var<storage, read> tool_reach: array<u32>;
@group(0) @binding(2) var<storage, read_write> removal_step: array<u32>;
@group(0) @binding(3) var<storage, read> numbers: array<u32>;

@compute @workgroup_size(64)
fn tool_removal_due(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let element = row(id, groups);
    if element >= due.count || !criterion_due() || numbers[element] == 0xffffffffu {
        return;
    }
    for (var i = 1u; i <= tool_reach[due.chosen]; i++) {
        if tool_reach[due.chosen + i] == numbers[element] {
            removal_step[element] = step_that_comes();
        }
    }
}
