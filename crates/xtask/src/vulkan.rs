//! A Vulkan driver: found where the loader looks for it, or installed.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use serde_json::Value;

use crate::place::{Place, Stop, finish};

/// What a task needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Driver {
    /// Any graphics card or software driver.
    Any,
    /// Mesa's software driver: the one that expected pictures are made with.
    Software,
}

/// Debian's names.
const PACKAGES: [&str; 2] = ["mesa-vulkan-drivers", "libvulkan1"];
const LOADER: &str = "libvulkan.so.1";

/// Makes sure that there is a driver, installing Mesa's where that can be done.
pub(crate) fn ensure(place: &Place, driver: Driver) -> Result<(), Stop> {
    if !cfg!(target_os = "linux") {
        // Metal and Direct3D come with the system.
        return Ok(());
    }
    let Some(missing) = missing(driver) else { return Ok(()) };
    let commands = install_commands(is_root(), program("sudo").is_some(), program("apt-get").is_some())
        .map_err(|advice| Stop::new(1, format!("{missing}. {advice}")))?;
    eprintln!("{missing}. Installing Mesa's.");
    for words in commands {
        eprintln!("$ {}", words.join(" "));
        let mut command = place.command(Path::new(&words[0]))?;
        command.args(&words[1..]).env("DEBIAN_FRONTEND", "noninteractive");
        finish(command, "Installing the Vulkan driver")?;
    }
    match self::missing(driver) {
        None => Ok(()),
        Some(still) => Err(Stop::new(
            1,
            format!("{still}, although {} were installed.", PACKAGES.join(" and ")),
        )),
    }
}

/// What is not there, as the beginning of a sentence.
fn missing(driver: Driver) -> Option<String> {
    if find_library(LOADER).is_none() {
        return Some(format!("No Vulkan loader ({LOADER}) was found"));
    }
    let usable = icd_files()
        .into_iter()
        .filter(|file| is_usable(file))
        .any(|file| suits(&file, driver));
    match (usable, driver) {
        (true, _) => None,
        (false, Driver::Any) => Some("No Vulkan driver was found".into()),
        (false, Driver::Software) => Some("Mesa's software Vulkan driver (lavapipe) was not found".into()),
    }
}

fn suits(file: &Path, driver: Driver) -> bool {
    let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    driver == Driver::Any || name.starts_with("lvp_icd")
}

/// The driver manifests that the loader would read, in its order.
fn icd_files() -> Vec<PathBuf> {
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        if let Some(list) = env::var_os(variable) {
            return env::split_paths(&list)
                .flat_map(|path| if path.is_dir() { manifests(&path) } else { vec![path] })
                .collect();
        }
    }
    let mut folders: Vec<PathBuf> = ["XDG_CONFIG_HOME", "XDG_DATA_HOME"]
        .iter()
        .filter_map(env::var_os)
        .map(PathBuf::from)
        .collect();
    folders.extend(env::var_os("HOME").map(|home| Path::new(&home).join(".local/share")));
    folders.extend(["/etc", "/usr/local/etc", "/usr/local/share", "/usr/share"].map(PathBuf::from));
    folders.extend(env::var_os("XDG_DATA_DIRS").iter().flat_map(env::split_paths));
    folders
        .iter()
        .flat_map(|folder| manifests(&folder.join("vulkan/icd.d")))
        .collect()
}

fn manifests(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut files: Vec<PathBuf> = entries.filter_map(Result::ok).map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "json"));
    files.sort();
    files
}

/// Whether a manifest names a library that is there: removing a driver can leave its manifest behind.
fn is_usable(manifest: &Path) -> bool {
    let Ok(text) = fs::read_to_string(manifest) else {
        return false;
    };
    match library_named_by(&text) {
        Some(library) if library.contains('/') => manifest.parent().unwrap_or(Path::new("/")).join(library).exists(),
        Some(library) => find_library(&library).is_some(),
        None => false,
    }
}

fn library_named_by(manifest: &str) -> Option<String> {
    let manifest: Value = serde_json::from_str(manifest).ok()?;
    Some(manifest["ICD"]["library_path"].as_str()?.to_owned())
}

/// A shared library, in the linker's cache or where it usually lies.
fn find_library(name: &str) -> Option<PathBuf> {
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

/// The commands that install Mesa's driver, or what to do by hand.
fn install_commands(is_root: bool, has_sudo: bool, has_apt: bool) -> Result<Vec<Vec<String>>, String> {
    let install = format!("apt-get update && apt-get install -y {}", PACKAGES.join(" "));
    if !has_apt {
        return Err("Install Mesa's Vulkan drivers and the Vulkan loader with your system's package manager, then run this \
            again: on Fedora `sudo dnf install mesa-vulkan-drivers vulkan-loader`, on Arch `sudo pacman -S vulkan-swrast \
            vulkan-icd-loader`."
            .into());
    }
    if !is_root && !has_sudo {
        return Err(format!("Run `{install}` as root, then this again."));
    }
    // sudo drops the environment, so the variable is set on its far side.
    let front: &[&str] = if is_root {
        &[]
    } else {
        &["sudo", "env", "DEBIAN_FRONTEND=noninteractive"]
    };
    let words = |tail: &[&str]| {
        front
            .iter()
            .chain(tail)
            .map(|word| (*word).to_owned())
            .collect::<Vec<String>>()
    };
    Ok(vec![
        words(&["apt-get", "update"]),
        words(&["apt-get", "install", "-y", PACKAGES[0], PACKAGES[1]]),
    ])
}

fn is_root() -> bool {
    let output = Command::new("id").arg("-u").output();
    output.is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

fn program(name: &str) -> Option<PathBuf> {
    let path: OsString = env::var_os("PATH")?;
    env::split_paths(&path)
        .map(|folder| folder.join(name))
        .find(|file| file.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn apt_is_asked_directly_by_root_and_through_sudo_by_others() {
        let root = install_commands(true, false, true).unwrap();
        assert_eq!(root[0], ["apt-get", "update"]);
        assert_eq!(
            root[1],
            ["apt-get", "install", "-y", "mesa-vulkan-drivers", "libvulkan1"]
        );
        let user = install_commands(false, true, true).unwrap();
        assert_eq!(
            user[0],
            ["sudo", "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "update"]
        );
    }

    #[test]
    fn without_root_or_apt_the_exact_command_is_said() {
        assert_eq!(
            install_commands(false, false, true).unwrap_err(),
            "Run `apt-get update && apt-get install -y mesa-vulkan-drivers libvulkan1` as root, then this again."
        );
        assert!(
            install_commands(true, true, false)
                .unwrap_err()
                .contains("sudo dnf install mesa-vulkan-drivers")
        );
    }

    #[test]
    fn a_library_is_read_from_the_linkers_listing() {
        let listing = "2 libs found\n\tlibvulkan_lvp.so (libc6,x86-64) => /lib/a/libvulkan_lvp.so\n\tlibvulkan.so.1 (libc6,x86-64) => /lib/a/libvulkan.so.1\n";
        assert_eq!(
            library_in_listing(listing, LOADER),
            Some("/lib/a/libvulkan.so.1".into())
        );
        assert_eq!(library_in_listing(listing, "libvulkan.so"), None);
    }

    #[test]
    fn only_a_manifest_with_a_library_counts() {
        let text = r#"{ "ICD": { "api_version": "1.4.0", "library_path": "libvulkan_lvp.so" }, "file_format_version": "1.0.0" }"#;
        assert_eq!(library_named_by(text), Some("libvulkan_lvp.so".into()));
        assert_eq!(library_named_by("{}"), None);
        assert_eq!(library_named_by("{"), None);
    }

    #[test]
    fn only_mesas_own_manifest_is_the_software_driver() {
        assert!(suits(Path::new("a/lvp_icd.x86_64.json"), Driver::Software));
        assert!(!suits(Path::new("a/intel_icd.x86_64.json"), Driver::Software));
        assert!(suits(Path::new("a/intel_icd.x86_64.json"), Driver::Any));
    }
}
