//! Packing of the graph for another machine, in the background.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use egui::Context;
use sabi_engine::packing::{PackReport, PackRequest, pack_graph};
use sabi_engine::phases::{Phase, Progress};

use crate::task::Task;

/// The archive that is being written, if any. Dropping it cancels the writing.
#[derive(Default)]
pub(crate) struct PackTask {
    task: Option<Task<Result<PackReport, String>>>,
    cancel: Arc<PackCancel>,
}

/// Request to cancel the packing.
#[derive(Default)]
struct PackCancel(AtomicBool);

impl Progress for PackCancel {
    fn advance(&self, _: Phase, _: usize, _: usize) {}

    fn is_canceled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl Drop for PackTask {
    fn drop(&mut self) {
        self.cancel.0.store(true, Ordering::Relaxed);
    }
}

impl PackTask {
    pub(crate) fn is_running(&self) -> bool {
        self.task.is_some()
    }

    /// Starts to write an archive.
    pub(crate) fn start(&mut self, context: &Context, request: PackRequest) {
        let cancel = self.cancel.clone();
        self.task = Some(Task::start(context, move || {
            pack_graph(&request, &*cancel).map_err(|error| error.to_string())
        }));
    }

    /// Sentence about the archive, or the reason that it is not written, once the work has ended.
    pub(crate) fn take(&mut self) -> Option<Result<String, String>> {
        let packed = self.task.as_ref()?.poll()?;
        self.task = None;
        Some(match packed {
            Ok(Ok(report)) => Ok(told(&report)),
            Ok(Err(refused)) => Err(format!("Not packed: {refused}")),
            Err(_) => Err("Not packed: the work broke off.".to_owned()),
        })
    }
}

fn told(report: &PackReport) -> String {
    let name = Path::new(&report.archive).file_name().map_or_else(
        || report.archive.clone(), // It was written, so that it has a name.
        |name| name.to_string_lossy().into_owned(),
    );
    let warnings = report.warnings.iter().map(|warning| format!(" {warning}."));
    let missing = report.missing.iter().map(|missing| format!(" Left out: {missing}."));
    let more: String = warnings.chain(missing).collect();
    format!(
        "Packed {} files into {name}; 'sabi unpack {name}' puts them in place elsewhere.{more}",
        report.files.len()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sentence_names_the_archive_and_what_is_left_out() {
        let report = PackReport {
            archive: "/sent/worn.zip".to_owned(),
            graph: "worn.sabi".to_owned(),
            model: None,
            files: Vec::new(),
            missing: vec!["dirt.png is missing".to_owned()],
            warnings: vec!["the graph names no model".to_owned()],
        };
        assert_eq!(
            told(&report),
            "Packed 0 files into worn.zip; 'sabi unpack worn.zip' puts them in place elsewhere. the graph names no model. \
             Left out: dirt.png is missing."
        );
    }
}
