//! Share of a run that is done.

use std::collections::BTreeMap;

use sabi_engine::phases::Phase;

/// Typical ends of the phases of a bake, as shares of its time.
const ENDS: [(Phase, f64); 5] = [
    (Phase::Load, 0.1),
    (Phase::Atlas, 0.2),
    (Phase::Upload, 0.25),
    (Phase::Run, 0.75),
    (Phase::Encode, 1.0),
];

/// Share of a run that is done, counted from the steps of its items.
#[derive(Clone, Debug)]
pub struct RunShare {
    of: usize,
    ended: usize,
    /// Share that is done of each item in work.
    shares: BTreeMap<usize, f64>,
}

impl RunShare {
    /// Creates the share of a run of this many items, of which none has begun.
    pub fn new(of: usize) -> RunShare {
        RunShare {
            of,
            ended: 0,
            shares: BTreeMap::new(),
        }
    }

    /// Records a step of an item's phase.
    pub fn step(&mut self, item: usize, phase: Phase, done: usize, of: usize) {
        let share = self.shares.entry(item).or_insert(0.0);
        *share = share.max(share_of(phase, done, of));
    }

    /// Records the end of an item.
    pub fn end(&mut self, item: usize) {
        self.shares.remove(&item);
        self.ended += 1;
    }

    /// Number of items.
    pub fn items(&self) -> usize {
        self.of
    }

    /// Number of items that have ended.
    pub fn ended(&self) -> usize {
        self.ended
    }

    /// Returns the share of the run that is done, 0 to 1.
    pub fn share(&self) -> f64 {
        let done = self.ended as f64 + self.shares.values().sum::<f64>();
        (done / self.of.max(1) as f64).clamp(0.0, 1.0)
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
    use sabi_engine::phases::Phase;

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
