//! What is seen: a simulation that runs, or a run that is over.

use crate::playback::Playback;
use sinew::Options;
use sinew::driver::{Command, Driver, State};
use std::sync::Arc;

/// Where states come from.
pub enum Source {
    /// A simulation.
    Live(Driver),
    /// A finished run.
    Finished(Box<Playback>),
}

impl Source {
    /// A simulation, without a scene yet.
    pub fn live(options: &Options, context: &egui::Context) -> Self {
        let wake = context.clone();
        Self::Live(Driver::start(options.clone(), move || wake.request_repaint()))
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
