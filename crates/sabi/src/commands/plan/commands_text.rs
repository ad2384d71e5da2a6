//! A plan as commands, one item per line, for programs that run lines.

use std::path::Path;

use sabi_engine::BakePlan;

use super::not_text;
use super::shell_word::shell_word;
use crate::exit::{Exit, Failure};

/// Returns the commands, one for each item.
pub(super) fn commands(file: &Path, plan: &BakePlan) -> Result<String, Failure> {
    let path = file.to_str().ok_or_else(|| not_text(file))?;
    // A program that runs lines would run the part after a line break as a second command, even inside quotes.
    if path.contains(char::is_control) {
        let why = format!(
            "{} cannot be named in commands, each of which is a line, because it has a line break or another control character; \
             name another file",
            file.display()
        );
        return Err(Failure::new(Exit::CannotWrite, why));
    }
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
