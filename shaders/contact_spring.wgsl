// The gap (m) that the kinematic law of contact would have to close for the force of a spring, outside by so much (m),
// going outwards by so much in a step (m); twin of ContactSpring in src/components/contact.rs.
fn spring_gap(share: f32, damping: f32, outside: f32, outwards: f32) -> f32 {
    if outside >= 0.0 {
        return 0.0;
    }
    return min(share * outside + 2.0 * damping * sqrt(share) * outwards, 0.0);
}
