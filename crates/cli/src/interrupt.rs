//! Ctrl-C: the first asks the run to come to a good end, the second kills.

use super::terminal;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

static ASKED: AtomicBool = AtomicBool::new(false);
static AT_WORK: AtomicBool = AtomicBool::new(false);
static FIRST: OnceLock<Instant> = OnceLock::new();

/// Wrappers such as `timeout` signal a program and then its whole group: what follows within this time is the same
/// request.
const SAME_REQUEST: Duration = Duration::from_millis(300);

/// From now on until [`rest`], Ctrl-C (and a request of the system to end) only asks; see [`is_asked`].
pub fn listen() {
    AT_WORK.store(true, Ordering::SeqCst);
    let heard = || {
        if !AT_WORK.load(Ordering::SeqCst) {
            std::process::exit(130);
        }
        if ASKED.swap(true, Ordering::SeqCst) {
            match FIRST.get() {
                Some(first) if first.elapsed() < SAME_REQUEST => return,
                _ => std::process::exit(130),
            }
        }
        FIRST.get_or_init(Instant::now);
        terminal::note("\ninterrupted: finishing what is begun (again: stop at once)\n");
    };
    // where no handler can be set, Ctrl-C kills as it always does
    let _ = ctrlc::set_handler(heard);
}

/// Whether somebody wants the run to end.
pub fn is_asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}

/// From now on Ctrl-C kills again.
pub fn rest() {
    AT_WORK.store(false, Ordering::SeqCst);
}
