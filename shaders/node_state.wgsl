// A node as a load sees it that a scene has in WGSL alone.
struct Node {
    rest_position: vec3<f32>, // where it is at rest (m)
    displacement: vec3<f32>, // at the beginning of the step (m)
    velocity: vec3<f32>, // in the middle of the step before (m/s); 0 in a static analysis
    mass: f32, // kg
    curve: f32, // mean of the load's curve over the step
    time: f32, // at the beginning of the step (s)
    time_step: f32, // Δt (s)
}
