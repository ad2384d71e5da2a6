//! TOML files that people write. They are read completely, and faults are reported with their positions.

use std::path::Path;

use sabi_files::read_plain;
use toml::Table;

use crate::error::{EngineError, ErrorKind};
use crate::opening::unread::{kind_of_unread, why_unread};

/// Maximum size. Larger files are refused before they are read.
const SIZE_LIMIT_BYTES: u64 = 16 << 20;

/// Reads a TOML file. `plural` is the name of such files in messages.
///
/// # Errors
/// It cannot be read, or is no TOML.
pub fn read_table(path: &Path, plural: &str) -> Result<Table, EngineError> {
    let said = |why: &str| format!("{}: {why}", path.display());
    let bytes = read_plain(path, SIZE_LIMIT_BYTES).map_err(|unread| {
        let why = why_unread(&unread, ".toml", plural, SIZE_LIMIT_BYTES);
        EngineError::new(kind_of_unread(&unread), said(&why))
    })?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let why = format!("the file is not text: byte {at} is not UTF-8; {plural} are TOML");
        EngineError::new(ErrorKind::BadInput, said(&why))
    })?;
    text.parse::<Table>().map_err(|error| {
        let (line, column) = position(&text, error.span().map_or(0, |span| span.start));
        let why = error.message().replace('\n', ", ");
        EngineError::new(
            ErrorKind::BadInput,
            format!("{}:{line}:{column}: {why}", path.display()),
        )
    })
}

/// Returns line and column of a byte, from 1.
fn position(text: &str, at: usize) -> (usize, usize) {
    let before = text.get(..at).unwrap_or(text); // Past the end is at the end.
    let line = before.rsplit('\n').next().unwrap_or(before);
    (before.matches('\n').count() + 1, line.chars().count() + 1)
}
