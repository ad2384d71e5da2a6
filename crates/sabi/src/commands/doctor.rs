//! `sabi doctor`: checks whether this machine can run Sabi.

use sabi_engine::catalog::diagnosis::{Diagnosis, diagnose};

use crate::arguments::DoctorArguments;
use crate::exit::{Exit, Failure};
use crate::printable::Page;
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &DoctorArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let diagnosis = diagnose();
    if arguments.json {
        terminal.json(&diagnosis)?;
    } else {
        terminal.page(&page(&diagnosis))?;
    }
    terminal.warnings(diagnosis.faults.iter().map(String::as_str));
    match diagnosis.problem {
        None => Ok(Exit::Done),
        Some(problem) => {
            terminal.error(&problem);
            Ok(Exit::NoAdapter)
        }
    }
}

fn page(diagnosis: &Diagnosis) -> Page {
    let mut page = Page::default();
    page.line(format_args!("sabi      {}", diagnosis.sabi));
    for adapter in &diagnosis.adapters {
        page.line(format_args!(
            "adapter   {} ({}, {}, {})",
            adapter.name, adapter.kind, adapter.backend, adapter.driver
        ));
    }
    if diagnosis.adapters.is_empty() {
        page.line("adapter   none");
    }
    page.line(format_args!(
        "cache     {}",
        diagnosis.cache.as_deref().unwrap_or("none")
    )); // No folder is one to keep it in.
    page.line(format_args!("nodes     {}", diagnosis.nodes));
    page
}
