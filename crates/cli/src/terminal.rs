//! Saying things: results on stdout, everything else on stderr, colours only where somebody looks.

use super::failure::Failure;
use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::atomic::{AtomicU8, Ordering};

/// How much is said.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Voice {
    /// Warnings, errors, and what programs read.
    Quiet,
    /// Reports and progress, too.
    Usual,
    /// What is done meanwhile, too.
    Verbose,
}

static VOICE: AtomicU8 = AtomicU8::new(Voice::Usual as u8);

/// From now on so much is said.
pub fn speak(voice: Voice) {
    VOICE.store(voice as u8, Ordering::Relaxed);
}

fn speaks(voice: Voice) -> bool {
    VOICE.load(Ordering::Relaxed) >= voice as u8
}

/// Whether reports are not wanted.
pub fn is_quiet() -> bool {
    !speaks(Voice::Usual)
}

/// Whether details are wanted.
pub fn is_verbose() -> bool {
    speaks(Voice::Verbose)
}

/// Says what came out on stdout, unless it is to be quiet.
pub fn say(text: &str) -> Result<(), Failure> {
    if speaks(Voice::Usual) { hand_out(text) } else { Ok(()) }
}

/// Puts what was asked for on stdout. That nobody listens any more (`sinew explain scene.ron | head`) is no failure.
pub fn hand_out(text: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::Silent(error)),
        _ => Ok(()),
    }
}

/// Warns, or says what went wrong, on stderr; where that is closed there is nobody to tell.
pub fn aside(text: &str) {
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}

/// Says on stderr how it goes, unless it is to be quiet.
pub fn note(text: &str) {
    if speaks(Voice::Usual) {
        aside(text);
    }
}

/// Says on stderr what is done, where that is wanted.
pub fn detail(text: &str) {
    if is_verbose() {
        aside(text);
    }
}

/// Whether somebody looks at stderr and wants to see how it goes.
pub fn is_interactive() -> bool {
    speaks(Voice::Usual) && std::io::stderr().is_terminal()
}

/// Colours, on terminals whose user has not switched them off (<https://no-color.org>).
#[derive(Clone, Copy)]
pub struct Paint(bool);

impl Paint {
    /// For what goes to stderr.
    pub fn of_stderr() -> Self {
        Self(std::io::stderr().is_terminal() && Self::wanted())
    }

    /// For what goes to stdout.
    pub fn of_stdout() -> Self {
        Self(std::io::stdout().is_terminal() && Self::wanted())
    }

    fn wanted() -> bool {
        std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
            && std::env::var_os("TERM").is_none_or(|value| value != "dumb")
    }

    /// Whether there are colours.
    pub fn is_on(self) -> bool {
        self.0
    }

    /// For errors.
    pub fn red(self, text: &str) -> String {
        self.with("1;31", text)
    }

    /// For headings.
    pub fn bold(self, text: &str) -> String {
        self.with("1", text)
    }

    fn with(self, code: &str, text: &str) -> String {
        if self.0 { format!("\x1b[{code}m{text}\x1b[0m") } else { text.to_string() }
    }
}
