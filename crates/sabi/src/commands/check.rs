//! `sabi check`: everything about graphs that can be known without a model.

use std::path::Path;

use sabi_engine::{CheckReport, EngineError, check};
use serde::Serialize;

use crate::arguments::CheckArguments;
use crate::exit::{Exit, Failure};
use crate::terminal::Terminal;

pub(crate) fn run(arguments: &CheckArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let mut exit = Exit::Done;
    let mut documents = Vec::new();
    for path in &arguments.graphs {
        let (report, graph_exit) = match check(path) {
            Ok(report) if report.errors.is_empty() => (report, Exit::Done),
            Ok(report) => (report, Exit::BadInput),
            Err(error) => of_error(error),
        };
        exit = worse(exit, graph_exit);
        tell(path, &report, terminal);
        if arguments.json {
            documents.push(CheckedGraph::new(path, report));
        } else {
            terminal.data(&format!("{}\n", verdict(path, &report)))?;
        }
    }
    if arguments.json {
        terminal.json(&documents)?;
    }
    Ok(exit)
}

/// A graph that could not even be opened.
fn of_error(error: EngineError) -> (CheckReport, Exit) {
    let exit = error.kind.into();
    let report = CheckReport {
        errors: error.messages,
        ..CheckReport::default()
    };
    (report, exit)
}

/// A damaged file tells more than one that is not there.
fn worse(a: Exit, b: Exit) -> Exit {
    match (a, b) {
        (Exit::BadInput, _) | (_, Exit::BadInput) => Exit::BadInput,
        (a, Exit::Done) => a,
        (_, b) => b,
    }
}

fn tell(path: &Path, report: &CheckReport, terminal: &Terminal) {
    for error in &report.errors {
        terminal.line(format_args!("{}", placed(path, error)));
    }
    for warning in &report.warnings {
        terminal.note(placed(path, &format!("warning: {warning}")));
    }
}

/// The sentence after the path; some say where in the file already.
fn placed(path: &Path, sentence: &str) -> String {
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

/// A graph's entry in `sabi check --json`; docs/report.md lists the keys.
#[derive(Serialize)]
struct CheckedGraph {
    graph: String,
    good: bool,
    nodes: usize,
    passes: usize,
    errors: Vec<String>,
    warnings: Vec<String>,
}

impl CheckedGraph {
    fn new(path: &Path, report: CheckReport) -> CheckedGraph {
        CheckedGraph {
            graph: path.display().to_string(),
            good: report.errors.is_empty(),
            nodes: report.nodes,
            passes: report.passes,
            errors: report.errors,
            warnings: report.warnings,
        }
    }
}
