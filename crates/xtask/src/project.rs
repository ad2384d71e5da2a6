//! Folders of the project, and commands that run in them.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::{env, fs};

use serde_json::Value;

/// Failure that ends a task early.
#[derive(Debug, PartialEq, Eq)]
pub struct TaskError {
    /// Exit code.
    pub code: u8,
    /// Description of the failure and how to correct it.
    pub sentence: String,
}

impl TaskError {
    /// Creates an error with an exit code.
    pub fn new(code: u8, sentence: impl Into<String>) -> TaskError {
        TaskError {
            code,
            sentence: sentence.into(),
        }
    }

    /// Creates an error with the exit code 1.
    pub fn failed(sentence: impl Into<String>) -> TaskError {
        TaskError::new(1, sentence)
    }
}

/// The project's folders, absolute.
#[derive(Clone, Debug)]
pub struct Project {
    /// The workspace's root.
    pub root: PathBuf,
    /// Target folder of cargo.
    pub target: PathBuf,
}

impl Project {
    /// Finds the folders by asking cargo, so that every way to move the target folder is respected.
    pub fn find() -> Result<Project, TaskError> {
        let here = env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
        let root = Path::new(&here).join("../..");
        let root = root.canonicalize().map_err(|error| {
            TaskError::failed(format!(
                "The project's folder {} cannot be opened: {error}. Run `cargo xtask` inside the project.",
                root.display()
            ))
        })?;
        let output = Command::new(cargo())
            .args(["metadata", "--no-deps", "--format-version", "1", "--manifest-path"])
            .arg(root.join("Cargo.toml"))
            .output()
            .map_err(|error| {
                TaskError::failed(format!(
                    "`cargo metadata` could not be started: {error}. Install Rust with rustup."
                ))
            })?;
        let metadata: Option<Value> = serde_json::from_slice(&output.stdout).ok();
        match metadata
            .as_ref()
            .and_then(|metadata| metadata["target_directory"].as_str())
        {
            Some(target) => Ok(Project {
                root,
                target: target.into(),
            }),
            None => Err(TaskError::failed(format!(
                "`cargo metadata` failed; fix what it reports first:\n{}",
                String::from_utf8_lossy(&output.stderr)
            ))),
        }
    }

    /// Returns the project in the current folder, on a machine that need not have cargo.
    pub fn here() -> Result<Project, TaskError> {
        let root =
            env::current_dir().map_err(|error| TaskError::failed(format!("There is no current folder: {error}.")))?;
        if !root.join("shaders").is_dir() {
            let why = format!("{} is not the root of the project: run this there.", root.display());
            return Err(TaskError::new(2, why));
        }
        let target = root.join("target");
        Ok(Project { root, target })
    }

    /// Creates a cargo command in the root, which builds where this program was built.
    pub fn cargo(&self, arguments: &[&str]) -> Result<Command, TaskError> {
        let mut command = self.command(cargo().as_ref())?;
        command.args(arguments).env("CARGO_TARGET_DIR", &self.target);
        Ok(command)
    }

    /// Returns the path of `sabi`, which a profile of cargo built.
    pub fn sabi(&self, profile: &str) -> PathBuf {
        let name = format!("sabi{}", env::consts::EXE_SUFFIX);
        self.target.join(profile).join(name)
    }

    /// Creates a command in the root, with a private folder for run-time files, which Vulkan's window-system layers ask for.
    pub fn command(&self, program: &Path) -> Result<Command, TaskError> {
        let mut command = Command::new(program);
        command.current_dir(&self.root);
        if cfg!(target_os = "linux") && env::var_os("XDG_RUNTIME_DIR").is_none() {
            let folder = self.target.join("runtime");
            private_folder(&folder)?;
            command.env("XDG_RUNTIME_DIR", folder);
        }
        Ok(command)
    }
}

/// Returns the cargo that started this program, or the name of the first one on the path.
fn cargo() -> std::ffi::OsString {
    env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Creates a folder that only its owner can open.
fn private_folder(folder: &Path) -> Result<(), TaskError> {
    create_folder(folder)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(folder, fs::Permissions::from_mode(0o700)).map_err(|error| not_written(folder, &error))?;
    }
    Ok(())
}

/// Creates a folder and the folders above it.
pub fn create_folder(folder: &Path) -> Result<(), TaskError> {
    fs::create_dir_all(folder).map_err(|error| not_written(folder, &error))
}

/// Writes a file.
pub fn write_file(path: &Path, bytes: impl AsRef<[u8]>) -> Result<(), TaskError> {
    fs::write(path, bytes).map_err(|error| not_written(path, &error))
}

/// Error for a file or folder that cannot be written.
pub fn not_written(path: &Path, error: &dyn Display) -> TaskError {
    TaskError::failed(format!("{} cannot be written: {error}.", path.display()))
}

/// Runs a command and returns its output, whatever its exit code.
pub fn output_of(command: &mut Command) -> Result<Output, TaskError> {
    let output = command.output();
    output.map_err(|error| TaskError::failed(format!("{:?} could not be started: {error}.", command.get_program())))
}

/// Runs a command that writes to the terminal; its failure becomes the task's own, exit code included.
pub fn finish(mut command: Command, what: &str) -> Result<(), TaskError> {
    let status = command.status().map_err(|error| {
        TaskError::failed(format!(
            "{what} could not be started ({:?}): {error}.",
            command.get_program()
        ))
    })?;
    if status.success() {
        return Ok(());
    }
    let code = status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1);
    Err(TaskError::new(code, format!("{what} failed; its output is above.")))
}
