//! `sabi run`: bakes the items of a plan, each in a separate process.

mod alone;
mod item_process;
mod item_progress;
pub(crate) mod summary;

use std::collections::BTreeSet;
use std::io::{self, Write as _};

use sabi_batch::running::{ItemEvent, ItemStatus, Queue};
use sabi_batch::{BakeItem, BakePlan, InputHashes};
use sabi_engine::remedy::advised;
use sabi_files::{PathBase, TrustedPaths};

use crate::arguments::{ProgressChoice, RunArguments};
use crate::exit::{Exit, Failure};
use crate::failure_report::ErrorReport;
use crate::printable::printable;
use crate::stopping::{is_canceled, listen_for_signals};
use crate::terminal::Terminal;
use item_process::{BakedItem, Ended, command, end_of, is_event, step_of};
use item_progress::ItemProgress;
use summary::Summary;

pub(crate) fn run(arguments: &RunArguments, trusted: &TrustedPaths, terminal: &Terminal) -> Result<Exit, Failure> {
    let plan = BakePlan::open(&arguments.plan)?;
    let chosen = chosen(arguments, &plan)?;
    if arguments.alone {
        return alone::run(arguments, trusted, &plan, &chosen, terminal);
    }
    listen_for_signals(*terminal);
    let mut run = Run {
        terminal,
        arguments,
        trusted,
        progress: ItemProgress::new(*terminal, chosen.len()),
        summary: Summary::new(&arguments.plan, &plan, &chosen),
        plan,
    };
    let waiting = run.sort(&chosen)?;
    if !arguments.dry_run {
        run.bake(&waiting)?;
    }
    run.end()
}

/// Returns the items that the command line lists, in their order; all items without a list.
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
    trusted: &'a TrustedPaths,
    plan: BakePlan,
    summary: Summary,
    progress: ItemProgress,
}

impl Run<'_> {
    /// Returns the items that have to be baked, and prints which items have inputs that differ from the plan.
    fn sort(&mut self, chosen: &[usize]) -> Result<Vec<usize>, Failure> {
        let mut hashes = InputHashes::default();
        let mut waiting = Vec::new();
        for at in chosen {
            if is_canceled() {
                break;
            }
            let item = &self.plan.items[*at];
            match item.refuse_changed(&self.plan.base, &mut hashes) {
                Err(error) => {
                    let failure = Failure::from(error);
                    self.failed(*at, &failure)?;
                }
                Ok(()) if !self.arguments.again && item.is_finished(&self.plan.base, &mut hashes) => {
                    let sentence = format!("{}: finished before", self.name(*at));
                    self.end_item(*at, ItemStatus::Finished, &sentence)?;
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
        let (arguments, trusted) = (self.arguments, self.trusted);
        let command = |item| command(arguments, trusted, item);
        let mut queue = Queue::new(waiting.iter().copied(), arguments.jobs as usize, command);
        while let Some((at, event)) = queue.next(is_canceled) {
            match event {
                ItemEvent::Line(line) => self.line(at, &line)?,
                ItemEvent::Ended(Err(error)) => self.failed(at, &error.into())?,
                ItemEvent::Ended(Ok(process)) => match end_of(&process) {
                    Ended::Baked(baked) => self.baked(at, baked)?,
                    Ended::Failed(failure) => self.failed(at, &failure)?,
                    Ended::Stopped if is_canceled() => {}
                    Ended::Stopped => {
                        let why = "the process of the item was stopped by another one".to_owned();
                        self.failed(at, &Failure::new(Exit::Interrupted, why))?;
                    }
                },
            }
        }
        Ok(())
    }

    /// Shows the progress of an item, or prints another line of its process.
    fn line(&mut self, at: usize, line: &str) -> Result<(), Failure> {
        match step_of(line) {
            Some((phase, done, of)) => return self.progress.step(at, phase, done, of),
            None if is_event(line) => {}
            // Standard error may be closed; then the line is lost.
            None => drop(writeln!(io::stderr().lock(), "{}", printable(line))),
        }
        Ok(())
    }

    fn baked(&mut self, at: usize, baked: BakedItem) -> Result<(), Failure> {
        let name = self.name(at);
        for warning in &baked.warnings {
            self.terminal.note(format_args!("{name}: warning: {warning}"));
        }
        let maps = if baked.maps == 1 { "map" } else { "maps" };
        let sentence = format!("{name}: {} {maps} in {:.2} s", baked.maps, baked.seconds);
        self.terminal.note(&sentence);
        self.summary.baked(at, baked);
        self.end_item(at, ItemStatus::Baked, &sentence)
    }

    /// Prints that an item failed.
    fn failed(&mut self, at: usize, failure: &Failure) -> Result<(), Failure> {
        let name = self.name(at);
        let error = ErrorReport::new(failure, self.terminal.command());
        let mut sentences: Vec<String> = failure.messages.iter().map(|why| format!("{name}: {why}")).collect();
        if let Some(last) = sentences.last_mut() {
            *last = advised(last, error.remedies.iter());
        }
        for sentence in &sentences {
            self.terminal.error(sentence);
        }
        self.summary.failed(at, error);
        self.end_item(at, ItemStatus::Failed, &sentences.join("; "))
    }

    /// Records the end of an item, and prints its folder if that contains all maps.
    fn end_item(&mut self, at: usize, status: ItemStatus, sentence: &str) -> Result<(), Failure> {
        self.summary.set(at, status);
        self.progress.end(at, status, sentence)?;
        let is_whole = matches!(status, ItemStatus::Finished | ItemStatus::Baked);
        if is_whole && self.lists_folders() {
            // The folder is printed as the plan names it.
            let folder = self.plan.items[at].folder(&PathBase::of_file(&self.arguments.plan));
            self.terminal.paths([folder])?;
        }
        Ok(())
    }

    /// Returns true if standard output is used for the folders of items.
    fn lists_folders(&self) -> bool {
        let is_taken = self.arguments.json || self.arguments.dry_run;
        !is_taken && self.terminal.progress() != ProgressChoice::Openjd
    }

    /// Returns the name of an item for messages.
    fn name(&self, at: usize) -> String {
        let BakeItem { out, .. } = &self.plan.items[at];
        format!("item {at} of {}: {out}", self.plan.items.len())
    }

    fn end(self) -> Result<Exit, Failure> {
        if self.arguments.json {
            self.terminal.json(&self.summary)?;
        } else if self.arguments.dry_run {
            self.terminal.page(&self.summary.table())?;
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
