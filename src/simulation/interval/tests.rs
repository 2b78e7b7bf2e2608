use super::*;

#[test]
fn runs_keep_their_times_to_a_step_when_the_step_changes() {
    let mut interval = RunInterval::new(10, Some(0.1));
    assert!((0..25).all(|step| interval.is_due(step) == (step % 10 == 0)));
    // half way to the run at 0.3 s the steps become half as long
    interval.change_step(25, 0.01, 0.005);
    assert_eq!((interval.next_after(25), interval.next_after(35)), (35, 55));
    assert!(!interval.is_due(30) && interval.is_due(35));
    let mut steps = RunInterval::new(3, None);
    steps.change_step(4, 0.01, 0.001);
    assert!(steps.is_due(6) && !steps.is_due(5));
}
