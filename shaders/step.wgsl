// What is the same for all rows of a step; twin of src/backend/step.rs. SIGNALS is generated, and where `step` is: in a
// uniform, or where many_steps.wgsl says.
struct Step {
    force_factor: f32, // Δt times the time between the middles of two steps, times the force scale (s²)
    half_step: f32, // half the time between the middles, in the first step Δt/2 (s)
    after_first: f32, // 1, in the first step 0
    rate: f32, // 1/Δt (1/s)
    number: u32, // index of the step, from 0; stops at the largest number
    zero: u32, // always 0, which no compiler knows
    relaxation: f32, // a = cΔt/2 of a static analysis
    work_factor: f32, // share of a step's work that is counted: the time between the middles over Δt
    observed: u32, // 1 in steps after which somebody may look at forces
    trying: u32, // 1 where forces are only tried, which leave histories as they are
    time: f32, // at the beginning of the step (s)
    time_step: f32, // Δt (s)
    signals: array<vec4<f32>, SIGNALS>,
}
