//! A plan as commands, one item a line, for programs that run lines.

use std::path::Path;

use sabi_engine::BakePlan;

use super::not_text;
use super::shell_word::shell_word;
use crate::exit::Failure;

/// Commands, each for an item.
pub(super) fn commands(file: &Path, plan: &BakePlan) -> Result<String, Failure> {
    let path = file.to_str().ok_or_else(|| not_text(file))?;
    // A path must not look like an option.
    let path = if path.starts_with('-') {
        format!("./{path}")
    } else {
        path.to_owned()
    };
    let path = shell_word(&path);
    let command = |item: usize| format!("sabi run {path} --items {item}\n");
    Ok(plan.items.iter().map(|item| command(item.item)).collect())
}
