//! Reading ordinary files of limited size. Pipes and devices are refused, since they may have no end.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

use sabi_cancel::LookingReader;

use crate::refusal::Refusal;

/// Reason why a file was not read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unread {
    /// The file does not exist.
    Missing,
    /// The path is a folder.
    Folder,
    /// The path is a pipe, a device or a socket, which may have no end.
    NotPlain,
    /// The file exceeds the limit. The value is its size in bytes, as far as it was read.
    TooLarge(u64),
    /// Another file refers to it, and that file is not trusted to open it.
    Refused(Refusal),
    /// Error of the operating system.
    Other(String),
}

/// Returns the bytes of an ordinary file of at most `limit` bytes. Looks whether it was canceled ([`sabi_cancel`]).
///
/// # Errors
/// See [`Unread`].
pub fn read_plain(path: &Path, limit: u64) -> Result<Vec<u8>, Unread> {
    let metadata = fs::metadata(path).map_err(unread)?;
    if metadata.is_dir() {
        return Err(Unread::Folder);
    }
    if !metadata.is_file() {
        return Err(Unread::NotPlain);
    }
    if metadata.len() > limit {
        return Err(Unread::TooLarge(metadata.len()));
    }
    // Some files report no length, and others grow while they are read.
    let mut bytes = Vec::new();
    let file = LookingReader(File::open(path).map_err(unread)?);
    let mut start = file.take(limit.saturating_add(1));
    start.read_to_end(&mut bytes).map_err(unread)?;
    if bytes.len() as u64 > limit {
        return Err(Unread::TooLarge(bytes.len() as u64));
    }
    Ok(bytes)
}

impl From<Unread> for io::Error {
    fn from(unread: Unread) -> io::Error {
        match unread {
            Unread::Missing => io::ErrorKind::NotFound.into(),
            Unread::Folder => io::ErrorKind::IsADirectory.into(),
            Unread::NotPlain => io::Error::other("it is a pipe or a device"),
            Unread::TooLarge(_) => io::Error::new(io::ErrorKind::FileTooLarge, "it is too large"),
            Unread::Refused(refusal) => io::Error::new(io::ErrorKind::PermissionDenied, refusal),
            Unread::Other(why) => io::Error::other(why),
        }
    }
}

/// Converts the system's error for a file that cannot be accessed.
pub(crate) fn unread(error: io::Error) -> Unread {
    match error.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => Unread::Missing,
        _ => Unread::Other(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{Unread, read_plain};

    #[test]
    fn only_plain_files_within_the_limit_are_read() {
        let own = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
        let length = std::fs::metadata(own).unwrap().len();
        assert_eq!(read_plain(own, length).unwrap().len() as u64, length);
        assert_eq!(read_plain(own, length - 1), Err(Unread::TooLarge(length)));
        assert_eq!(read_plain(own.parent().unwrap(), length), Err(Unread::Folder));
        assert_eq!(read_plain(&own.join("below"), length), Err(Unread::Missing));
        if cfg!(unix) {
            assert_eq!(read_plain(Path::new("/dev/null"), length), Err(Unread::NotPlain));
        }
        if cfg!(target_os = "linux") {
            // Files in `/proc` report a length of 0.
            assert_eq!(read_plain(Path::new("/proc/self/maps"), 9), Err(Unread::TooLarge(10)));
        }
    }
}
