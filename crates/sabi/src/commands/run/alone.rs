//! Bake of a single item in this process.

use std::time::Instant;

use sabi_batch::BakePlan;
use sabi_engine::baking::bake;
use sabi_files::TrustedPaths;

use super::item_process::BakedItem;
use crate::advice::with_flags;
use crate::arguments::RunArguments;
use crate::exit::{Exit, Failure};
use crate::progress::ShownProgress;
use crate::stopping::cancel_when_input_ends;
use crate::terminal::{Terminal, json_failure};

/// Bakes the first of the chosen items. The process that started this one prints a failure.
pub(super) fn run(
    arguments: &RunArguments,
    trusted: &TrustedPaths,
    plan: &BakePlan,
    chosen: &[usize],
    terminal: &Terminal,
) -> Result<Exit, Failure> {
    cancel_when_input_ends();
    match baked(arguments, trusted, plan, chosen, terminal) {
        Ok(baked) => terminal.json(&baked).map(|()| Exit::Done),
        Err(failure) => {
            json_failure(&failure, terminal.command());
            Ok(failure.exit)
        }
    }
}

fn baked(
    arguments: &RunArguments,
    trusted: &TrustedPaths,
    plan: &BakePlan,
    chosen: &[usize],
    terminal: &Terminal,
) -> Result<BakedItem, Failure> {
    let started = Instant::now();
    let item = chosen
        .first()
        .and_then(|at| plan.items.get(*at))
        .ok_or_else(|| Failure::new(Exit::Usage, "there is no item to bake".to_owned()))?;
    let request = item.request(&plan.base, &arguments.item_machine(trusted));
    let report = bake(&request, &ShownProgress::new(terminal))?;
    let warnings = report.warnings.iter();
    Ok(BakedItem {
        maps: report.outputs.len(),
        seconds: (started.elapsed().as_secs_f64() * 1000.0).round() / 1000.0,
        warnings: warnings
            .map(|warning| with_flags(&warning.sentence, &warning.remedies, terminal.command()))
            .collect(),
    })
}
