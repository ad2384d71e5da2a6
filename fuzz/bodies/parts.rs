//! Several files in one input.

const BREAK: &[u8] = b"\n-----\n";

/// At most `most` files, which lines of five dashes separate.
pub fn files(bytes: &[u8], most: usize) -> Vec<&[u8]> {
    let mut files = Vec::new();
    let mut rest = bytes;
    while files.len() + 1 < most
        && let Some(at) = rest.windows(BREAK.len()).position(|window| window == BREAK)
    {
        files.push(&rest[..at]);
        rest = &rest[at + BREAK.len()..];
    }
    files.push(rest);
    files
}
