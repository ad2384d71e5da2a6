//! `sabi verify`: folders of maps against what their bakes recorded.

use sabi_engine::{Verification, verify_folder};

use crate::arguments::VerifyArguments;
use crate::exit::{Exit, Failure};
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &VerifyArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let mut verified = Vec::new();
    for folder in &arguments.folders {
        let verification = verify_folder(folder)?;
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
    let is_good = verified.iter().all(|verification| verification.findings.is_empty());
    Ok(if is_good { Exit::Done } else { Exit::Mismatch })
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
