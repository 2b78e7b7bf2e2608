// Loads look at velocities: those of a body at w + ε p, as displacements of a step. STEP_SLOPE is generated.
@group(0) @binding(11) var<storage, read> place_step: array<f32>; // those at w (m)
@group(0) @binding(12) var<storage, read_write> displacement_increment: array<f32>;

fn displace_velocity(own: u32, at: u32, moved: f32) {
    displacement_increment[own] = place_step[at] + STEP_SLOPE * moved;
}
