use super::*;
use crate::components::Clock;

/// A node that stays where it is, and one that is told to go along x, ever slower, and swings along y: where it is
/// after so many steps.
fn place(step: u32) -> [f64; 3] {
    let step = f64::from(step);
    [1.0 - (-step / 3.0).exp(), 0.02 * step.sin(), 0.0]
}

/// What is there when a step begins: displacements, and steps; along x the next one is already written.
fn columns(step: u32) -> [Vec<f64>; 2] {
    let [last, now, next] = [step.saturating_sub(1), step, step + 1].map(place);
    let went = [next[0] - now[0], now[1] - last[1], now[2] - last[2]];
    [[[0.0; 3], now], [[0.0; 3], went]].map(|nodes| nodes.concat())
}

/// From whenever it is counted: never less than what nodes have moved against each other.
#[test]
fn what_is_told_is_counted_from_its_first_step_on() {
    let cpu = Cpu::new(1, 0, Default::default());
    let clock = Clock::with_step(0.1);
    for marked in 0..20 {
        let mut motion = Motion::of(&[(0, 0), (0, 1)]);
        for step in 0..40 {
            let [u, went] = columns(step);
            motion.follow(&|_| Some([&u[..], &went[..]]), &clock, &cpu);
            let moved = |since: u32| (0..3).map(|axis| (place(step)[axis] - place(since)[axis]).powi(2)).sum::<f64>();
            if step == marked {
                for mark in [&mut motion.lists, &mut motion.shortlists] {
                    *mark = Mark { u: Some(Reals::F64(u.clone())), moved: 0.0 };
                }
                motion.gone = 0.0;
            } else if step > marked {
                let moved = moved(marked).sqrt();
                let counted = [motion.lists.moved, motion.shortlists.moved, motion.gone];
                assert!(counted.iter().all(|counted| *counted >= moved), "{marked} to {step}: {counted:?}, {moved}");
                // and not much more
                assert!(counted[0] <= 2.0 * moved + 0.5, "{marked} to {step}: {counted:?}, {moved}");
            }
        }
    }
}
