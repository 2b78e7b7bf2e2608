use super::*;

#[test]
fn observations_follow_their_times_and_not_rounded_steps() {
    // 20 intervals in 609 steps: not a whole number of steps each
    let cadence = Cadence::new(0.05, 1.0 / 609.0);
    let mut due = vec![0];
    while due[due.len() - 1] < 609 {
        due.push(cadence.next_after(due[due.len() - 1]));
    }
    assert_eq!((due.len(), due[1], due[20]), (21, 31, 609));
    assert!((0..=609).all(|step| cadence.is_due(step) == due.contains(&step)));
    assert_eq!(cadence.count(609), 21);
}

#[test]
fn observations_keep_their_times_when_the_step_changes() {
    let (mut cadence, mut time, mut step) = (Cadence::new(0.05, 0.01), 0.0, 0_u64);
    let mut times = Vec::new();
    for (steps, time_step) in [(7, 0.01), (40, 0.003), (30, 0.02)] {
        cadence.change_step(step, time_step);
        for _ in 0..steps {
            (step, time) = (step + 1, time + time_step);
            if cadence.is_due(step) {
                times.push((time, time_step));
            }
        }
    }
    // each at the first step that is not earlier than its time
    assert_eq!(times.len(), (time / 0.05 + 1e-9) as usize);
    for (number, (time, time_step)) in times.iter().enumerate() {
        let due = 0.05 * (number + 1) as f64;
        assert!(*time >= due - 1e-9 && time - due < time_step + 1e-9, "{number}: {time}, due {due}");
    }
}

#[test]
fn an_interval_below_a_step_is_every_step_and_none_is_never() {
    assert!((0..10).all(|step| Cadence::new(1e-9, 1.0).is_due(step)));
    assert!((0..10).all(|step| !Cadence::default().is_due(step)));
    assert_eq!(Cadence::default().next_after(7), u64::MAX);
}
