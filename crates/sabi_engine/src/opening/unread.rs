//! Sentences about files that could not be read.

use sabi_files::Unread;

use crate::error::ErrorKind;

/// Returns the kind of the error for a file that could not be read.
pub fn kind_of_unread(unread: &Unread) -> ErrorKind {
    match unread {
        Unread::TooLarge(_) => ErrorKind::BadInput,
        _ => ErrorKind::MissingInput,
    }
}

/// Returns the reason why a file was not read. `ending` and `plural` are the extension and the name of the expected files,
/// and `limit_bytes` is their maximum size.
pub fn why_unread(unread: &Unread, ending: &str, plural: &str, limit_bytes: u64) -> String {
    match unread {
        Unread::Missing => "there is no such file; check the path".to_owned(),
        Unread::Folder => format!("this is a folder; name a {ending} file"),
        Unread::NotPlain => format!("this is a pipe or a device; name a {ending} file"),
        Unread::TooLarge(bytes) => {
            let [has, most] = [*bytes, limit_bytes].map(|bytes| bytes >> 20);
            format!("the file has {has} MiB; {plural} have at most {most}")
        }
        Unread::Refused(refusal) => refusal.to_string(),
        Unread::Other(reason) => format!("the file cannot be read: {reason}"),
    }
}
