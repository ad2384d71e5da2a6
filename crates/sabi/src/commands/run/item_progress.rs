//! Progress of a run for programs: events, or lines of Open Job Description.

use sabi_batch::running::{ItemStatus, RunShare};
use sabi_engine::phases::Phase;

use crate::arguments::ProgressChoice;
use crate::event::Event;
use crate::exit::Failure;
use crate::openjd;
use crate::terminal::Terminal;

/// Progress of the items of a run.
pub(super) struct ItemProgress {
    terminal: Terminal,
    run: RunShare,
    /// Progress that was last printed, in tenths of a percent.
    told: u64,
}

impl ItemProgress {
    pub(super) fn new(terminal: Terminal, of: usize) -> ItemProgress {
        ItemProgress {
            terminal,
            run: RunShare::new(of),
            told: 0,
        }
    }

    /// Prints a step of an item's phase.
    pub(super) fn step(&mut self, item: usize, phase: Phase, done: usize, of: usize) -> Result<(), Failure> {
        self.run.step(item, phase, done, of);
        match self.terminal.progress() {
            ProgressChoice::Json => {
                self.terminal.event(&Event::phase_of(item, phase, done, of));
                Ok(())
            }
            ProgressChoice::Openjd => self.tell_share(),
            ProgressChoice::Auto | ProgressChoice::Plain | ProgressChoice::None => Ok(()),
        }
    }

    /// Prints that an item has ended, and `sentence` with the result.
    pub(super) fn end(&mut self, item: usize, status: ItemStatus, sentence: &str) -> Result<(), Failure> {
        self.run.end(item);
        match self.terminal.progress() {
            ProgressChoice::Json => {
                let (status, done, of) = (status.name(), self.run.ended(), self.run.items());
                self.terminal.event(&Event::Item { item, status, done, of });
                Ok(())
            }
            ProgressChoice::Openjd => {
                match status {
                    ItemStatus::Failed => openjd::fail(&self.terminal, sentence)?,
                    ItemStatus::Finished | ItemStatus::Baked | ItemStatus::Waiting => {
                        openjd::status(&self.terminal, sentence)?;
                    }
                }
                self.tell_share()
            }
            ProgressChoice::Auto | ProgressChoice::Plain | ProgressChoice::None => Ok(()),
        }
    }

    /// Prints the share of the run that is done, if it is at least one percent more than the last one printed.
    fn tell_share(&mut self) -> Result<(), Failure> {
        let share = self.run.share();
        let tenths = (share * 1000.0) as u64;
        let is_end = self.run.ended() == self.run.items() && self.told < 1000;
        if tenths < self.told + 10 && !is_end {
            return Ok(());
        }
        self.told = tenths;
        openjd::progress(&self.terminal, share)
    }
}
