//! `sabi doctor`: whether this machine can run Sabi.

use std::fmt::Write as _;

use sabi_engine::diagnose;
use serde_json::Value as Json;

use crate::arguments::DoctorArguments;
use crate::exit::{Exit, Failure};
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &DoctorArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let findings = diagnose();
    if arguments.json {
        terminal.json(&findings)?;
    } else {
        terminal.data(&page(&findings))?;
    }
    for fault in findings["faults"].as_array().into_iter().flatten() {
        terminal.warning(text(fault));
    }
    if findings["usable"] == true {
        return Ok(Exit::Done);
    }
    Err(Failure::new(Exit::NoAdapter, text(&findings["problem"]).to_owned()))
}

fn text(json: &Json) -> &str {
    json.as_str().unwrap_or_default()
}

fn page(findings: &Json) -> String {
    let mut page = format!("sabi      {}\n", text(&findings["sabi"]));
    let adapters = findings["adapters"].as_array().map_or(&[][..], Vec::as_slice);
    for adapter in adapters {
        let _ = writeln!(
            page,
            "adapter   {} ({}, {}, {})",
            text(&adapter["name"]),
            text(&adapter["kind"]),
            text(&adapter["backend"]),
            text(&adapter["driver"]),
        );
    }
    if adapters.is_empty() {
        page.push_str("adapter   none\n");
    }
    let cache = findings["cache"].as_str().unwrap_or("none");
    let _ = writeln!(page, "cache     {cache}");
    let _ = writeln!(page, "nodes     {}", findings["nodes"]);
    page
}
