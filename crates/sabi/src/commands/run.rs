//! `sabi run`: the items of a plan are baked, each by a process of its own.
//!
//! A driver that crashes, or a system that takes memory back, then ends one item and no other; the memory of an item is free
//! once it has ended. Starting a process and opening the device for each takes tenths of a second.

mod alone;
mod item_process;
mod queue;
mod summary;

use std::collections::BTreeSet;

use sabi_engine::{BakeItem, BakePlan, InputHashes, PathBase, advised};

use crate::arguments::RunArguments;
use crate::exit::{Exit, Failure};
use crate::failure_report::ErrorReport;
use crate::progress::{is_canceled, listen_for_ctrl_c};
use crate::terminal::Terminal;
use item_process::Ended;
use queue::Queue;
use summary::{ItemStatus, Summary};

pub(crate) fn run(arguments: &RunArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let plan = BakePlan::open(&arguments.plan)?;
    let chosen = chosen(arguments, &plan)?;
    let base = PathBase::of_file(&arguments.plan);
    if arguments.alone {
        return alone::run(arguments, &plan, &base, &chosen, terminal);
    }
    listen_for_ctrl_c(*terminal);
    let mut run = Run {
        terminal,
        arguments,
        summary: Summary::new(&arguments.plan, &plan, &chosen),
        plan,
        base,
    };
    let waiting = run.sort(&chosen)?;
    if !arguments.dry_run {
        run.bake(&waiting)?;
    }
    run.end()
}

/// Items that the command line names, in their order; all without a list.
fn chosen(arguments: &RunArguments, plan: &BakePlan) -> Result<Vec<usize>, Failure> {
    let count = plan.items.len();
    let Some(list) = &arguments.items else {
        return Ok((0..count).collect());
    };
    let mut chosen = BTreeSet::new();
    for [first, last] in &list.0 {
        if *last >= count {
            let has = if count == 1 {
                "item 0 alone".to_owned()
            } else {
                format!("the items 0 to {}", count - 1)
            };
            let why = format!("there is no item {last}; {} has {has}", arguments.plan.display());
            return Err(Failure::new(Exit::Usage, why));
        }
        chosen.extend(*first..=*last);
    }
    Ok(chosen.into_iter().collect())
}

/// A run of a plan.
struct Run<'a> {
    terminal: &'a Terminal,
    arguments: &'a RunArguments,
    plan: BakePlan,
    base: PathBase,
    summary: Summary,
}

impl Run<'_> {
    /// Returns the items that have to be baked; tells those whose inputs are not as planned.
    fn sort(&mut self, chosen: &[usize]) -> Result<Vec<usize>, Failure> {
        let mut hashes = InputHashes::default();
        let mut waiting = Vec::new();
        for at in chosen {
            if is_canceled() {
                break;
            }
            let item = &self.plan.items[*at];
            match item.refuse_changed(&self.base, &mut hashes) {
                Err(error) => {
                    let failure = Failure::from(error);
                    self.failed(*at, &failure)?;
                }
                Ok(()) if !self.arguments.again && item.is_finished(&self.base) => {
                    self.status(*at, ItemStatus::Finished)?;
                }
                Ok(()) => waiting.push(*at),
            }
        }
        match self.summary.count(ItemStatus::Finished) {
            0 => {}
            1 => self.terminal.note("1 item is finished"),
            count => self.terminal.note(format_args!("{count} items are finished")),
        }
        Ok(waiting)
    }

    fn bake(&mut self, waiting: &[usize]) -> Result<(), Failure> {
        let mut queue = Queue::new(self.arguments, waiting);
        while let Some((at, ended)) = queue.next_ended(is_canceled) {
            match ended {
                Ended::Baked(baked) => {
                    let name = self.name(at);
                    for warning in &baked.warnings {
                        self.terminal.note(format_args!("{name}: warning: {warning}"));
                    }
                    let maps = if baked.maps == 1 { "map" } else { "maps" };
                    self.terminal
                        .note(format_args!("{name}: {} {maps} in {:.2} s", baked.maps, baked.seconds));
                    self.summary.baked(at, baked);
                    self.status(at, ItemStatus::Baked)?;
                }
                Ended::Failed(failure) => self.failed(at, &failure)?,
                Ended::Stopped => {}
            }
        }
        Ok(())
    }

    /// Tells that an item failed.
    fn failed(&mut self, at: usize, failure: &Failure) -> Result<(), Failure> {
        let name = self.name(at);
        let error = ErrorReport::new(failure, self.terminal.command());
        if let Some((last, others)) = failure.messages.split_last() {
            for sentence in others {
                self.terminal.error(&format!("{name}: {sentence}"));
            }
            self.terminal
                .error(&format!("{name}: {}", advised(last, error.remedies.clone())));
        }
        self.summary.failed(at, error);
        self.status(at, ItemStatus::Failed)
    }

    /// Notes the status of an item, and prints its folder once it has all its maps.
    fn status(&mut self, at: usize, status: ItemStatus) -> Result<(), Failure> {
        self.summary.set(at, status);
        let is_whole = matches!(status, ItemStatus::Finished | ItemStatus::Baked);
        if is_whole && !self.arguments.json && !self.arguments.dry_run {
            let folder = self.plan.items[at].folder(&self.base);
            self.terminal.data(&format!("{}\n", folder.display()))?;
        }
        Ok(())
    }

    /// Words for an item in messages.
    fn name(&self, at: usize) -> String {
        let BakeItem { out, .. } = &self.plan.items[at];
        format!("item {at} of {}: {out}", self.plan.items.len())
    }

    fn end(self) -> Result<Exit, Failure> {
        if self.arguments.json {
            self.terminal.json(&self.summary)?;
        } else if self.arguments.dry_run {
            self.terminal.data(&self.summary.table())?;
        }
        self.terminal.note(self.summary.sentence(self.arguments.dry_run));
        if is_canceled() {
            return Ok(Exit::Interrupted);
        }
        match self.summary.count(ItemStatus::Failed) {
            0 => Ok(Exit::Done),
            _ => Ok(Exit::SomeFailed),
        }
    }
}
