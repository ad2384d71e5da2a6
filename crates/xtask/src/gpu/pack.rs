//! The programs that are run: tests, benches and `sabi`, built once and gathered in one folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::{env, fs};

use serde_json::Value;

use xtask::project::{Project, TaskError, create_folder, output_of};

/// Role of a program, which is also the prefix of its file name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ProgramRole {
    /// Tests that use a device.
    Test,
    /// A bench that uses a device.
    Bench,
    /// The command line, which lists the adapters.
    Sabi,
}

impl ProgramRole {
    fn prefix(self) -> &'static str {
        match self {
            ProgramRole::Test => "test-",
            ProgramRole::Bench => "bench-",
            ProgramRole::Sabi => "",
        }
    }
}

/// A target of cargo: its package, its kind as cargo names it, and its own name.
type CargoTarget = (&'static str, &'static str, &'static str);

const TESTS: [CargoTarget; 6] = [
    ("sabi_tests", "test", "pixels"),
    ("sabi_tests", "test", "closed_forms"),
    ("sabi_tests", "test", "views"),
    ("sabi_tests", "test", "live"),
    ("sabi_tests", "test", "memory"),
    ("sabi_gpu", "test", "device"),
];
const BENCHES: [CargoTarget; 3] = [
    ("sabi_engine", "bench", "bake"),
    ("sabi_engine", "bench", "frames"),
    ("sabi_engine", "bench", "live"),
];

/// A folder with programs.
#[derive(Debug)]
pub(super) struct Pack {
    /// Each program by its role and its target's name.
    pub(super) programs: BTreeMap<(ProgramRole, String), PathBuf>,
}

impl Pack {
    /// Builds everything at full speed and copies it into a folder.
    pub(super) fn build(project: &Project, folder: &Path) -> Result<Pack, TaskError> {
        create_folder(folder)?;
        eprintln!("Building tests, benches and sabi at full speed; the first time takes many minutes.");
        let mut pack = Pack {
            programs: BTreeMap::new(),
        };
        for (role, (package, kind, name)) in targets() {
            let built = build(project, package, kind, name)?;
            pack.add(&built, folder, role, name)?;
        }
        let own =
            env::current_exe().map_err(|error| TaskError::failed(format!("This program cannot be found: {error}.")))?;
        copy(&own, &folder.join(format!("xtask{}", env::consts::EXE_SUFFIX)))?;
        Ok(pack)
    }

    fn add(&mut self, built: &Path, folder: &Path, role: ProgramRole, name: &str) -> Result<(), TaskError> {
        let file = folder.join(file_name(role, name));
        copy(built, &file)?;
        self.programs.insert((role, name.to_owned()), file);
        Ok(())
    }

    /// Opens a folder that was packed before; all programs have to be there.
    pub(super) fn open(folder: &Path) -> Result<Pack, TaskError> {
        let folder = folder.canonicalize().map_err(|error| {
            TaskError::failed(format!("The folder {} cannot be opened: {error}.", folder.display()))
        })?;
        let mut programs = BTreeMap::new();
        for (role, (_, _, name)) in targets() {
            let file = folder.join(file_name(role, name));
            if !file.is_file() {
                let why = format!("{} is missing: pack the folder again.", file.display());
                return Err(TaskError::failed(why));
            }
            programs.insert((role, name.to_owned()), file);
        }
        Ok(Pack { programs })
    }

    /// Programs of a role with their names, in order.
    pub(super) fn of(&self, role: ProgramRole) -> impl Iterator<Item = (&str, &Path)> {
        let of_role = self.programs.iter().filter(move |((own, _), _)| *own == role);
        of_role.map(|((_, name), file)| (name.as_str(), file.as_path()))
    }
}

fn targets() -> impl Iterator<Item = (ProgramRole, CargoTarget)> {
    let tests = TESTS.map(|target| (ProgramRole::Test, target));
    let benches = BENCHES.map(|target| (ProgramRole::Bench, target));
    tests
        .into_iter()
        .chain(benches)
        .chain([(ProgramRole::Sabi, ("sabi", "bin", "sabi"))])
}

fn file_name(role: ProgramRole, name: &str) -> String {
    format!("{}{name}{}", role.prefix(), env::consts::EXE_SUFFIX)
}

/// Builds one target in the profile of benches and returns the program's file, which cargo names.
fn build(project: &Project, package: &str, kind: &str, name: &str) -> Result<PathBuf, TaskError> {
    let flag = format!("--{kind}");
    let what = format!("Building {name} of {package}");
    let mut arguments = if kind == "bin" {
        vec!["build", "--no-default-features"]
    } else {
        vec!["test", "--no-run"]
    };
    arguments.extend(["--profile", "bench", "--locked", "--package", package]);
    arguments.extend([&*flag, name, "--message-format", "json-render-diagnostics"]);
    let mut command = project.cargo(&arguments)?;
    let output = output_of(command.stderr(Stdio::inherit()))?;
    if !output.status.success() {
        return Err(TaskError::failed(format!(
            "{what} failed; the compiler's words are above."
        )));
    }
    let told = String::from_utf8_lossy(&output.stdout);
    program_of(&told, name).ok_or_else(|| TaskError::failed(format!("{what}: cargo did not say where the program is.")))
}

/// The program that cargo's messages name for a target.
fn program_of(messages: &str, name: &str) -> Option<PathBuf> {
    let messages = messages
        .lines()
        .filter_map(|line| serde_json::from_str::<Value>(line).ok());
    messages
        .filter(|message| message["target"]["name"] == name)
        .find_map(|message| Some(PathBuf::from(message["executable"].as_str()?)))
}

fn copy(program: &Path, to: &Path) -> Result<(), TaskError> {
    fs::copy(program, to).map(drop).map_err(|error| {
        TaskError::failed(format!(
            "{} cannot be copied to {}: {error}.",
            program.display(),
            to.display()
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_is_the_one_that_cargo_names_for_the_target() {
        let messages = r#"{"reason":"compiler-artifact","target":{"name":"glam"},"executable":null}
{"reason":"compiler-artifact","target":{"name":"pixels"},"executable":"target/release/deps/pixels-1"}
{"reason":"build-finished","success":true}"#;
        assert_eq!(
            program_of(messages, "pixels"),
            Some("target/release/deps/pixels-1".into())
        );
        assert_eq!(program_of(messages, "views"), None);
    }

    #[test]
    fn a_folder_without_a_program_has_to_be_packed_again() {
        let folder = env::temp_dir();
        let stop = Pack::open(&folder).unwrap_err();
        assert!(stop.sentence.ends_with("pack the folder again."), "{}", stop.sentence);
    }
}
