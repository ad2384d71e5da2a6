//! Tiles in which each step of a plan is computed if only part of the surface is shown.

use std::collections::BTreeMap;

use sabi_plan::{KernelStep, Level, Plan, SlotRef, Step};

use crate::needed_steps::{reads, slot_keys, writes};
use crate::result_key::ResultKey;
use crate::shown_tiles::{CoveredTiles, ShownTiles};
use crate::tile_set::TileSet;

/// Tiles in which the result of a step is needed, from few to all.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Coverage {
    /// The shown tiles.
    Shown,
    /// The shown tiles, and those from which their ghosts take values.
    Linked,
    /// The linked tiles, the tiles around them, and those from which the ghosts of all these take values.
    Around,
    /// All tiles: a filter or a survey may read any texel.
    All,
}

/// Coverage of the steps of a plan.
pub(crate) struct Coverages<'a> {
    of_steps: Vec<Coverage>,
    shown: Option<&'a ShownTiles>,
}

impl<'a> Coverages<'a> {
    /// Finds the coverage of each step of a plan whose results are shown in some tiles. Without `shown`, all steps cover all tiles.
    pub(crate) fn of(plan: &Plan, shown: Option<&'a ShownTiles>) -> Coverages<'a> {
        let of_steps = match shown {
            Some(_) => coverage_of_steps(plan),
            None => vec![Coverage::All; plan.steps.len()],
        };
        Coverages { of_steps, shown }
    }

    /// Returns the coverage of another plan whose results are shown in the same tiles.
    pub(crate) fn of_plan(&self, plan: &Plan) -> Coverages<'a> {
        Coverages::of(plan, self.shown)
    }

    /// Returns the tiles that a step computes; `None` for all.
    pub(crate) fn tiles(&self, step: usize) -> Option<&'a TileSet> {
        Some(&self.covered(step)?.tiles)
    }

    /// Returns the key of the tiles that a step computes; `None` for all.
    pub(crate) fn key(&self, step: usize) -> Option<[u8; 32]> {
        Some(self.covered(step)?.key)
    }

    fn covered(&self, step: usize) -> Option<&'a CoveredTiles> {
        let shown = self.shown?;
        match self.of_steps.get(step)? {
            Coverage::Shown => Some(&shown.shown),
            Coverage::Linked => Some(&shown.linked),
            Coverage::Around => Some(&shown.around),
            Coverage::All => None,
        }
    }

    /// Returns the keys of [`slot_keys`] for a plan, with the tiles in which the slots are computed.
    pub(crate) fn slot_keys(&self, plan: &Plan) -> BTreeMap<SlotRef, ResultKey> {
        let mut keys = slot_keys(plan);
        for (at, step) in plan.steps.iter().enumerate() {
            for slot in writes(step) {
                if let Some(key) = keys.get_mut(&slot) {
                    key.tiles = self.key(at);
                }
            }
        }
        keys
    }

    /// Returns true if the steps of two plans cover the same tiles.
    pub(crate) fn is_same(&self, other: &Coverages<'_>) -> bool {
        self.of_steps == other.of_steps
    }
}

/// Returns the coverage of each step, computed from the last step to the first. A step whose texels depend only on the same texels of its
/// inputs is needed where its readers are. A step that casts rays is also needed where shown ghosts take values from, and around these if
/// it is denoised. An input of a filter, of a survey or of another level is needed everywhere.
fn coverage_of_steps(plan: &Plan) -> Vec<Coverage> {
    let results = plan.results.iter().flat_map(|result| &result.slots);
    let mut needed: BTreeMap<SlotRef, Coverage> = results.map(|slot| (*slot, Coverage::Shown)).collect();
    let mut coverages = Vec::new();
    for step in plan.steps.iter().rev() {
        let of_results: Vec<Coverage> = writes(step).iter().filter_map(|slot| needed.remove(slot)).collect();
        let needed_in = of_results.into_iter().max().unwrap_or(Coverage::All);
        let coverage = match step {
            Step::Kernel(kernel) if kernel.is_of_points() => needed_in,
            // The ghosts of shown tiles are filled from the texels that they are linked to.
            Step::Kernel(kernel) if casts_from_texels(kernel) || denoises(kernel) => match needed_in {
                Coverage::Shown => Coverage::Linked,
                // Only owned texels of such a result are read, so nothing beyond them is needed.
                Coverage::Around if !denoises(kernel) => Coverage::Around,
                Coverage::Linked | Coverage::Around | Coverage::All => Coverage::All,
            },
            Step::Source(_) => needed_in,
            Step::Kernel(_) | Step::Move(_) | Step::Survey(_) => Coverage::All,
        };
        let of_reads = match step {
            // A source may read texels next to its own, for example the places at which a picture is read.
            Step::Source(_) => Coverage::All,
            // Texels up to two away are read.
            Step::Kernel(kernel) if denoises(kernel) && coverage == Coverage::Linked => Coverage::Around,
            _ => coverage,
        };
        for slot in reads(step) {
            let known = needed.entry(slot).or_insert(of_reads);
            *known = of_reads.max(*known);
        }
        coverages.push(coverage);
    }
    coverages.reverse();
    coverages
}

/// Returns true if each owned texel depends only on means over rays of the texels up to two away, and on the same texel of the inputs.
fn denoises(step: &KernelStep) -> bool {
    step.spec.calls.iter().any(|call| call.normals.is_some()) && step.level == Level::FINEST && step.feedback.is_none()
}

/// Returns true if each owned texel depends only on its own rays and on the same texel of the inputs.
fn casts_from_texels(step: &KernelStep) -> bool {
    step.rays.is_some() && step.level == Level::FINEST && step.feedback.is_none()
}
