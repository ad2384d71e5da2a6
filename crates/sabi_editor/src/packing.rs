//! Packing of the graph for another machine, while the window goes on.

use std::path::Path;

use egui::Context;
use sabi_engine::{NoProgress, PackReport, PackRequest, pack_graph};

use crate::task::Task;

/// The archive that is being written, if any.
#[derive(Default)]
pub(crate) struct Packing {
    task: Option<Task<Result<PackReport, String>>>,
}

impl Packing {
    pub(crate) fn is_running(&self) -> bool {
        self.task.is_some()
    }

    /// Starts to write an archive.
    pub(crate) fn start(&mut self, context: &Context, request: PackRequest) {
        self.task = Some(Task::start(context, move || {
            pack_graph(&request, &NoProgress).map_err(|error| error.to_string())
        }));
    }

    /// Sentence for the artist once the archive is written, or why it is not.
    pub(crate) fn take(&mut self) -> Option<String> {
        let packed = self.task.as_ref()?.poll()?;
        self.task = None;
        Some(match packed {
            Ok(Ok(report)) => told(&report),
            Ok(Err(refused)) => format!("Not packed: {refused}"),
            Err(_) => "Not packed: the work broke off.".to_owned(),
        })
    }
}

fn told(report: &PackReport) -> String {
    let name = Path::new(&report.archive).file_name().map_or_else(
        || report.archive.clone(), // It was written, so that it has a name.
        |name| name.to_string_lossy().into_owned(),
    );
    let warnings: String = report.warnings.iter().map(|warning| format!(" {warning}.")).collect();
    format!(
        "Packed {} files into {name}; 'sabi unpack {name}' puts them in place elsewhere.{warnings}",
        report.files.len()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sentence_names_the_archive_and_repeats_warnings() {
        let report = PackReport {
            archive: "/sent/worn.zip".to_owned(),
            graph: "worn.sabi".to_owned(),
            model: None,
            files: Vec::new(),
            missing: Vec::new(),
            warnings: vec!["no model".to_owned()],
        };
        assert_eq!(
            told(&report),
            "Packed 0 files into worn.zip; 'sabi unpack worn.zip' puts them in place elsewhere. no model."
        );
    }
}
