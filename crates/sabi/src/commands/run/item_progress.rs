//! Progress of a run for programs: events, or lines of Open Job Description.

use std::collections::BTreeMap;

use sabi_engine::Phase;

use super::summary::ItemStatus;
use crate::arguments::ProgressChoice;
use crate::event::Event;
use crate::exit::Failure;
use crate::openjd;
use crate::terminal::Terminal;

/// Typical ends of the phases of a bake, as shares of its time.
const ENDS: [(Phase, f64); 5] = [
    (Phase::Load, 0.1),
    (Phase::Atlas, 0.2),
    (Phase::Upload, 0.25),
    (Phase::Run, 0.75),
    (Phase::Encode, 1.0),
];

/// Progress of the items of a run.
pub(super) struct ItemProgress {
    terminal: Terminal,
    of: usize,
    done: usize,
    /// Share that is done of each item in work.
    shares: BTreeMap<usize, f64>,
    /// Progress that was last printed, in tenths of a percent.
    told: u64,
}

impl ItemProgress {
    pub(super) fn new(terminal: Terminal, of: usize) -> ItemProgress {
        ItemProgress {
            terminal,
            of,
            done: 0,
            shares: BTreeMap::new(),
            told: 0,
        }
    }

    /// Prints a step of an item's phase.
    pub(super) fn step(&mut self, item: usize, phase: Phase, done: usize, of: usize) -> Result<(), Failure> {
        let share = self.shares.entry(item).or_insert(0.0);
        *share = share.max(share_of(phase, done, of));
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
        self.shares.remove(&item);
        self.done += 1;
        match self.terminal.progress() {
            ProgressChoice::Json => {
                let (status, done, of) = (status.name(), self.done, self.of);
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
        let done = self.done as f64 + self.shares.values().sum::<f64>();
        let share = (done / self.of.max(1) as f64).clamp(0.0, 1.0);
        let tenths = (share * 1000.0) as u64;
        let is_end = self.done == self.of && self.told < 1000;
        if tenths < self.told + 10 && !is_end {
            return Ok(());
        }
        self.told = tenths;
        openjd::progress(&self.terminal, share)
    }
}

/// Returns the share of a bake that is done.
fn share_of(phase: Phase, done: usize, of: usize) -> f64 {
    let at = ENDS.iter().position(|(known, _)| *known == phase);
    let Some(at) = at else { return 0.0 };
    let begin = at.checked_sub(1).map_or(0.0, |before| ENDS[before].1);
    let part = done as f64 / of.max(1) as f64;
    begin + (ENDS[at].1 - begin) * part.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use sabi_engine::Phase;

    use super::share_of;

    #[test]
    fn the_share_of_a_bake_grows_from_phase_to_phase() {
        assert_eq!(share_of(Phase::Load, 0, 1), 0.0);
        assert_eq!(share_of(Phase::Load, 1, 1), share_of(Phase::Atlas, 0, 4));
        assert_eq!(share_of(Phase::Run, 1, 2), 0.5);
        assert_eq!(share_of(Phase::Encode, 3, 3), 1.0);
        assert_eq!(share_of(Phase::Encode, 9, 3), 1.0, "more than all is all");
    }
}
