//! A plan as commands, one item per line, for programs that run lines.

use std::path::Path;

use sabi_engine::{EngineError, ErrorKind};

use super::{RunFlags, not_text};
use crate::plan_file::BakePlan;
use crate::shell_word::shell_word;

/// Returns the commands for the plan in this file, one for each item, for the folder from which the file is named.
///
/// # Errors
/// The path of the file is no text, or has control characters.
pub fn command_lines(file: &Path, plan: &BakePlan, flags: RunFlags) -> Result<String, EngineError> {
    let path = file.to_str().ok_or_else(|| not_text(file))?;
    // A program that runs lines would run the part after a line break as a second command, even inside quotes.
    if path.contains(char::is_control) {
        let why = format!(
            "{} cannot be named in commands, each of which is a line, because it has a line break or another control character; \
             name another file",
            file.display()
        );
        return Err(EngineError::new(ErrorKind::CannotWrite, why));
    }
    // A path must not look like an option.
    let path = if path.starts_with('-') {
        format!("./{path}")
    } else {
        path.to_owned()
    };
    let path = shell_word(&path);
    let command = |item: usize| format!("sabi run {path} {} {item}\n", flags.items);
    Ok(plan.items.iter().map(|item| command(item.item)).collect())
}
