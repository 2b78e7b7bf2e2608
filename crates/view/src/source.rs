//! What is seen: a simulation that runs, or a run that is over.

use crate::playback::Playback;
use sinew::Options;
#[cfg(not(target_arch = "wasm32"))]
use sinew::driver::Driver;
use sinew::driver::{Command, FrameDriver, State};
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

/// Where states come from.
pub enum Source {
    /// A simulation.
    Live(Box<dyn Drive>),
    /// A finished run.
    Finished(Box<Playback>),
}

/// What runs a simulation: on a thread of its own, or in the frames of the window.
pub trait Drive {
    /// Does what a command asks.
    fn send(&mut self, command: Command);

    /// Takes steps, where the frames of the window do.
    fn frame(&mut self) {}

    /// Those frames, for who takes them instead of the window.
    fn take_over(&self) -> Option<Steps> {
        None
    }

    /// The newest state.
    fn state(&self) -> Arc<State>;

    /// Whether commands were sent of which the newest state knows nothing.
    fn is_behind(&self) -> bool;

    /// Whether the simulation ended by itself, which is a mistake of sinew's own.
    fn has_ended(&self) -> bool {
        false
    }
}

#[cfg(not(target_arch = "wasm32"))]
impl Drive for Driver {
    fn send(&mut self, command: Command) {
        Self::send(self, command);
    }

    fn state(&self) -> Arc<State> {
        Self::state(self)
    }

    fn is_behind(&self) -> bool {
        Self::is_behind(self)
    }

    fn has_ended(&self) -> bool {
        Self::has_ended(self)
    }
}

/// What of a frame goes into steps; drawing takes its time of the same thread.
const BUDGET: Duration = Duration::from_millis(10);

/// A simulation in frames: those of the window, or of who took them over ([`App::steps`](crate::App::steps)). Where one
/// waits for a device, in a page, it may be put aside for as long as that takes; the window goes on with the newest
/// state, and what is sent meanwhile is done in the next.
#[derive(Clone)]
pub struct Steps(Rc<Framed>);

struct Framed {
    driver: RefCell<FrameDriver>,
    /// What is to be done in the next frame.
    commands: RefCell<Vec<Command>>,
    sent: Cell<u64>,
    newest: RefCell<Arc<State>>,
    /// Whether somebody else than the window takes them.
    taken_over: Cell<bool>,
    context: egui::Context,
}

impl Steps {
    fn new(options: &Options, context: &egui::Context) -> Self {
        Self(Rc::new(Framed {
            driver: RefCell::new(FrameDriver::new(options.clone())),
            commands: RefCell::default(),
            sent: Cell::default(),
            newest: RefCell::default(),
            taken_over: Cell::default(),
            context: context.clone(),
        }))
    }

    /// Does what was sent, and takes the steps that are due; nothing while it is put aside.
    pub fn take(&self) {
        let Ok(mut driver) = self.0.driver.try_borrow_mut() else { return };
        self.0.commands.take().into_iter().for_each(|command| driver.send(command));
        let is_new = driver.is_behind() | driver.frame(BUDGET);
        *self.0.newest.borrow_mut() = driver.state();
        if is_new {
            self.0.context.request_repaint();
        }
    }
}

impl Drive for Steps {
    fn send(&mut self, command: Command) {
        self.0.commands.borrow_mut().push(command);
        self.0.sent.set(self.0.sent.get() + 1);
        self.0.context.request_repaint();
    }

    fn frame(&mut self) {
        if !self.0.taken_over.get() {
            self.take();
        }
    }

    fn take_over(&self) -> Option<Steps> {
        self.0.taken_over.set(true);
        Some(self.clone())
    }

    fn state(&self) -> Arc<State> {
        self.0.newest.borrow().clone()
    }

    fn is_behind(&self) -> bool {
        self.state().commands < self.0.sent.get()
    }
}

impl Source {
    /// A simulation on a thread of its own, without a scene yet.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn live(options: &Options, context: &egui::Context) -> Self {
        let wake = context.clone();
        Self::Live(Box::new(Driver::start(options.clone(), move || wake.request_repaint())))
    }

    /// A simulation in the frames of the window: in a page there are no threads.
    #[cfg(target_arch = "wasm32")]
    pub fn live(options: &Options, context: &egui::Context) -> Self {
        Self::framed(options, context)
    }

    /// A simulation in the frames of the window, without a scene yet.
    pub fn framed(options: &Options, context: &egui::Context) -> Self {
        Self::Live(Box::new(Steps::new(options, context)))
    }

    /// Takes steps, where the frames of the window do.
    pub fn frame(&mut self) {
        if let Self::Live(driver) = self {
            driver.frame();
        }
    }

    /// Frames that the window took, for somebody else to take; none of what has a thread.
    pub fn take_over(&self) -> Option<Steps> {
        match self {
            Self::Live(driver) => driver.take_over(),
            Self::Finished(_) => None,
        }
    }

    /// Does what a command asks.
    pub fn send(&mut self, command: Command) {
        match self {
            Self::Live(driver) => driver.send(command),
            Self::Finished(playback) => playback.send(command),
        }
    }

    /// The newest state.
    pub fn state(&mut self) -> Arc<State> {
        match self {
            Self::Live(driver) => driver.state(),
            Self::Finished(playback) => playback.state(),
        }
    }

    /// Whether commands were sent of which the newest state knows nothing.
    pub fn is_behind(&self) -> bool {
        match self {
            Self::Live(driver) => driver.is_behind(),
            Self::Finished(_) => false,
        }
    }

    /// Whether the simulation ended by itself, which is a mistake of sinew's own.
    pub fn has_ended(&self) -> bool {
        match self {
            Self::Live(driver) => driver.has_ended(),
            Self::Finished(_) => false,
        }
    }

    /// The finished run, if it is one.
    pub fn finished(&self) -> Option<&Playback> {
        match self {
            Self::Live(_) => None,
            Self::Finished(playback) => Some(playback),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_that_is_put_aside_keeps_its_state_and_what_is_sent_waits_for_the_next() {
        let steps = Steps::new(&Options::default(), &egui::Context::default());
        let mut window = steps.clone();
        window.send(Command::Speed(1.0));
        window.frame();
        window.send(Command::Speed(2.0));
        let aside = steps.0.driver.borrow_mut();
        window.frame();
        assert!(window.is_behind());
        assert_eq!(window.state().speed, 1.0);
        drop(aside);
        window.frame();
        assert!(!window.is_behind());
        assert_eq!(window.state().speed, 2.0);
    }

    #[test]
    fn who_takes_the_steps_over_takes_them_alone() {
        let steps = Steps::new(&Options::default(), &egui::Context::default());
        let mut window = steps.clone();
        let page = window.take_over();
        window.send(Command::Speed(2.0));
        window.frame();
        assert!(window.is_behind());
        page.into_iter().for_each(|page| page.take());
        assert!(!window.is_behind());
    }
}
