//! Folders of the user's own nodes and presets.

use std::ffi::OsString;
use std::path::PathBuf;

/// Returns a folder of the user: that of an environment variable, otherwise `sabi/NAME` in the system's folder for settings.
pub(crate) fn own_folder(variable: &str, name: &str) -> Option<PathBuf> {
    let folders = SystemFolders::of_environment();
    folders.own(variable).or_else(|| {
        let settings = folders.system(["APPDATA", "Library/Application Support", "XDG_CONFIG_HOME", ".config"])?;
        Some(settings.join("sabi").join(name))
    })
}

/// Folders that the environment names.
pub(crate) struct SystemFolders<'a> {
    /// Value of a variable.
    pub(crate) variable: &'a dyn Fn(&str) -> Option<OsString>,
}

impl SystemFolders<'static> {
    pub(crate) fn of_environment() -> SystemFolders<'static> {
        SystemFolders {
            variable: &|name| std::env::var_os(name),
        }
    }
}

impl SystemFolders<'_> {
    /// Returns the folder that a variable of Sabi names.
    pub(crate) fn own(&self, variable: &str) -> Option<PathBuf> {
        let value = (self.variable)(variable).filter(|value| !value.is_empty());
        value.map(PathBuf::from)
    }

    /// Returns a folder of the system: that of a variable of Windows, one in the home folder of macOS, or that of a variable of other
    /// systems, else one in the home folder. Relative paths are ignored, as the XDG base directory specification (0.8) demands.
    pub(crate) fn system(&self, [windows, macos, xdg, of_home]: [&str; 4]) -> Option<PathBuf> {
        let absolute = |name: &str| self.own(name).filter(|path| path.is_absolute());
        let in_home = |folder: &str| absolute("HOME").map(|home| home.join(folder));
        if cfg!(windows) {
            absolute(windows)
        } else if cfg!(target_os = "macos") {
            in_home(macos)
        } else {
            absolute(xdg).or_else(|| in_home(of_home))
        }
    }
}
