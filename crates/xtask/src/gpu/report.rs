//! One report of all adapters: tests, failures with their pictures, and times side by side.

use std::fmt::Write as _;

use super::adapters::Adapter;
use super::benches::BenchResults;
use super::tests_run::TestResults;

/// Results of one adapter.
pub(super) struct Results {
    pub(super) adapter: Adapter,
    pub(super) tests: Vec<TestResults>,
    pub(super) benches: Vec<BenchResults>,
    /// The folder with pictures of failed goldens, from the root.
    pub(super) pictures: String,
}

impl Results {
    /// Number of tests and benches that failed, or whose program ended early.
    pub(super) fn failures(&self) -> usize {
        let tests = self
            .tests
            .iter()
            .map(|test| test.failed.len() + usize::from(test.ended_early.is_some()));
        tests.sum::<usize>() + self.benches.iter().filter(|bench| bench.failure.is_some()).count()
    }

    fn measured(&self, bench: &str, what: &str) -> Option<&str> {
        let bench = self.benches.iter().find(|known| known.bench == bench)?;
        let row = bench.rows.iter().find(|row| row.what == what)?;
        Some(&row.measured)
    }
}

/// The report as Markdown. Software drivers come last, since the others are compared with them.
pub(super) fn written(results: &[Results]) -> String {
    let mut sorted: Vec<&Results> = results.iter().collect();
    sorted.sort_by_key(|results| results.adapter.is_software());
    let mut text =
        String::from("# Sabi on the adapters of this machine\n\n| adapter | kind | driver | tests passed | failed |\n");
    text.push_str("|---|---|---|---|---|\n");
    for results in &sorted {
        let Adapter {
            name,
            kind,
            driver,
            backend,
        } = &results.adapter;
        let passed: usize = results.tests.iter().map(|test| test.passed).sum();
        let _ = writeln!(
            text,
            "| {name} | {kind} | {backend}, {driver} | {passed} | {} |",
            results.failures()
        );
    }
    for results in sorted.iter().filter(|results| results.failures() > 0) {
        write_failures(&mut text, results);
    }
    write_times(&mut text, &sorted);
    text
}

fn write_failures(text: &mut String, results: &Results) {
    let _ = writeln!(
        text,
        "\n## Failures on {}\n\nPictures of results beside what was expected: `{}`.\n",
        results.adapter.name, results.pictures
    );
    for test in &results.tests {
        if let Some(why) = &test.ended_early {
            let _ = writeln!(text, "* `{}` ended before its summary: {why}", test.program);
        }
        for (name, message) in &test.failed {
            let _ = writeln!(
                text,
                "* `{}`: `{name}`\n\n      {}\n",
                test.program,
                message.replace('\n', "\n      ")
            );
        }
    }
    for bench in &results.benches {
        if let Some(why) = &bench.failure {
            let _ = writeln!(text, "* bench `{}`: {why}", bench.bench);
        }
    }
}

fn write_times(text: &mut String, results: &[&Results]) {
    text.push_str("\n## Times and rays\n\n| bench | what |");
    for results in results {
        let _ = write!(text, " {} |", results.adapter.name);
    }
    text.push_str("\n|---|---|");
    text.push_str(&"---|".repeat(results.len()));
    text.push('\n');
    for (bench, what) in measurements(results) {
        let _ = write!(text, "| {bench} | {what} |");
        for results in results {
            let _ = write!(text, " {} |", results.measured(bench, what).unwrap_or("not measured"));
        }
        text.push('\n');
    }
}

/// Names of the measurements of all adapters, in the order of the benches' tables.
fn measurements<'r>(results: &[&'r Results]) -> Vec<(&'r str, &'r str)> {
    let mut known = Vec::new();
    for bench in results.iter().flat_map(|results| &results.benches) {
        for row in &bench.rows {
            let measurement = (bench.bench.as_str(), row.what.as_str());
            if !known.contains(&measurement) {
                known.push(measurement);
            }
        }
    }
    known
}

#[cfg(test)]
mod tests {
    use super::super::benches::BenchRow;
    use super::*;

    fn results(name: &str, kind: &str, ms: &str, failed: &[&str]) -> Results {
        let text = str::to_owned;
        Results {
            adapter: Adapter {
                name: text(name),
                kind: text(kind),
                driver: text("1"),
                backend: text("vulkan"),
            },
            tests: vec![TestResults {
                program: text("pixels"),
                passed: 3,
                failed: failed.iter().map(|name| (text(name), text("it differs"))).collect(),
                ended_early: None,
            }],
            benches: vec![BenchResults {
                bench: text("frames"),
                rows: vec![BenchRow {
                    what: text("still"),
                    measured: text(ms),
                }],
                failure: None,
            }],
            pictures: text("target/gpu/a"),
        }
    }

    #[test]
    fn times_of_a_card_stand_beside_those_of_the_software_driver() {
        let all = [
            results("llvmpipe", "cpu", "90 ms", &[]),
            results("Card", "discrete", "2 ms", &["golden"]),
        ];
        assert_eq!(
            written(&all),
            "\
# Sabi on the adapters of this machine

| adapter | kind | driver | tests passed | failed |
|---|---|---|---|---|
| Card | discrete | vulkan, 1 | 3 | 1 |
| llvmpipe | cpu | vulkan, 1 | 3 | 0 |

## Failures on Card

Pictures of results beside what was expected: `target/gpu/a`.

* `pixels`: `golden`

      it differs


## Times and rays

| bench | what | Card | llvmpipe |
|---|---|---|---|
| frames | still | 2 ms | 90 ms |
"
        );
    }
}
