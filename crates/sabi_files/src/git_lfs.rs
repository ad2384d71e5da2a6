//! Pointers that Git LFS checks out in place of files that were not fetched.

/// Returns true for the text of a pointer (Git LFS specification, "The Pointer"), whose first line names the version.
pub fn is_git_lfs_pointer(bytes: &[u8]) -> bool {
    bytes.starts_with(b"version https://git-lfs")
}
