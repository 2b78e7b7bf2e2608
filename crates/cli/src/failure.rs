//! How the command fails: what it says and the status it ends with.

use super::terminal::{self, Paint};
use sinew::Error;
use sinew::output::OutputError;
use sinew::scene::{Diagnostics, Severity};
use sinew_pictures::render::RenderError;

/// Why the command did not do what it was asked for.
pub enum Failure {
    /// The library's reason.
    Engine(Box<Error>),
    /// A picture could not be drawn.
    Picture(Box<RenderError>),
    /// Options that make no sense together.
    Options(String),
    /// A study of a scene that breaks down.
    Broke(String),
    /// A scene that does not meet its target; what there is to say has been said.
    TargetMissed,
    /// A reference too coarse to tell; likewise.
    TargetUnclear,
    /// A plot could not be drawn.
    Plot(sinew_pictures::plot::PlotError),
    /// Results could not be read or written: which file, and why.
    Results(String),
    /// The result could not be said.
    Silent(std::io::Error),
    /// The viewer ended with this status; what there is to say it has said.
    Viewer(u8),
    /// Ctrl-C; what there is to say has been said.
    Interrupted,
}

impl Failure {
    /// The exit status.
    pub fn status(&self) -> u8 {
        match self {
            Failure::Engine(error) => match **error {
                Error::Unstable(_) | Error::NotConverged(_) | Error::NotUnloaded(_) | Error::Broken(_) => 1,
                Error::Scene(_) | Error::Options(_) | Error::Snapshot(_) => 2,
                Error::Output(_) => 3,
                Error::NoGpu(_) | Error::Gpu(_) | Error::GpuFailed(_) => 4,
            },
            Failure::Picture(error) => match **error {
                RenderError::Write(_) => 3,
                _ => 2,
            },
            Failure::Options(_) => 2,
            Failure::Broke(_) => 1,
            Failure::Plot(_) => 3,
            Failure::TargetMissed => 5,
            Failure::TargetUnclear => 6,
            Failure::Silent(_) | Failure::Results(_) => 3,
            Failure::Viewer(status) => *status,
            Failure::Interrupted => 130,
        }
    }

    /// Says on stderr what went wrong.
    pub fn tell(&self) {
        match self {
            Failure::Engine(error) => match &**error {
                Error::Scene(diagnostics) => tell_scene(diagnostics),
                error => complain(&error.to_string()),
            },
            Failure::Picture(error) => complain(&error.to_string()),
            Failure::Options(text) | Failure::Broke(text) | Failure::Results(text) => complain(text),
            Failure::Plot(error) => complain(&error.to_string()),
            Failure::Silent(error) => complain(&format!("cannot write to the standard output: {error}")),
            Failure::Interrupted | Failure::TargetMissed | Failure::TargetUnclear | Failure::Viewer(_) => {}
        }
    }
}

/// Shows what is wrong with a scene, and how much it is.
fn tell_scene(diagnostics: &Diagnostics) {
    terminal::aside(&diagnostics.render(Paint::of_stderr().is_on()));
    complain(&format!("{}; nothing was run", count_of(diagnostics)));
}

/// "2 errors, 1 warning".
pub fn count_of(diagnostics: &Diagnostics) -> String {
    let list = diagnostics.list();
    let errors = list.iter().filter(|diagnostic| diagnostic.severity == Severity::Error).count();
    let counted = |count: usize, word: &str| match count {
        1 => format!("1 {word}"),
        n => format!("{n} {word}s"),
    };
    match list.len() - errors {
        0 => counted(errors, "error"),
        warnings if errors == 0 => counted(warnings, "warning"),
        warnings => format!("{}, {}", counted(errors, "error"), counted(warnings, "warning")),
    }
}

/// One line (or more) on stderr that begins with "error:".
fn complain(text: &str) {
    terminal::aside(&format!("{} {text}\n", Paint::of_stderr().red("error:")));
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Failure::Engine(Box::new(error))
    }
}

impl From<Diagnostics> for Failure {
    fn from(diagnostics: Diagnostics) -> Self {
        Error::from(diagnostics).into()
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        Error::from(error).into()
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        Failure::Picture(Box::new(error))
    }
}
