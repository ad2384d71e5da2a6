//! Environment variables that Mesa's drivers read when the process starts. If some are missing, the process sets them and starts
//! itself again.

/// Starts the process again if a variable is missing; otherwise does nothing.
pub(crate) fn start_again_if_needed() {
    #[cfg(unix)]
    {
        use std::env;
        use std::os::unix::process::CommandExt;
        use std::process::Command;

        let variables: Vec<_> = missing().collect();
        if !variables.is_empty()
            && let Ok(own) = env::current_exe()
        {
            // `exec` returns only if it fails; the process then continues without the variables.
            let _ = Command::new(own).args(env::args_os().skip(1)).envs(variables).exec();
        }
    }
}

#[cfg(unix)]
fn missing() -> impl Iterator<Item = (&'static str, std::ffi::OsString)> {
    quiet_layer().into_iter().chain(folder_of_kernels())
}

/// Without a desktop, Mesa's layer for device selection prints "error: XDG_RUNTIME_DIR is invalid or not set", although nothing is wrong.
/// This switches the layer off.
#[cfg(unix)]
fn quiet_layer() -> Option<(&'static str, std::ffi::OsString)> {
    const SWITCH: &str = "NODEVICE_SELECT";
    let is_needed = std::env::var_os("XDG_RUNTIME_DIR").is_none_or(|folder| folder.is_empty());
    (is_needed && std::env::var_os(SWITCH).is_none()).then(|| (SWITCH, "1".into()))
}

/// The software driver keeps compiled kernels in the user's folder for caches. Without such a folder, as in many containers, it
/// would compile large kernels again for every part of a map, so it gets a folder of Sabi's, or one for temporary files.
#[cfg(unix)]
fn folder_of_kernels() -> Option<(&'static str, std::ffi::OsString)> {
    // Without Mesa, there are no compiled kernels to keep.
    if cfg!(target_os = "macos") {
        return None;
    }
    const FOLDER: &str = "MESA_SHADER_CACHE_DIR";
    const SWITCH: &str = "MESA_SHADER_CACHE_DISABLE";
    if std::env::var_os(FOLDER).is_some() || std::env::var_os(SWITCH).is_some() {
        return None;
    }
    let of_user = match std::env::var_os("XDG_CACHE_HOME").map(std::path::PathBuf::from) {
        // A relative folder is invalid (XDG base directory specification, 0.8), but Mesa would create it in the current one.
        Some(folder) => Some(folder).filter(|folder| folder.is_absolute()),
        None => std::env::home_dir().map(|home| home.join(".cache")),
    };
    if of_user.is_some_and(|folder| can_be_written(&folder.join("mesa_shader_cache"))) {
        return None;
    }
    let own = sabi_engine::opening::default_cache_dir().map(|folder| folder.join("kernels"));
    let own = own.filter(|folder| can_be_written(folder));
    own.or_else(temporary_folder).map(|folder| (FOLDER, folder.into()))
}

/// Returns a folder for temporary files that no other user can write to, since kernels in it are run without a check.
#[cfg(unix)]
fn temporary_folder() -> Option<std::path::PathBuf> {
    use std::os::unix::fs::{DirBuilderExt, MetadataExt};

    let folder = std::env::temp_dir().join("sabi-kernels");
    // Another process may have created the folder in the meantime.
    let _ = std::fs::DirBuilder::new().mode(0o700).create(&folder);
    let of_folder = std::fs::symlink_metadata(&folder).ok()?;
    let own = std::fs::metadata("/proc/self").ok()?.uid();
    let is_private = of_folder.is_dir() && of_folder.uid() == own && of_folder.mode() & 0o077 == 0;
    (is_private && can_be_written(&folder)).then_some(folder)
}

/// Returns true if a file can be created in a folder, which is created if necessary.
#[cfg(unix)]
fn can_be_written(folder: &std::path::Path) -> bool {
    let probe = folder.join(format!(".sabi-{}", std::process::id()));
    let is_made = std::fs::create_dir_all(folder).is_ok() && std::fs::File::create(&probe).is_ok();
    // Removing fails if the file was not created, which does not matter.
    let _ = std::fs::remove_file(&probe);
    is_made
}
