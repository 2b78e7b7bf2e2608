//! The command `sinew`: its arguments, what each part of it does, and how it ends.

mod accuracy;
mod arguments;
mod bench;
mod check;
mod explain;
mod failure;
mod hard;
mod interrupt;
mod mesh;
mod modes;
mod progress;
mod quiet_driver;
mod render;
mod report;
mod run;
mod stability;
mod terminal;
mod wording;

use arguments::{Arguments, Command};
use clap::Parser;
use failure::Failure;
use std::process::ExitCode;

/// Reads the arguments, does what they ask for, and tells what went wrong.
pub fn main() -> ExitCode {
    let command = Arguments::parse().command;
    if command.may_open_a_gpu() {
        quiet_driver::restart_if_noisy();
    }
    let done = match command {
        Command::Run(arguments) => run::command(&arguments),
        Command::Check(arguments) => check::command(&arguments),
        Command::Modes(arguments) => modes::command(&arguments),
        Command::Mesh(arguments) => mesh::command(&arguments),
        Command::Explain(arguments) => explain::command(&arguments),
        Command::Render(arguments) => render::command(&arguments),
        Command::Accuracy(arguments) => accuracy::command(&arguments),
        Command::Hard(arguments) => hard::command(&arguments),
        Command::Bench(arguments) => bench::command(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.tell();
            ExitCode::from(failure.status())
        }
    }
}

/// How a part of the command ends.
type Outcome = Result<(), Failure>;
