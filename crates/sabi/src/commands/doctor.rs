//! `sabi doctor`: whether this machine can run Sabi.

use std::fmt::Write as _;

use sabi_engine::{Diagnosis, diagnose};

use crate::arguments::DoctorArguments;
use crate::exit::{Exit, Failure};
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &DoctorArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let diagnosis = diagnose();
    if arguments.json {
        terminal.json(&diagnosis)?;
    } else {
        terminal.data(&page(&diagnosis))?;
    }
    for fault in &diagnosis.faults {
        terminal.warning(fault.as_str());
    }
    match diagnosis.problem {
        None => Ok(Exit::Done),
        Some(problem) => {
            terminal.error(&problem);
            Ok(Exit::NoAdapter)
        }
    }
}

fn page(diagnosis: &Diagnosis) -> String {
    let mut page = format!("sabi      {}\n", diagnosis.sabi);
    for adapter in &diagnosis.adapters {
        let _ = writeln!(
            page,
            "adapter   {} ({}, {}, {})",
            adapter.name, adapter.kind, adapter.backend, adapter.driver
        );
    }
    if diagnosis.adapters.is_empty() {
        page.push_str("adapter   none\n");
    }
    let _ = writeln!(page, "cache     {}", diagnosis.cache.as_deref().unwrap_or("none")); // No folder is one to keep it in.
    let _ = writeln!(page, "nodes     {}", diagnosis.nodes);
    page
}
