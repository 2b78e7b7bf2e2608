use super::*;

fn throttle_with(seconds: f64) -> SubmissionThrottle {
    let mut throttle = SubmissionThrottle::default();
    throttle.seconds_per_step.insert(Arc::from([KernelId(3)]), seconds);
    throttle
}

#[test]
fn a_submission_stays_under_a_tenth_of_a_second() {
    assert_eq!(throttle_with(0.01).batch(&[KernelId(3)]), 10);
}

#[test]
fn a_window_waits_for_half_a_frame_at_most() {
    let shared = SubmissionThrottle { shared: true, ..throttle_with(0.001) };
    assert_eq!(shared.batch(&[KernelId(3)]), 8);
}

#[test]
fn a_submission_has_one_step_at_least_and_256_at_most() {
    assert_eq!(throttle_with(7.0).batch(&[KernelId(3)]), 1);
    assert_eq!(throttle_with(0.0).batch(&[KernelId(3)]), 256);
}

#[test]
fn kernels_never_measured_start_with_one_step() {
    assert_eq!(throttle_with(0.0).batch(&[KernelId(4)]), 1);
}
