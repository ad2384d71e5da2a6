//! A plan as commands, one item per line, for programs that run lines.

use std::path::Path;

use sabi_engine::EngineError;

use super::{RunFlags, line_of_text};
use crate::plan_file::BakePlan;
use crate::shell_word::shell_word;

/// Returns the commands for the plan in this file, one for each item, for the folder from which the file is named.
///
/// # Errors
/// The path of the file is no text, or has characters that are not shown.
pub fn command_lines(file: &Path, plan: &BakePlan, flags: RunFlags) -> Result<String, EngineError> {
    let path = line_of_text(file, file.as_os_str())?;
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
