//! `sinew view`: the viewer, a program of its own, so that who simulates on a server has no windows to install.

use super::Outcome;
use super::arguments::ViewArguments;
use super::failure::Failure;
use std::env::consts::EXE_SUFFIX;
use std::io::ErrorKind;
use std::process::Command;

/// Starts `sinew-view` from beside this program, or from where programs are, and waits until its window is closed.
pub fn command(arguments: &ViewArguments) -> Outcome {
    let name = format!("sinew-view{EXE_SUFFIX}");
    let beside = std::env::current_exe().ok().and_then(|own| Some(own.parent()?.join(&name)));
    let program = beside.filter(|path| path.exists()).unwrap_or_else(|| name.into());
    match Command::new(&program).args(&arguments.words).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Failure::Viewer(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1))),
        Err(error) if error.kind() == ErrorKind::NotFound => Err(Failure::Options(
            "the viewer is not installed: it is a program of its own, sinew-view, which belongs beside this one. From \
             sinew's repository: cargo install --path crates/view. `sinew render` draws pictures without it"
                .into(),
        )),
        Err(error) => Err(Failure::Options(format!("{} cannot be started: {error}", program.display()))),
    }
}
