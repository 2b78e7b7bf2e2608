//! Keeps a driver from crying wolf.

/// Mesa's device-select layer looks for a Wayland session when Vulkan is opened, and where there is none (servers,
/// containers) libwayland writes "error: XDG_RUNTIME_DIR is invalid" on stderr, twice, as if the run had failed. Sinew
/// ranks devices itself and does not need the layer; it can only be switched off from outside, by the environment that
/// a process begins with. So the process begins again, once.
#[cfg(target_os = "linux")]
pub fn restart_if_noisy() {
    use std::os::unix::process::CommandExt;

    const SWITCH: &str = "NODEVICE_SELECT";
    if std::env::var_os("XDG_RUNTIME_DIR").is_some() || std::env::var_os(SWITCH).is_some() {
        return;
    }
    let Ok(program) = std::env::current_exe() else { return };
    // returns only when it fails, and then everything works all the same
    let _ = std::process::Command::new(program).args(std::env::args_os().skip(1)).env(SWITCH, "1").exec();
}

/// Nothing to do on other systems.
#[cfg(not(target_os = "linux"))]
pub fn restart_if_noisy() {}
