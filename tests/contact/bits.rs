//! The same bits on any number of threads, fused or not, and from any step on.

use crate::configurations::scene_of;
use sinew::components::Precision;
use sinew::{BackendChoice, Options, Simulation};

/// A scene on the CPU.
pub fn start(text: &str, precision: Precision, threads: usize) -> Simulation {
    let scene = scene_of(text, std::path::Path::new("."));
    let options = Options { backend: BackendChoice::Cpu, precision, threads, ..Options::default() };
    Simulation::new(&scene, &options).unwrap()
}

/// Displacements of some bodies, as bits.
pub fn bits(simulation: &mut Simulation, bodies: &[&str]) -> Vec<u64> {
    let all = bodies.iter().flat_map(|body| simulation.displacements(body).unwrap());
    all.flat_map(|u| u.to_array().map(f64::to_bits)).collect()
}

/// Asks for the same bits at the time `end` (s) on one thread and on three, and on two with nothing fused, and after a
/// pause at `pause` (s) from where the simulation is taken back seven steps; `seen` looks at what is there at both
/// times, in this order: paused, ended.
pub fn bits_do_not_depend(text: &str, bodies: &[&str], [pause, end]: [f64; 2], seen: [fn(&mut Simulation); 2]) {
    for precision in [Precision::F32, Precision::F64] {
        let mut one = start(text, precision, 1);
        one.advance_to(end).unwrap();
        seen[1](&mut one);
        let (steps, wanted) = (one.step_count(), bits(&mut one, bodies));
        let unfused = text.replace("duration", "fuse: false, duration");
        for (threads, text) in [(3, text), (2, &unfused)] {
            let mut other = start(text, precision, threads);
            other.advance(steps).unwrap();
            assert!(bits(&mut other, bodies) == wanted, "{threads} threads, {precision:?}");
        }
        let mut paused = start(text, precision, 1);
        paused.advance_to(pause).unwrap();
        seen[0](&mut paused);
        let kept = paused.snapshot().unwrap();
        paused.advance(7).unwrap();
        paused.restore(&kept).unwrap();
        let left = steps - paused.step_count();
        paused.advance(left).unwrap();
        assert!(bits(&mut paused, bodies) == wanted, "resumed, {precision:?}");
    }
}
