//! A Vulkan driver: found where the loader looks for it, or installed.

use std::path::{Path, PathBuf};
use std::{env, fs};

use serde_json::Value;

use crate::packages::{Requirement, find_library};
use crate::project::{Project, TaskError};

/// Vulkan driver that a task needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// Any graphics card or software driver.
    Any,
    /// Mesa's software driver: the one that expected pictures are made with.
    Software,
}

const VULKAN: Requirement = Requirement {
    what: "the Vulkan driver",
    packages: &["mesa-vulkan-drivers", "libvulkan1"],
    by_hand: "Install Mesa's Vulkan drivers and the Vulkan loader with your system's package manager, then run this again: on \
              Fedora `sudo dnf install mesa-vulkan-drivers vulkan-loader`, on Arch `sudo pacman -S vulkan-swrast \
              vulkan-icd-loader`.",
};
const LOADER: &str = "libvulkan.so.1";

/// Makes sure that there is a driver, and installs Mesa's where that is possible.
pub fn ensure(project: &Project, driver: Driver) -> Result<(), TaskError> {
    if !cfg!(target_os = "linux") {
        // Metal and Direct3D come with the system.
        return Ok(());
    }
    VULKAN.ensure(project, || missing(driver))
}

/// Returns the missing part, as the beginning of a sentence; `None` if the loader and the driver are there.
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
    let is_lavapipe = |name: &std::ffi::OsStr| name.to_string_lossy().starts_with("lvp_icd");
    driver == Driver::Any || file.file_name().is_some_and(is_lavapipe)
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

/// Returns true if a manifest names a library that is there: removing a driver can leave its manifest behind.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_is_read_from_a_manifest_if_it_names_one() {
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
