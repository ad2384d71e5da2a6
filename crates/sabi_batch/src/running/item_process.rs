//! Process of one item: its lines and its end.

use std::io::{self, BufRead, BufReader, Read};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::thread;

/// End of an item's process.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProcessEnd {
    /// Text that it wrote to standard output.
    pub output: String,
    /// Status that it ended with.
    pub status: ExitStatus,
}

impl ProcessEnd {
    /// Returns a sentence about a process that ended without a report.
    pub fn without_report(&self) -> String {
        #[cfg(unix)]
        if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&self.status) {
            let why = match signal {
                9 => ": it was killed, by somebody or because memory ran out",
                6 | 11 => ": it crashed, perhaps in the driver of the adapter",
                _ => "",
            };
            return format!("signal {signal} ended the process of the item{why}");
        }
        let status = self.status;
        format!("the process of the item ended with {status} and without a report")
    }
}

/// Starts the process of an item, and returns it with its standard input. The process is to stop once that is closed; the system closes it
/// if this process ends.
pub(super) fn start(command: &mut Command) -> io::Result<(Child, Option<ChildStdin>)> {
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut child = command.spawn()?;
    let input = child.stdin.take();
    Ok((child, input))
}

/// Waits for the end of a process. Calls `line` for each line on its standard error.
pub(super) fn end_of(mut child: Child, line: impl Fn(String)) -> io::Result<ProcessEnd> {
    let errors = child.stderr.take();
    let out = child.stdout.take();
    let output = thread::scope(|scope| {
        // Both streams are read at the same time, since a full pipe would block the process.
        let said = scope.spawn(move || {
            let mut said = String::new();
            let read = out.map_or(Ok(0), |mut out| out.read_to_string(&mut said));
            read.map(|_| said)
        });
        errors
            .into_iter()
            .flat_map(|errors| BufReader::new(errors).lines())
            .map_while(Result::ok)
            .for_each(line);
        said.join()
            .unwrap_or_else(|_| Err(io::Error::other("its output cannot be read")))
    });
    let status = child.wait();
    Ok(ProcessEnd {
        output: output?,
        status: status?,
    })
}

#[cfg(test)]
mod tests {
    #[cfg(unix)]
    #[test]
    fn a_process_that_says_nothing_is_described_by_its_end() {
        let told = |raw: i32| {
            let status = std::os::unix::process::ExitStatusExt::from_raw(raw);
            let output = String::new();
            super::ProcessEnd { output, status }.without_report()
        };
        assert_eq!(
            told(9),
            "signal 9 ended the process of the item: it was killed, by somebody or because memory ran out"
        );
        assert_eq!(told(1), "signal 1 ended the process of the item");
        assert_eq!(
            told(70 << 8),
            "the process of the item ended with exit status: 70 and without a report"
        );
    }
}
