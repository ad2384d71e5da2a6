//! Suppression of an error message of a driver that is no error.
//!
//! Without a desktop, Mesa's layer for device selection prints "error: XDG_RUNTIME_DIR is invalid or not set". The variable
//! that switches the layer off has to be set when the process starts, so the process starts itself again with it.

/// Starts the process again with the layer switched off where it would print the message; otherwise does nothing.
pub(crate) fn start_again_if_needed() {
    #[cfg(unix)]
    {
        use std::env;
        use std::os::unix::process::CommandExt;
        use std::process::Command;

        const SWITCH: &str = "NODEVICE_SELECT";
        let no_desktop = env::var_os("XDG_RUNTIME_DIR").is_none_or(|folder| folder.is_empty());
        if no_desktop
            && env::var_os(SWITCH).is_none()
            && let Ok(own) = env::current_exe()
        {
            // `exec` returns only if it fails, and then the message is printed.
            let _ = Command::new(own).args(env::args_os().skip(1)).env(SWITCH, "1").exec();
        }
    }
}
