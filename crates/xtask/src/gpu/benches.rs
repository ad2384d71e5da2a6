//! The benches on one adapter: their tables, row by row.

use std::process::Stdio;

use super::adapters::Adapter;
use super::pack::{Pack, ProgramRole};
use xtask::project::{Project, TaskError, output_of};

/// A row of a bench's table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct BenchRow {
    /// Name of the measured quantity.
    pub(super) what: String,
    /// The number with its unit.
    pub(super) measured: String,
}

/// Results of one bench.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct BenchResults {
    /// The bench's name.
    pub(super) bench: String,
    /// Its table.
    pub(super) rows: Vec<BenchRow>,
    /// Cause of its failure, if it failed.
    pub(super) failure: Option<String>,
}

/// Runs all benches, one after the other.
pub(super) fn run_all(project: &Project, pack: &Pack, adapter: &Adapter) -> Result<Vec<BenchResults>, TaskError> {
    let mut results = Vec::new();
    for (name, program) in pack.of(ProgramRole::Bench) {
        eprintln!("  bench: {name}");
        let mut command = project.command(program)?;
        command
            .env("SABI_PROJECT", &project.root)
            .env("SABI_ADAPTER", &adapter.name)
            .stderr(Stdio::piped());
        let output = output_of(&mut command)?;
        let words = String::from_utf8_lossy(&output.stderr).into_owned();
        let last = words
            .lines()
            .rfind(|line| !line.is_empty() && !line.starts_with("note: "));
        let failure = (!output.status.success()).then(|| format!("{}: {}", output.status, last.unwrap_or("no words")));
        results.push(BenchResults {
            bench: name.to_owned(),
            rows: rows(&String::from_utf8_lossy(&output.stdout)),
            failure,
        });
    }
    Ok(results)
}

/// Rows of a table in Markdown whose first two columns are the measured quantity and the number.
fn rows(printed: &str) -> Vec<BenchRow> {
    let cells = |line: &str| -> Option<BenchRow> {
        let inner = line.trim().strip_prefix('|')?.strip_suffix('|')?;
        let mut cells = inner.split('|').map(|cell| cell.trim().to_owned());
        let (what, measured) = (cells.next()?, cells.next()?);
        let is_row = what != "what" && !what.starts_with("---");
        is_row.then_some(BenchRow { what, measured })
    };
    printed.lines().filter_map(cells).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_head_of_a_table_is_no_measurement() {
        let printed = "llvmpipe\n\n| what | measured | aim |\n|---|---|---|\n| still | 12.0 ms | ≤ 120 ms |\n";
        let row = BenchRow {
            what: "still".into(),
            measured: "12.0 ms".into(),
        };
        assert_eq!(rows(printed), [row]);
    }
}
