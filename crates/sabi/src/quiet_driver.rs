//! Keeps a driver from printing an error that is none.
//!
//! Where no desktop runs, Mesa's layer for choosing a device looks for one all the same and prints "error:
//! XDG_RUNTIME_DIR is invalid or not set". The variable that tells it not to look has to be there when the process
//! starts, so the process starts once more.

/// Starts the process again with the layer switched off, where it would complain; else does nothing.
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
            // Comes back only when it failed, and then the message is the smaller evil.
            let _ = Command::new(own).args(env::args_os().skip(1)).env(SWITCH, "1").exec();
        }
    }
}
