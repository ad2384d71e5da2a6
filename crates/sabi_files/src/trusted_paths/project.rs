//! The project that contains a folder.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use crate::read::read_plain;

/// Mark of a repository: a folder, or a file that refers to one.
const REPOSITORY: &str = ".git";
/// File that the folder of a repository always contains.
const REPOSITORY_HEAD: &str = "HEAD";
/// Start of a file that refers to the folder of a repository, as in work trees and submodules.
const REPOSITORY_LINK: &[u8] = b"gitdir:";
/// Maximum size of a file that refers to the folder of a repository, in bytes.
const MOST_LINK_BYTES: u64 = 8192;
/// Mark of a project: a file, which may be empty.
const PROJECT: &str = "sabi.toml";

/// Home folders of the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Homes {
    /// Canonical paths; empty if the user has no home folder.
    Known(Vec<PathBuf>),
    /// The environment has no absolute path, and the system knows no home folder.
    Unknown,
}

impl Homes {
    /// Returns the home folders: the one of the environment, and the one of the system's list of users. Both are needed,
    /// since a program may be started with an unusual `HOME`, which must not turn the real home folder into a project.
    pub(super) fn of_user() -> &'static Homes {
        static HOMES: LazyLock<Homes> = LazyLock::new(|| {
            let named = match cfg!(unix) {
                true => env::var_os("HOME"),
                false => env::home_dir().map(PathBuf::into_os_string),
            };
            Homes::of(named, listed_home())
        });
        &HOMES
    }

    fn of(named: Option<OsString>, listed: Option<PathBuf>) -> Homes {
        let named = named.map(PathBuf::from).filter(|home| home.is_absolute());
        if named.is_none() && listed.is_none() {
            return Homes::Unknown;
        }
        // A folder that does not exist contains nothing.
        let homes = named
            .into_iter()
            .chain(listed)
            .filter_map(|home| home.canonicalize().ok());
        Homes::Known(homes.collect())
    }

    /// Returns true if a folder is a home folder or above one, or if that cannot be excluded.
    fn may_be_below(&self, folder: &Path) -> bool {
        match self {
            Homes::Known(homes) => homes.iter().any(|home| home.starts_with(folder)),
            Homes::Unknown => true,
        }
    }
}

/// Returns the nearest folder, starting from a canonical one and going up, that contains a project mark. The home folder and the folders
/// above it never count: many people keep their settings in a repository there, and it contains private files that a graph must not read.
pub(super) fn project_of<'f>(folder: &'f Path, homes: &Homes) -> Option<&'f Path> {
    let is_project = |folder: &&Path| {
        folder.parent().is_some() && !homes.may_be_below(folder) && (is_repository(folder) || has_project_file(folder))
    };
    folder.ancestors().find(is_project)
}

/// Returns true if a folder is the root of a repository of the user. The owner is checked, since others can put a `.git`
/// folder into a folder to which everybody may write.
fn is_repository(folder: &Path) -> bool {
    let mark = folder.join(REPOSITORY);
    let is_whole = mark.join(REPOSITORY_HEAD).is_file()
        || read_plain(&mark, MOST_LINK_BYTES).is_ok_and(|bytes| bytes.starts_with(REPOSITORY_LINK));
    is_whole && owner::is_of_user(&mark)
}

/// Returns true if a folder contains a project file that was made by the user or by the owner of the folder.
fn has_project_file(folder: &Path) -> bool {
    let mark = folder.join(PROJECT);
    mark.is_file() && (owner::is_of_user(&mark) || owner::is_of_owner(&mark, folder))
}

/// Returns the home folder according to the system's list of users.
#[cfg(unix)]
fn listed_home() -> Option<PathBuf> {
    const MOST_BYTES: u64 = 1 << 20;
    let user = owner::user()?.to_string();
    let list = read_plain(Path::new("/etc/passwd"), MOST_BYTES).ok()?;
    let list = String::from_utf8_lossy(&list);
    // Fields: name, password, number, group, remark, home, shell.
    let mut lines = list.lines().map(|line| line.split(':').collect::<Vec<&str>>());
    let line = lines.find(|fields| fields.get(2) == Some(&user.as_str()))?;
    let home = PathBuf::from(line.get(5)?);
    home.is_absolute().then_some(home)
}

#[cfg(not(unix))]
fn listed_home() -> Option<PathBuf> {
    None
}

/// Owners of files.
#[cfg(unix)]
mod owner {
    use std::fs;
    use std::os::unix::fs::MetadataExt;
    use std::path::Path;
    use std::sync::LazyLock;

    /// Number of the administrator, who can write everywhere anyway.
    const ADMINISTRATOR: u32 = 0;
    /// Permission for everybody to write.
    const ALL_WRITE: u32 = 0o002;

    /// Returns the number of the user on whose behalf this process runs; `None` if no file can be created.
    pub(super) fn user() -> Option<u32> {
        // A new file is owned by the user that the system considers current.
        static USER: LazyLock<Option<u32>> = LazyLock::new(|| {
            let file = tempfile::tempfile().ok()?;
            file.metadata().ok().map(|found| found.uid())
        });
        *USER
    }

    /// Returns true if the user or the administrator owns a file. For a link, the owner of the link counts, not that of its target.
    pub(super) fn is_of_user(path: &Path) -> bool {
        let owner = fs::symlink_metadata(path).map(|found| found.uid());
        owner.is_ok_and(|owner| owner == ADMINISTRATOR || user() == Some(owner))
    }

    /// Returns true if a file in a folder has the owner of the folder, and not everybody may write there.
    pub(super) fn is_of_owner(path: &Path, folder: &Path) -> bool {
        let (Ok(file), Ok(folder)) = (fs::symlink_metadata(path), fs::metadata(folder)) else {
            return false;
        };
        file.uid() == folder.uid() && folder.mode() & ALL_WRITE == 0
    }
}

/// On this system, permissions of folders are left to the system.
#[cfg(not(unix))]
mod owner {
    use std::path::Path;

    pub(super) fn is_of_user(_: &Path) -> bool {
        true
    }

    pub(super) fn is_of_owner(_: &Path, _: &Path) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    /// Creates a folder with a folder of graphs below it.
    fn place() -> (tempfile::TempDir, PathBuf, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        let graphs = root.join("mine/graphs");
        fs::create_dir_all(&graphs).unwrap();
        (folder, root.join("mine"), graphs)
    }

    fn nobody() -> Homes {
        Homes::Known(Vec::new())
    }

    #[test]
    fn a_repository_is_recognized_by_its_content() {
        let (_folder, mine, graphs) = place();
        let found = || project_of(&graphs, &nobody()) == Some(mine.as_path());
        let mark = mine.join(".git");
        fs::write(&mark, b"").unwrap();
        assert!(!found(), "an empty file");
        fs::write(&mark, b"gitdir: ../main/.git/worktrees/mine\n").unwrap();
        assert!(found(), "a work tree");
        fs::remove_file(&mark).unwrap();
        fs::create_dir(&mark).unwrap();
        assert!(!found(), "an empty folder");
        fs::write(mark.join("HEAD"), b"ref: refs/heads/main\n").unwrap();
        assert!(found(), "a repository");
        fs::remove_dir_all(&mark).unwrap();
        fs::create_dir(mine.join("sabi.toml")).unwrap();
        assert!(!found(), "a folder of that name");
        fs::remove_dir(mine.join("sabi.toml")).unwrap();
        fs::write(mine.join("sabi.toml"), b"").unwrap();
        assert!(found(), "an empty file of a project, as the documentation has it");
    }

    #[test]
    fn the_home_folder_is_never_a_project_whatever_the_environment_says() {
        let (_folder, mine, graphs) = place();
        fs::write(mine.join("sabi.toml"), b"").unwrap();
        let project = |named: Option<&str>, listed: Option<&Path>| {
            project_of(
                &graphs,
                &Homes::of(named.map(OsString::from), listed.map(Path::to_owned)),
            )
        };
        let elsewhere = mine.parent().unwrap().join("nowhere");
        let text = |path: &Path| path.to_str().unwrap().to_owned();
        assert_eq!(project(Some(&text(&elsewhere)), None), Some(mine.as_path()));
        assert_eq!(project(Some(&text(&mine)), None), None);
        assert_eq!(project(Some(&text(&graphs)), None), None, "a folder above it");
        // An unusual variable does not hide the home folder that the system knows. If both are missing, there is no project.
        for odd in [Some(""), Some("relative/home"), Some("."), None] {
            assert_eq!(project(odd, Some(&mine)), None, "{odd:?}");
            assert_eq!(project(odd, Some(&elsewhere)), Some(mine.as_path()), "{odd:?}");
            assert_eq!(project(odd, None), None, "{odd:?}");
        }
        assert_eq!(project(Some(&text(&elsewhere)), Some(&mine)), None, "both count");
    }

    #[cfg(unix)]
    #[test]
    fn a_mark_that_another_user_put_into_a_folder_is_ignored() {
        use std::os::unix::fs::{PermissionsExt, chown};

        let (_folder, mine, graphs) = place();
        let found = || project_of(&graphs, &nobody()) == Some(mine.as_path());
        let mark = mine.join("sabi.toml");
        fs::write(&mark, b"").unwrap();
        fs::create_dir(mine.join(".git")).unwrap();
        fs::write(mine.join(".git/HEAD"), b"ref").unwrap();
        assert!(found());
        // Only the administrator can change the owner of a file.
        if owner::user() != Some(0) {
            return;
        }
        chown(&mark, Some(65_534), None).unwrap();
        assert!(found(), "the repository is still the user's");
        chown(mine.join(".git"), Some(65_534), None).unwrap();
        assert!(!found());
        chown(&mine, Some(65_534), None).unwrap();
        assert!(found(), "the file of a project belongs to the owner of the folder");
        fs::set_permissions(&mine, PermissionsExt::from_mode(0o777)).unwrap();
        assert!(!found(), "all may write there");
    }
}
