//! `sabi verify`: compares folders of maps with the records of their bakes.

use sabi_engine::baking::recorded::{Verification, verify_folder};

use crate::arguments::VerifyArguments;
use crate::exit::{Exit, Failure};
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &VerifyArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let mut verified = Vec::new();
    let mut exit = Exit::Done;
    for folder in &arguments.folders {
        let verification = match verify_folder(folder) {
            Ok(verification) => verification,
            Err(error) => {
                // A folder that cannot be checked does not prevent the check of the others.
                error.messages.iter().for_each(|message| terminal.error(message));
                verified.push(Verification::failed(folder, &error));
                exit = worse(exit, error.kind.into());
                continue;
            }
        };
        if !verification.findings.is_empty() {
            exit = worse(exit, Exit::Mismatch);
        }
        for finding in &verification.findings {
            terminal.line(format_args!("{}: {}", verification.folder, finding.message));
        }
        if !arguments.json {
            terminal.data_line(verdict(&verification))?;
        }
        verified.push(verification);
    }
    if arguments.json {
        terminal.json(&verified)?;
    }
    Ok(exit)
}

/// Returns the more important of the exit codes of two folders.
/// A folder that could not be checked is more important than one with findings, and
/// a damaged one is more important than a missing one.
fn worse(one: Exit, other: Exit) -> Exit {
    let rank = |exit: Exit| match exit {
        Exit::Done => 0,
        Exit::Mismatch => 1,
        Exit::MissingInput => 2,
        _ => 3,
    };
    if rank(other) > rank(one) { other } else { one }
}

fn verdict(verification: &Verification) -> String {
    let count = |count: usize, what: &str| match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    };
    let of = format!(
        "{} of {}",
        count(verification.files, "file"),
        count(verification.bakes, "bake")
    );
    match verification.findings.len() {
        0 => format!("{}: good, {of}", verification.folder),
        findings => format!("{}: {} in {of}", verification.folder, count(findings, "finding")),
    }
}
