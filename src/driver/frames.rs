//! A session that is stepped by the frames of who looks.

use super::command::Command;
use super::session::Session;
use super::state::State;
use crate::Options;
use std::sync::Arc;
use std::time::Duration;
use web_time::Instant;

/// A [`Session`] that takes its steps in the frames of who looks: where there are no threads, in a page. It is used as
/// a driver with a thread is, but that a frame has to be asked for.
pub struct FrameDriver {
    session: Session,
    newest: Arc<State>,
    /// When the last frame was in which it ran.
    last: Option<Instant>,
    /// Whether the newest state is not that of the session.
    is_behind: bool,
}

impl FrameDriver {
    /// Starts without a scene.
    pub fn new(options: Options) -> Self {
        Self { session: Session::new(options), newest: Arc::default(), last: None, is_behind: false }
    }

    /// Does what a command asks, at once; it shows in the state after the next frame.
    pub fn send(&mut self, command: Command) {
        self.session.command(command);
        self.is_behind = true;
    }

    /// A frame: takes the steps that are due since the last one, for as long as a budget lasts, or one if a step is
    /// longer than that. Gives whether it goes on, so that another frame is wanted.
    pub fn frame(&mut self, budget: Duration) -> bool {
        if self.session.is_running() {
            let now = Instant::now();
            let wall = self.last.map_or(Duration::ZERO, |last| now - last);
            self.session.advance(wall, budget);
            self.last = Some(now);
            self.is_behind = true;
        } else {
            self.last = None;
        }
        if self.is_behind {
            self.newest = Arc::new(self.session.state());
            self.is_behind = false;
        }
        self.session.is_running()
    }

    /// The state after the last frame.
    pub fn state(&self) -> Arc<State> {
        Arc::clone(&self.newest)
    }

    /// Whether commands were sent of which that state knows nothing.
    pub fn is_behind(&self) -> bool {
        self.is_behind
    }
}
