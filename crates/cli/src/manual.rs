//! `sinew completions` and `sinew man`: what shells and `man` want to know.

use super::Outcome;
use super::arguments::Arguments;
use super::terminal;
use clap::CommandFactory;
use clap_complete::Shell;
use sinew::output::OutputError;
use std::path::Path;

/// Prints the completions of a shell.
pub fn completions(shell: Shell) -> Outcome {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "sinew", &mut text);
    terminal::hand_out(&String::from_utf8_lossy(&text))
}

/// Writes a page for the command, and one for each of its parts.
pub fn pages(folder: &Path) -> Outcome {
    std::fs::create_dir_all(folder).map_err(OutputError::system("create", folder))?;
    clap_mangen::generate_to(Arguments::command(), folder).map_err(OutputError::system("write", folder))?;
    terminal::say(&format!("man -l {}\n", sinew::shell_word(&folder.join("sinew.1"))))
}
