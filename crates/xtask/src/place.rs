//! Where things are, and how other programs are run there.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use serde_json::Value;

/// Why a task ends early.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Stop {
    /// The exit code.
    pub(crate) code: u8,
    /// What happened and what to do.
    pub(crate) sentence: String,
}

impl Stop {
    /// An exit code and its sentence.
    pub(crate) fn new(code: u8, sentence: impl Into<String>) -> Stop {
        Stop {
            code,
            sentence: sentence.into(),
        }
    }
}

/// The project's folders, absolute.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    /// The workspace's root.
    pub(crate) root: PathBuf,
    /// Where cargo builds.
    pub(crate) target: PathBuf,
}

impl Place {
    /// Asks cargo, so that every way to move the target folder is respected.
    pub(crate) fn find() -> Result<Place, Stop> {
        let here = env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
        let root = Path::new(&here).join("../..");
        let root = root.canonicalize().map_err(|error| {
            Stop::new(
                1,
                format!(
                    "The project's folder {} cannot be opened: {error}. Run `cargo xtask` inside the project.",
                    root.display()
                ),
            )
        })?;
        let output = Command::new(cargo())
            .args(["metadata", "--no-deps", "--format-version", "1", "--manifest-path"])
            .arg(root.join("Cargo.toml"))
            .output()
            .map_err(|error| {
                Stop::new(
                    1,
                    format!("`cargo metadata` could not be started: {error}. Install Rust with rustup."),
                )
            })?;
        let metadata: Option<Value> = serde_json::from_slice(&output.stdout).ok();
        match metadata
            .as_ref()
            .and_then(|metadata| metadata["target_directory"].as_str())
        {
            Some(target) => Ok(Place {
                root,
                target: target.into(),
            }),
            None => Err(Stop::new(
                1,
                format!(
                    "`cargo metadata` failed; mend what it says first:\n{}",
                    String::from_utf8_lossy(&output.stderr)
                ),
            )),
        }
    }

    /// The project in the current folder, on a machine that need not have cargo.
    pub(crate) fn here() -> Result<Place, Stop> {
        let root = env::current_dir().map_err(|error| Stop::new(1, format!("There is no current folder: {error}.")))?;
        if !root.join("shaders").is_dir() {
            let why = format!("{} is not the root of the project: run this there.", root.display());
            return Err(Stop::new(2, why));
        }
        let target = root.join("target");
        Ok(Place { root, target })
    }

    /// A cargo command in the root, building where this one was built.
    pub(crate) fn cargo(&self, arguments: &[&str]) -> Result<Command, Stop> {
        let mut command = self.command(cargo().as_ref())?;
        command.args(arguments).env("CARGO_TARGET_DIR", &self.target);
        Ok(command)
    }

    /// A command in the root, with a private folder for run-time files, which Vulkan's window-system layers ask for.
    pub(crate) fn command(&self, program: &Path) -> Result<Command, Stop> {
        let mut command = Command::new(program);
        command.current_dir(&self.root);
        if cfg!(target_os = "linux") && env::var_os("XDG_RUNTIME_DIR").is_none() {
            let folder = self.target.join("runtime");
            private_folder(&folder).map_err(|error| {
                Stop::new(
                    1,
                    format!(
                        "The folder {} cannot be made: {error}. Free or unlock the disk.",
                        folder.display()
                    ),
                )
            })?;
            command.env("XDG_RUNTIME_DIR", folder);
        }
        Ok(command)
    }
}

/// The cargo that started this, or the first one on the path.
fn cargo() -> std::ffi::OsString {
    env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

fn private_folder(folder: &Path) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(folder, fs::Permissions::from_mode(0o700))?;
    }
    Ok(())
}

/// Runs a command that writes straight to the terminal; its failure becomes the task's own, exit code included.
pub(crate) fn finish(mut command: Command, what: &str) -> Result<(), Stop> {
    let status = command.status().map_err(|error| {
        Stop::new(
            1,
            format!("{what} could not be started ({:?}): {error}.", command.get_program()),
        )
    })?;
    if status.success() {
        return Ok(());
    }
    let code = status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1);
    Err(Stop::new(code, format!("{what} failed; its own words are above.")))
}
