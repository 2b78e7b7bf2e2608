//! What a scene asks for in time, held against its steps: how much a run would write, and courses finer than steps.

use crate::components::{Cadence, Clock};
use crate::scene::limits::{FRAMES, ROWS};
use crate::scene::schema::Curve;
use crate::scene::syntax::Path;
use crate::scene::{Diagnostics, SceneFile};

/// What is written at whole steps, where tables have rows at times.
const FILES: &str = "VTU files";

/// Complains of outputs that no disk should be asked for; `steps` is what the scene lasts.
pub(super) fn check(scene: &SceneFile, clock: &Clock, steps: u64, diagnostics: &mut Diagnostics) {
    let scene = &scene.scene;
    // a static analysis observes while loads grow
    let steps = clock.relaxation.map_or(steps, |relaxation| (1.0 / relaxation.ramp_rate).round() as u64);
    let mut at_most = |most: u64, what: &str, every: f64, path: Path| {
        let cadence = Cadence::new(every, clock.time_step);
        let found = if what == FILES { cadence.count(steps) } else { cadence.rows(steps) };
        if found > most {
            let message = format!("a run would write {found} {what}");
            diagnostics.error_at(path, message).note(format!("at most {most} are allowed: write them less often"));
        }
    };
    let output = Path::default().name("output");
    at_most(FRAMES, FILES, scene.fields_every(), output.name("fields_every"));
    if let Some(every) = scene.output.energies_every {
        at_most(ROWS, "rows of energies", every, output.name("energies_every"));
    }
    for (name, probe) in &scene.probes {
        let every = probe.every.unwrap_or_else(|| scene.fields_every());
        at_most(ROWS, "rows of a probe", every, Path::default().name("probes").name(name).name("every"));
    }
}

/// Warns of courses in time that are finer than steps.
pub(super) fn check_curves(scene: &SceneFile, clock: &Clock, diagnostics: &mut Diagnostics) {
    if clock.relaxation.is_some() {
        return;
    }
    let scene = &scene.scene;
    let mut check = |curve: &Curve, path: Path, what_of_it: &str| {
        let Some(finest) = curve.finest().filter(|finest| *finest < clock.time_step) else { return };
        let message = format!("the curve changes within {finest:.3e} s, and a step is {:.3e} s", clock.time_step);
        diagnostics.warn_at(path.name("curve"), message).note(what_of_it);
    };
    let note = "its impulse is right, but it acts as a mean over a step; a smaller `step` shows more of it";
    for (number, load) in scene.loads.iter().enumerate() {
        check(load.curve(), Path::default().name("loads").index(number), note);
    }
    for (name, system) in &scene.systems {
        check(&system.curve, Path::default().name("systems").name(name), note);
    }
    for (number, constraint) in scene.constraints.iter().enumerate() {
        let note = "nodes are put where it is at the ends of steps: what happens between them is lost; a smaller `step` shows \
                    more of it";
        let path = Path::default().name("constraints").index(number);
        constraint.curve().into_iter().for_each(|curve| check(curve, path.clone(), note));
    }
}
