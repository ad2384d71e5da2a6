//! Folders of the user's own nodes and presets.

use std::path::PathBuf;

/// Returns a folder of the user: that of an environment variable, otherwise `sabi/NAME` in the system's folder for settings.
pub(crate) fn own_folder(variable: &str, name: &str) -> Option<PathBuf> {
    let value = |name: &str| {
        std::env::var_os(name)
            .filter(|value| !value.is_empty())
            .map(PathBuf::from)
    };
    if let Some(own) = value(variable) {
        return Some(own);
    }
    let system = if cfg!(windows) {
        value("APPDATA")
    } else if cfg!(target_os = "macos") {
        value("HOME").map(|home| home.join("Library/Application Support"))
    } else {
        value("XDG_CONFIG_HOME").or_else(|| value("HOME").map(|home| home.join(".config")))
    };
    system.map(|system| system.join("sabi").join(name))
}
