//! How far a run is: a bar where somebody looks, else a line now and then.

use super::failure::Failure;
use super::{Outcome, interrupt, terminal, wording};
use indicatif::{ProgressBar, ProgressStyle};
use sinew::{Equilibrium, Simulation};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Time between two lines where there is no terminal.
const QUIET: Duration = Duration::from_secs(10);

/// Progress of a run over simulated time.
pub struct Progress {
    bar: Option<ProgressBar>,
    started: Instant,
    told: Instant,
    duration: f64,
    /// The largest residual with all loads, from which a static analysis comes down.
    first_residual: f64,
}

impl Progress {
    /// Begins; `duration` is the simulated time (s), `steps` how many there are, if it is known (not to rest).
    pub fn begin(steps: u64, duration: f64, to_rest: bool) -> Self {
        let steps = if to_rest { 100 } else { steps };
        let bar = terminal::is_interactive().then(|| bar(steps, "{bar:30} {percent:>3} %  {msg}"));
        Self { bar, started: Instant::now(), told: Instant::now(), duration, first_residual: 0.0 }
    }

    /// Tells how far a static analysis is: the residual after so many steps.
    pub fn tell_residual(&mut self, steps: u64, found: &Equilibrium) {
        if found.residual.is_finite() {
            self.first_residual = self.first_residual.max(found.residual);
        }
        if self.bar.is_none() && self.told.elapsed() < QUIET {
            return;
        }
        // a residual falls by the same factor in the same time
        let fallen = (self.first_residual / found.residual).ln() / (self.first_residual / found.tolerance).ln();
        let share = if fallen.is_finite() { fallen.clamp(0.0, 1.0) } else { 0.0 };
        let at = format!("step {steps}, residual {:.1e}, sought {:.0e}", found.residual, found.tolerance);
        match &self.bar {
            Some(bar) => {
                bar.set_message(at);
                bar.set_position((100.0 * share) as u64);
            }
            None => terminal::note(&format!("{:3.0} %  {at}\n", 100.0 * share)),
        }
        self.told = Instant::now();
    }

    /// Tells how far it is: steps done of all, and the simulated time (s).
    pub fn tell(&mut self, done: u64, all: u64, time: f64) {
        if self.bar.is_none() && self.told.elapsed() < QUIET {
            return;
        }
        let elapsed = self.started.elapsed();
        let left = elapsed.mul_f64((all.saturating_sub(done)) as f64 / done.max(1) as f64);
        let speed = wording::speed(elapsed.as_secs_f64() / time.max(f64::MIN_POSITIVE));
        let at = format!("t = {time:.4} of {} s, {speed}, {} left", self.duration, wording::duration(left));
        match &self.bar {
            Some(bar) => {
                bar.set_message(at);
                bar.set_length(all);
                bar.set_position(done);
            }
            None => terminal::note(&format!("{:3.0} %  {at}\n", 100.0 * done as f64 / all.max(1) as f64)),
        }
        self.told = Instant::now();
    }

    /// Takes the bar away.
    pub fn end(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Brings bodies to rest where a scene begins so, tells how far that is, and ends where somebody wants that.
///
/// # Errors
/// As [`Simulation::settle`]; that it was interrupted.
pub fn settle(simulation: &mut Simulation) -> Outcome {
    let mut progress = Progress::begin(0, 0.0, true);
    let settled = simulation.settle_telling(|steps, found| {
        progress.tell_residual(steps, found);
        if interrupt::is_asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    progress.end();
    match settled? {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(Failure::Interrupted),
    }
}

/// Shows that something goes on whose end cannot be told, while `work` is done.
pub fn during<T>(what: &str, work: impl FnOnce() -> T) -> T {
    if !terminal::is_interactive() {
        return work();
    }
    let spinner = ProgressBar::new_spinner().with_message(what.to_string());
    spinner.enable_steady_tick(Duration::from_millis(120));
    let done = work();
    spinner.finish_and_clear();
    done
}

/// A bar over so many steps.
pub fn bar(steps: u64, template: &str) -> ProgressBar {
    let bar = ProgressBar::new(steps);
    match ProgressStyle::with_template(template) {
        Ok(style) => bar.with_style(style.progress_chars("━╸ ")),
        Err(_) => bar,
    }
}
