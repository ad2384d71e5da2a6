//! `sabi check`: faults of graphs that are found without a model.

use std::path::Path;

use sabi_engine::catalog::check::{CheckReport, CheckedGraph, check_graph};
use sabi_files::TrustedPaths;

use crate::arguments::CheckArguments;
use crate::exit::{Exit, Failure};
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &CheckArguments, trusted: &TrustedPaths, terminal: &Terminal) -> Result<Exit, Failure> {
    let mut exit = Exit::Done;
    let mut documents = Vec::new();
    for graph in &arguments.graphs {
        let path = graph.path();
        let checked = graph.open(trusted).and_then(|open| Ok(check_graph(&open)?));
        let (report, graph_exit) = match checked {
            Ok(report) if arguments.strict => with_strictness(report),
            Ok(report) if report.errors.is_empty() => (report, Exit::Done),
            Ok(report) => (report, Exit::BadInput),
            Err(failure) => report_of_failure(failure),
        };
        exit = worse_exit(exit, graph_exit);
        print_findings(path, &report, terminal);
        if arguments.json {
            documents.push(CheckedGraph::new(path, report));
        } else {
            terminal.data_line(verdict(path, &report))?;
        }
    }
    if arguments.json {
        terminal.json(&documents)?;
    }
    Ok(exit)
}

/// Returns the report, with the warnings among the errors, and the exit code of a graph that must have neither.
fn with_strictness(mut report: CheckReport) -> (CheckReport, Exit) {
    report.errors.append(&mut report.warnings);
    let exit = if report.errors.is_empty() {
        Exit::Done
    } else {
        Exit::BadInput
    };
    (report, exit)
}

/// Returns the report and exit code of a graph that could not be opened.
fn report_of_failure(failure: Failure) -> (CheckReport, Exit) {
    let report = CheckReport {
        errors: failure.messages,
        ..CheckReport::default()
    };
    (report, failure.exit)
}

/// Returns the more important of two exit codes: a damaged file is more important than a missing one.
fn worse_exit(a: Exit, b: Exit) -> Exit {
    match (a, b) {
        (Exit::BadInput, _) | (_, Exit::BadInput) => Exit::BadInput,
        (a, Exit::Done) => a,
        (_, b) => b,
    }
}

fn print_findings(path: &Path, report: &CheckReport, terminal: &Terminal) {
    for error in &report.errors {
        terminal.line(format_args!("{}", with_path(path, error)));
    }
    for warning in &report.warnings {
        // A sentence with a position begins with the path already.
        let sentence = match warning.strip_prefix(&*path.to_string_lossy()) {
            Some(_) => format!("warning: {warning}"),
            None => with_path(path, &format!("warning: {warning}")),
        };
        terminal.note(sentence);
    }
}

/// Returns a sentence with the path before it, unless it begins with the path and a position.
fn with_path(path: &Path, sentence: &str) -> String {
    let path = path.display().to_string();
    if sentence.starts_with(&path) {
        sentence.to_owned()
    } else {
        format!("{path}: {sentence}")
    }
}

fn verdict(path: &Path, report: &CheckReport) -> String {
    let count = |count: usize, what: &str| match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    };
    let path = path.display();
    if !report.errors.is_empty() {
        return format!("{path}: {}", count(report.errors.len(), "error"));
    }
    let warnings = match report.warnings.len() {
        0 => String::new(),
        warnings => format!(", {}", count(warnings, "warning")),
    };
    let passes = match report.passes {
        1 => "1 pass".to_owned(),
        passes => format!("{passes} passes"),
    };
    format!("{path}: good, {} in {passes}{warnings}", count(report.nodes, "node"))
}
