use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use super::TrustedPaths;
use crate::address::{is_device_name, is_url, leads_to_network};
use crate::{PathBase, Refusal, Unread, canonical};

/// A folder with a project, a file beside the project, and a file of another project.
struct ProjectFolders {
    folder: tempfile::TempDir,
}

impl ProjectFolders {
    fn new() -> ProjectFolders {
        let place = ProjectFolders {
            folder: tempfile::tempdir().unwrap(),
        };
        for file in [
            "mine/graphs/a.sabi",
            "mine/graphs/sub/b.png",
            "mine/pictures/c.png",
            "secret.txt",
            "other/d.png",
        ] {
            let file = place.path(file);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, b"content").unwrap();
        }
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        canonical(self.folder.path()).unwrap().join(name)
    }

    fn base(&self) -> PathBase {
        PathBase::of_file(&self.path("mine/graphs/a.sabi"))
    }

    fn outside(&self, name: &str) -> Result<PathBuf, Unread> {
        let file = self.path(name);
        Err(Unread::Refused(Refusal::Outside { file }))
    }
}

#[test]
fn a_file_can_refer_to_files_below_its_folder_and_trusted_folders() {
    let place = ProjectFolders::new();
    let (base, none) = (place.base(), TrustedPaths::default());
    assert_eq!(none.check(&base, "sub/b.png"), Ok(place.path("mine/graphs/sub/b.png")));
    assert_eq!(
        none.check(&base, "sub/../../graphs/sub/b.png"),
        Ok(place.path("mine/graphs/sub/b.png"))
    );
    assert_eq!(
        none.check(&base, "../pictures/c.png"),
        place.outside("mine/pictures/c.png")
    );
    assert_eq!(none.check(&base, "../../secret.txt"), place.outside("secret.txt"));
    assert_eq!(none.check(&base, "../../gone.txt"), Err(Unread::Missing));
    assert_eq!(none.read(&base, "sub/b.png", 7), Ok(b"content".to_vec()));
    assert_eq!(none.read(&base, "sub/b.png", 6), Err(Unread::TooLarge(7)));
    assert_eq!(
        none.read(&base, "../../secret.txt", 7).err(),
        place.outside("secret.txt").err()
    );
    let trusted = TrustedPaths::default().with_path(&place.path("other"));
    assert_eq!(trusted.check(&base, "../../other/d.png"), Ok(place.path("other/d.png")));
    assert_eq!(trusted.check(&base, "../../secret.txt"), place.outside("secret.txt"));
    let one_file = TrustedPaths::default().with_path(&place.path("secret.txt"));
    assert_eq!(one_file.check(&base, "../../secret.txt"), Ok(place.path("secret.txt")));
    assert_eq!(one_file.check(&base, "../../other/d.png"), place.outside("other/d.png"));
}

#[test]
fn the_project_of_a_named_file_is_trusted() {
    let place = ProjectFolders::new();
    let graph = place.path("mine/graphs/a.sabi");
    let check = || TrustedPaths::of_file(&graph).check(&place.base(), "../pictures/c.png");
    assert_eq!(check(), place.outside("mine/pictures/c.png"));
    for mark in ["sabi.toml", ".git"] {
        // Content that is valid for the file of a work tree. The project file may have any content.
        fs::write(place.path("mine").join(mark), b"gitdir: elsewhere").unwrap();
        assert_eq!(check(), Ok(place.path("mine/pictures/c.png")), "{mark}");
        fs::remove_file(place.path("mine").join(mark)).unwrap();
    }
    fs::write(place.path("mine/graphs/sabi.toml"), b"").unwrap();
    fs::write(place.path("mine/sabi.toml"), b"").unwrap();
    assert_eq!(check(), place.outside("mine/pictures/c.png"), "the nearest one counts");
}

#[cfg(unix)]
#[test]
fn a_link_is_refused_if_its_target_is_refused() {
    use std::os::unix::fs::symlink;

    let place = ProjectFolders::new();
    symlink(place.path("secret.txt"), place.path("mine/graphs/innocent.png")).unwrap();
    symlink(place.path("other"), place.path("mine/graphs/folder")).unwrap();
    symlink("sub/b.png", place.path("mine/graphs/honest.png")).unwrap();
    let check = |written: &str| TrustedPaths::default().check(&place.base(), written);
    assert_eq!(check("innocent.png"), place.outside("secret.txt"));
    assert_eq!(check("folder/d.png"), place.outside("other/d.png"));
    assert_eq!(
        check("folder/../secret.txt"),
        place.outside("secret.txt"),
        "`..` behind a link"
    );
    assert_eq!(check("honest.png"), Ok(place.path("mine/graphs/sub/b.png")));
}

#[test]
fn network_addresses_are_refused_whatever_is_trusted() {
    let place = ProjectFolders::new();
    let all = TrustedPaths::default().with_path(Path::new("/"));
    for written in [
        "//host/share/a.png",
        r"\\host\share\a.png",
        r"\/host\share\a.png",
        r"\\?\UNC\host\share\a.png",
        r"\\.\COM1",
        r" \\host\share\a.png",
    ] {
        assert!(leads_to_network(written), "{written}");
        let refusal = Refusal::Network {
            written: written.to_owned(),
        };
        assert_eq!(all.check(&place.base(), written), Err(Unread::Refused(refusal)));
    }
    for written in [
        "https://example.org/a.png",
        "HTTP://host/a",
        "file:///etc/passwd",
        "file:a.png",
    ] {
        assert!(is_url(written), "{written}");
        let refusal = Refusal::Url {
            written: written.to_owned(),
        };
        assert_eq!(all.check(&place.base(), written), Err(Unread::Refused(refusal)));
    }
    for written in [
        "C:\\a.png",
        "C://a.png",
        "a:b.png",
        "scan 12:30.png",
        "/a.png",
        "a//b.png",
        "",
    ] {
        assert!(!is_url(written) && !leads_to_network(written), "{written}");
    }
}

#[cfg(unix)]
#[test]
fn devices_are_refused_whatever_is_trusted() {
    let place = ProjectFolders::new();
    std::os::unix::fs::symlink("/dev/zero", place.path("mine/graphs/zero.png")).unwrap();
    let all = TrustedPaths::default().with_path(Path::new("/"));
    let device = |file: &str| Err(Unread::Refused(Refusal::Device { file: file.into() }));
    assert_eq!(all.check(&place.base(), "/dev/zero"), device("/dev/zero"));
    assert_eq!(
        all.check(&place.base(), "/x/../proc/self/environ"),
        device("/proc/self/environ")
    );
    assert_eq!(all.check(&place.base(), "zero.png"), device("/dev/zero"));
    // Trust does not help with a socket either, so it is not advised.
    let socket = place.path("other/socket");
    let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
    let refused = TrustedPaths::default().check(&place.base(), "../../other/socket");
    assert_eq!(refused, device(socket.to_str().unwrap()));
    assert_eq!(
        all.check(&place.base(), "/etc/.."),
        Ok(PathBuf::from("/")),
        "everything else is trusted"
    );
}

#[test]
fn device_names_of_windows_are_recognized_with_any_extension() {
    for name in [
        "NUL",
        "con.png",
        "Aux ",
        "com1",
        "LPT9.txt",
        "conin$",
        "com¹.a",
        "nul:stream",
    ] {
        assert!(is_device_name(OsStr::new(name)), "{name}");
    }
    for name in [
        "null",
        "console.png",
        "com",
        "com10",
        "lpta",
        "auxiliary",
        "prn-1.png",
        "",
    ] {
        assert!(!is_device_name(OsStr::new(name)), "{name}");
    }
}

#[test]
fn a_refusal_is_a_sentence_and_names_the_folder_to_trust() {
    for (refusal, sentence, folder) in [
        (
            Refusal::Outside {
                file: "/private/me/secret.txt".into(),
            },
            "/private/me/secret.txt is outside of the folder of the file that names it and of the folders that you trust",
            Some(Path::new("/private/me")),
        ),
        (
            Refusal::Network {
                written: "//host/a.png".into(),
            },
            "//host/a.png is on another computer, and files never open such paths; copy it beside the file that names it",
            None,
        ),
        (
            Refusal::Url {
                written: "http://host/a.png".into(),
            },
            "http://host/a.png is an address, and addresses are not fetched; copy the file beside the one that names it",
            None,
        ),
        (
            Refusal::Device {
                file: "/dev/zero".into(),
            },
            "/dev/zero is a device or a pipe, which files never open",
            None,
        ),
    ] {
        assert_eq!(refusal.to_string(), sentence);
        assert_eq!(refusal.folder(), folder);
    }
}
