//! The command `sinew`: its arguments, what each part of it does, and how it ends.

mod accuracy;
mod advice;
mod arguments;
mod bench;
mod check;
mod explain;
mod failure;
mod hard;
mod interrupt;
mod manual;
mod mesh;
mod modes;
mod progress;
mod quiet_driver;
mod render;
mod report;
mod run;
mod stability;
mod sweep;
mod terminal;
mod unload;
mod view;
mod wording;

use arguments::{Arguments, Command};
use clap::Parser;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use failure::Failure;
use std::process::ExitCode;

/// Reads the arguments, does what they ask for, and tells what went wrong.
fn main() -> ExitCode {
    let Arguments { command, quiet, verbose } = words();
    terminal::speak(match (quiet, verbose) {
        (true, _) => terminal::Voice::Quiet,
        (_, true) => terminal::Voice::Verbose,
        _ => terminal::Voice::Usual,
    });
    if command.may_open_a_gpu() {
        quiet_driver::restart_if_noisy();
    }
    let done = match command {
        Command::Run(arguments) => run::command(&arguments),
        Command::Check(arguments) => check::command(&arguments),
        Command::Modes(arguments) => modes::command(&arguments),
        Command::Unload(arguments) => unload::command(&arguments),
        Command::Mesh(arguments) => mesh::command(&arguments),
        Command::Explain(arguments) => explain::command(&arguments),
        Command::Render(arguments) => render::command(&arguments),
        Command::View(arguments) => view::command(&arguments),
        Command::Accuracy(arguments) => accuracy::command(&arguments),
        Command::Sweep(arguments) => sweep::command(&arguments),
        Command::Hard(arguments) => hard::command(&arguments),
        Command::Bench(arguments) => bench::command(&arguments),
        Command::Completions { shell } => manual::completions(shell),
        Command::Man { folder } => manual::pages(&folder),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.tell();
            ExitCode::from(failure.status())
        }
    }
}

/// The words of the command line; what is wrong with them ends the program.
fn words() -> Arguments {
    Arguments::try_parse().unwrap_or_else(|mut wrong| {
        // no word of sinew's begins with a hyphen: to write `-- --option` would help nobody
        wrong.remove(ContextKind::Suggested);
        if wrong.kind() == ErrorKind::InvalidSubcommand
            && let Some(ContextValue::String(word)) = wrong.get(ContextKind::InvalidSubcommand).cloned()
            && (word.ends_with(".ron") || std::path::Path::new(&word).exists())
        {
            let tip = format!("to run a scene: sinew run {}", sinew::shell_word(word.as_ref()));
            wrong.remove(ContextKind::SuggestedSubcommand);
            wrong.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
        }
        wrong.exit()
    })
}

/// How a part of the command ends.
type Outcome = Result<(), Failure>;
