//! Saying things: results on stdout, everything else on stderr, colours only where somebody looks.

use super::failure::Failure;
use std::io::{ErrorKind, IsTerminal, Write};

/// Says a result on stdout. That nobody listens any more (`sinew explain scene.ron | head`) is no failure.
pub fn say(text: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::Silent(error)),
        _ => Ok(()),
    }
}

/// Says something beside the result, on stderr; where that is closed there is nobody to tell.
pub fn aside(text: &str) {
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}

/// Whether somebody looks at stderr.
pub fn is_watched() -> bool {
    std::io::stderr().is_terminal()
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
