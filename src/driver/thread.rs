//! A session on a thread of its own.

use super::command::Command;
use super::session::Session;
use super::state::State;
use crate::Options;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// A state so often, while the simulation runs.
const FRAME: Duration = Duration::from_millis(16);
/// What of that goes into steps: the rest is for looking and for commands.
const BUDGET: Duration = Duration::from_millis(12);

/// A [`Session`] on a thread of its own, which ends when this is dropped.
///
/// The newest state is an `Arc` that is swapped: a reader keeps it for as long as it likes, and neither side waits for
/// longer than the swap.
pub struct Driver {
    commands: Option<Sender<Command>>,
    sent: std::cell::Cell<u64>,
    newest: Arc<Mutex<Arc<State>>>,
    thread: Option<JoinHandle<()>>,
}

impl Driver {
    /// Starts without a scene. `wake` is called on its thread whenever there is a new state.
    pub fn start(options: Options, wake: impl Fn() + Send + 'static) -> Self {
        let (commands, received) = channel();
        let newest = Arc::<Mutex<Arc<State>>>::default();
        let put = Arc::clone(&newest);
        let thread = std::thread::spawn(move || {
            let mut session = Session::new(options);
            let publish = |session: &mut Session| {
                let state = Arc::new(session.state());
                *put.lock().unwrap_or_else(PoisonError::into_inner) = state;
                wake();
            };
            drive(&mut session, &received, publish);
        });
        Self { commands: Some(commands), sent: 0.into(), newest, thread: Some(thread) }
    }

    /// Sends a command; they are done one after the other, between two frames.
    pub fn send(&self, command: Command) {
        self.sent.set(self.sent.get() + 1);
        // a thread that has ended shows in what is waited for
        let _ = self.commands.as_ref().map(|commands| commands.send(command));
    }

    /// The newest state.
    pub fn state(&self) -> Arc<State> {
        self.newest.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Whether commands were sent of which the newest state knows nothing.
    pub fn is_behind(&self) -> bool {
        self.state().commands < self.sent.get()
    }

    /// Whether the thread ended by itself, which is a mistake of sinew's own.
    pub fn has_ended(&self) -> bool {
        self.thread.as_ref().is_some_and(JoinHandle::is_finished)
    }
}

impl Drop for Driver {
    fn drop(&mut self) {
        self.commands = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Until nobody can send any more.
fn drive(session: &mut Session, commands: &Receiver<Command>, mut publish: impl FnMut(&mut Session)) {
    let mut last = Instant::now();
    loop {
        let next = match session.is_running() {
            false => commands.recv().map_err(|_| RecvTimeoutError::Disconnected),
            // a command does not wait for the frame to end, nor does a frame wait for a long one
            true => commands.recv_timeout(FRAME.saturating_sub(last.elapsed())),
        };
        let stood = !session.is_running();
        match next {
            Ok(command) => session.command(command),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return,
        }
        commands.try_iter().for_each(|command| session.command(command));
        let now = Instant::now();
        let wall = if stood { Duration::ZERO } else { now - last };
        if stood || wall >= FRAME || !session.is_running() {
            session.advance(wall, BUDGET);
            last = now;
            publish(session);
        }
    }
}
