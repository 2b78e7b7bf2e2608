//! What is seen: a simulation that runs, or a run that is over.

use crate::playback::Playback;
use sinew::Options;
#[cfg(not(target_arch = "wasm32"))]
use sinew::driver::Driver;
use sinew::driver::{Command, FrameDriver, State};
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

/// A simulation in the frames of a window, which it asks for.
struct Framed {
    driver: FrameDriver,
    context: egui::Context,
}

impl Drive for Framed {
    fn send(&mut self, command: Command) {
        self.driver.send(command);
        self.context.request_repaint();
    }

    fn frame(&mut self) {
        if self.driver.frame(BUDGET) {
            self.context.request_repaint();
        }
    }

    fn state(&self) -> Arc<State> {
        self.driver.state()
    }

    fn is_behind(&self) -> bool {
        self.driver.is_behind()
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
        Self::Live(Box::new(Framed { driver: FrameDriver::new(options.clone()), context: context.clone() }))
    }

    /// Takes steps, where the frames of the window do.
    pub fn frame(&mut self) {
        if let Self::Live(driver) = self {
            driver.frame();
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
