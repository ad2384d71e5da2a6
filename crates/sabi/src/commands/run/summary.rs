//! Summary of a run; docs/report.md lists the keys.

use std::path::Path;

use sabi_batch::BakePlan;
use sabi_batch::running::ItemStatus;
use schemars::JsonSchema;
use serde::Serialize;

use super::item_process::BakedItem;
use crate::failure_report::ErrorReport;
use crate::printable::Page;

/// Summary of a run.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct Summary {
    /// Path of the plan as it was given.
    plan: String,
    /// Items that were finished before.
    finished: usize,
    /// Items that were baked.
    baked: usize,
    /// Items that failed.
    failed: usize,
    /// Items that were not baked.
    waiting: usize,
    /// The requested items, in order.
    items: Vec<ItemSummary>,
}

/// Outcome of an item.
#[derive(Debug, Serialize, JsonSchema)]
struct ItemSummary {
    /// Number in the plan, from 0 on.
    item: usize,
    /// Key of the item.
    key: String,
    /// Folder of the maps, as in the plan.
    out: String,
    /// Status after the run.
    status: ItemStatus,
    /// Maps that were written.
    #[serde(skip_serializing_if = "Option::is_none")]
    maps: Option<usize>,
    /// Time that the bake took.
    #[serde(skip_serializing_if = "Option::is_none")]
    seconds: Option<f64>,
    /// Warnings for the artist, as sentences.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    warnings: Vec<String>,
    /// Error, if the item failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<ErrorReport>,
}

impl Summary {
    /// Returns a summary in which all items wait.
    pub(crate) fn new(path: &Path, plan: &BakePlan, chosen: &[usize]) -> Summary {
        let chosen = chosen.iter().filter_map(|at| plan.items.get(*at));
        let items: Vec<ItemSummary> = chosen
            .map(|item| ItemSummary {
                item: item.item,
                key: item.key.clone(),
                out: item.out.clone(),
                status: ItemStatus::Waiting,
                maps: None,
                seconds: None,
                warnings: Vec::new(),
                error: None,
            })
            .collect();
        Summary {
            plan: path.display().to_string(),
            finished: 0,
            baked: 0,
            failed: 0,
            waiting: items.len(),
            items,
        }
    }

    pub(crate) fn set(&mut self, at: usize, status: ItemStatus) {
        let Some(item) = self.item(at) else { return };
        let before = std::mem::replace(&mut item.status, status);
        *self.counter(before) -= 1;
        *self.counter(status) += 1;
    }

    fn counter(&mut self, status: ItemStatus) -> &mut usize {
        match status {
            ItemStatus::Finished => &mut self.finished,
            ItemStatus::Baked => &mut self.baked,
            ItemStatus::Failed => &mut self.failed,
            ItemStatus::Waiting => &mut self.waiting,
        }
    }

    pub(crate) fn baked(&mut self, at: usize, baked: BakedItem) {
        if let Some(item) = self.item(at) {
            item.maps = Some(baked.maps);
            item.seconds = Some(baked.seconds);
            item.warnings = baked.warnings;
        }
    }

    pub(crate) fn failed(&mut self, at: usize, error: ErrorReport) {
        if let Some(item) = self.item(at) {
            item.error = Some(error);
        }
    }

    pub(crate) fn count(&self, status: ItemStatus) -> usize {
        match status {
            ItemStatus::Finished => self.finished,
            ItemStatus::Baked => self.baked,
            ItemStatus::Failed => self.failed,
            ItemStatus::Waiting => self.waiting,
        }
    }

    fn item(&mut self, at: usize) -> Option<&mut ItemSummary> {
        // Items are sorted by their order in the plan.
        let found = self.items.binary_search_by_key(&at, |item| item.item).ok()?;
        self.items.get_mut(found)
    }

    /// Returns a line for each item.
    pub(crate) fn table(&self) -> Page {
        let line = |item: &ItemSummary| format!("{:>4}  {:8}  {}", item.item, item.status.name(), item.out);
        self.items.iter().map(line).collect()
    }

    /// Returns a sentence with the counts.
    pub(crate) fn sentence(&self, is_dry: bool) -> String {
        let counts = [
            (self.baked, "baked"),
            (self.finished, "finished before"),
            (self.failed, "failed"),
            (self.waiting, if is_dry { "to bake" } else { "not baked" }),
        ];
        let told: Vec<String> = counts
            .iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, words)| format!("{count} {words}"))
            .collect();
        format!("{}: {}", self.plan, told.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn item(item: usize) -> ItemSummary {
        ItemSummary {
            item,
            key: "key".to_owned(),
            out: "out".to_owned(),
            status: ItemStatus::Waiting,
            maps: None,
            seconds: None,
            warnings: Vec::new(),
            error: None,
        }
    }

    fn summary() -> Summary {
        Summary {
            plan: "plan.jsonl".to_owned(),
            finished: 0,
            baked: 0,
            failed: 0,
            waiting: 3,
            items: [2, 5, 7].map(item).into(),
        }
    }

    #[test]
    fn the_counts_are_those_of_the_items() {
        let mut summary = summary();
        summary.set(5, ItemStatus::Failed);
        summary.set(2, ItemStatus::Baked);
        assert_eq!(summary.sentence(false), "plan.jsonl: 1 baked, 1 failed, 1 not baked");
        summary.set(7, ItemStatus::Finished);
        assert_eq!(
            summary.sentence(false),
            "plan.jsonl: 1 baked, 1 finished before, 1 failed"
        );
    }
}
