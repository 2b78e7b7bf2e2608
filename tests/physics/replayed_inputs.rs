//! Recordings of inputs that begin with a state in which some had been set.

use crate::configurations::configurations;
use crate::grids::bits;
use crate::inputs::{PUSH, TOOL, cube, followed};
use sinew::{InputRecording, Simulation};

/// What was set when the recording began, and set anew before a step was taken.
#[test]
fn a_replay_forgets_what_waited_in_the_state_that_it_begins_with() {
    for run in configurations() {
        let text = cube(&followed(PUSH, TOOL), "");
        let mut hand = run.start(&text);
        hand.advance(10).unwrap();
        hand.set_input("tool", -0.5).unwrap();
        hand.set_input("push", -0.75).unwrap();
        let state = hand.snapshot().unwrap();
        hand.record_inputs();
        hand.set_input("tool", 1.0).unwrap();
        hand.advance(30).unwrap();
        let recording = hand.stop_recording_inputs().unwrap();
        let mut again = run.start(&text);
        again.restore(&state).unwrap();
        again.replay_inputs(&recording).unwrap();
        again.advance(30).unwrap();
        let targets =
            |simulation: &Simulation| simulation.inputs().iter().map(|input| input.target).collect::<Vec<_>>();
        assert!(targets(&again).contains(&1.0) && targets(&again).contains(&-0.75), "{:?}", again.inputs());
        assert_eq!(targets(&again), targets(&hand), "{}", run.name);
        assert!(bits(&mut again, "b") == bits(&mut hand, "b"), "{}: other bits", run.name);
        // nothing that is replayed takes nothing back
        again.restore(&state).unwrap();
        again.replay_inputs(&InputRecording { from: again.step_count(), ..InputRecording::default() }).unwrap();
        again.advance(1).unwrap();
        assert!(targets(&again).contains(&-0.5), "{:?}", again.inputs());
    }
}
