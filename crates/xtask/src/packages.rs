//! Programs and libraries: found where the system keeps them, or installed.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::project::{Project, TaskError, finish};

/// Finds a shared library in the usual folders or in the linker's cache.
pub fn find_library(name: &str) -> Option<PathBuf> {
    let architecture = format!("/usr/lib/{}-linux-gnu", env::consts::ARCH);
    let mut folders: Vec<PathBuf> = env::var_os("LD_LIBRARY_PATH")
        .iter()
        .flat_map(env::split_paths)
        .collect();
    folders.extend(
        [
            architecture.as_str(),
            "/usr/lib64",
            "/usr/lib",
            "/lib",
            "/usr/local/lib",
        ]
        .map(PathBuf::from),
    );
    folders
        .into_iter()
        .map(|folder| folder.join(name))
        .find(|path| path.exists())
        .or_else(|| in_linker_cache(name))
}

fn in_linker_cache(name: &str) -> Option<PathBuf> {
    let ldconfig = program("ldconfig").unwrap_or_else(|| "/sbin/ldconfig".into());
    let output = Command::new(ldconfig).arg("-p").output().ok()?;
    library_in_listing(&String::from_utf8_lossy(&output.stdout), name).filter(|path| path.exists())
}

/// Reads `ldconfig -p`: `<tab>name (kind) => path`.
fn library_in_listing(listing: &str, name: &str) -> Option<PathBuf> {
    let line = listing
        .lines()
        .find(|line| line.split_whitespace().next() == Some(name))?;
    Some(line.split_once("=> ")?.1.trim().into())
}

/// Programs or libraries that a task needs, and packages that have them.
pub struct Requirement {
    /// Name for all of them in sentences.
    pub what: &'static str,
    /// Packages, by the names that Debian gives them.
    pub packages: &'static [&'static str],
    /// Instructions for systems without apt.
    pub by_hand: &'static str,
}

impl Requirement {
    /// Installs the packages if something is missing and apt is there. `missing` names the missing part as the start of a
    /// sentence.
    pub fn ensure(&self, project: &Project, missing: impl Fn() -> Option<String>) -> Result<(), TaskError> {
        let Some(sentence) = missing() else { return Ok(()) };
        self.install(project, &sentence)?;
        match missing() {
            None => Ok(()),
            Some(still) => {
                let packages = self.packages.join(", ");
                Err(TaskError::failed(format!(
                    "{still}, although {packages} were installed."
                )))
            }
        }
    }

    fn install(&self, project: &Project, missing: &str) -> Result<(), TaskError> {
        let has = |name: &str| program(name).is_some();
        let commands = install_commands(self.packages, is_root(), has("sudo"), has("apt-get"));
        let commands = commands.map_err(|advice| {
            TaskError::failed(format!(
                "{missing}. {}",
                advice.unwrap_or_else(|| self.by_hand.to_owned())
            ))
        })?;
        eprintln!("{missing}. Installing {}.", self.packages.join(", "));
        for words in commands {
            eprintln!("$ {}", words.join(" "));
            let mut command = project.command(Path::new(&words[0]))?;
            command.args(&words[1..]).env("DEBIAN_FRONTEND", "noninteractive");
            finish(command, &format!("Installing {}", self.what))?;
        }
        Ok(())
    }
}

/// Returns the commands that install packages. If they cannot be run, the error is advice for the user, or `None` where
/// there is no apt.
fn install_commands(
    packages: &[&str],
    is_root: bool,
    has_sudo: bool,
    has_apt: bool,
) -> Result<Vec<Vec<String>>, Option<String>> {
    if !has_apt {
        return Err(None);
    }
    if !is_root && !has_sudo {
        let install = format!("apt-get update && apt-get install -y {}", packages.join(" "));
        return Err(Some(format!("Run `{install}` as root, then this again.")));
    }
    // sudo drops the environment, so `env` sets the variable again for apt-get.
    let front: &[&str] = if is_root {
        &[]
    } else {
        &["sudo", "env", "DEBIAN_FRONTEND=noninteractive"]
    };
    let words = |tail: &[&str], more: &[&str]| {
        let all = front.iter().chain(tail).chain(more);
        all.map(|word| (*word).to_owned()).collect::<Vec<String>>()
    };
    Ok(vec![
        words(&["apt-get", "update"], &[]),
        words(&["apt-get", "install", "-y"], packages),
    ])
}

fn is_root() -> bool {
    let output = Command::new("id").arg("-u").output();
    output.is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

/// Finds a program on the path.
pub fn program(name: &str) -> Option<PathBuf> {
    let path: OsString = env::var_os("PATH")?;
    env::split_paths(&path)
        .map(|folder| folder.join(name))
        .find(|file| file.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PACKAGES: [&str; 2] = ["one", "two"];

    #[test]
    fn apt_is_asked_directly_by_root_and_through_sudo_by_others() {
        let root = install_commands(&PACKAGES, true, false, true).unwrap();
        assert_eq!(root[0], ["apt-get", "update"]);
        assert_eq!(root[1], ["apt-get", "install", "-y", "one", "two"]);
        let user = install_commands(&PACKAGES, false, true, true).unwrap();
        assert_eq!(
            user[0],
            ["sudo", "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "update"]
        );
    }

    #[test]
    fn without_root_or_apt_the_exact_command_is_named() {
        let told = "Run `apt-get update && apt-get install -y one two` as root, then this again.";
        assert_eq!(
            install_commands(&PACKAGES, false, false, true).unwrap_err().as_deref(),
            Some(told)
        );
        assert_eq!(install_commands(&PACKAGES, true, true, false).unwrap_err(), None);
    }

    #[test]
    fn a_library_is_read_from_the_linkers_listing() {
        let listing = "2 libs found\n\tlibvulkan_lvp.so (libc6,x86-64) => /lib/a/libvulkan_lvp.so\n\tlibvulkan.so.1 (libc6,x86-64) => /lib/a/libvulkan.so.1\n";
        assert_eq!(
            library_in_listing(listing, "libvulkan.so.1"),
            Some("/lib/a/libvulkan.so.1".into())
        );
        assert_eq!(library_in_listing(listing, "libvulkan.so"), None);
    }
}
