//! Differences between the results of a plan and those of an earlier plan. If results differ only in some tiles, only these
//! tiles are computed again, in the textures of the earlier results.

use std::collections::{BTreeMap, BTreeSet};

use sabi_plan::{KernelStep, Plan, SlotRef, SourceStep, Step};

use crate::cache::ResultCache;
use crate::coverage::Coverages;
use crate::needed_steps::{needed_steps, reads, writes};
use crate::result_key::{ChangedResults, ResultKey};
use crate::shown_tiles::ShownTiles;
use crate::source_fill::SourceFill;
use crate::tile_set::TileSet;

/// Difference between the result of a step and the earlier result of the same step.
#[derive(Clone, Debug, PartialEq)]
enum Change {
    /// Only these tiles differ.
    Tiles(TileSet),
    /// Everything differs, or the difference is unknown.
    All,
}

/// Maximum number of tiles that are computed separately. If there are more, uploading all tiles is quicker.
const MOST_TILES: u32 = 4096;

/// Step of which only some tiles are computed again.
pub(crate) struct PartialStep {
    /// The tiles.
    pub(crate) tiles: TileSet,
    /// Textures of the earlier results, by slot.
    pub(crate) textures: Vec<(SlotRef, wgpu::Texture)>,
}

/// Differences between the results of a plan and those of an earlier plan.
#[derive(Default)]
pub(crate) struct Changes {
    /// Steps of which only some tiles are computed, by their index.
    pub(crate) parts: BTreeMap<usize, PartialStep>,
    /// Results whose differences from earlier results are known.
    pub(crate) results: ChangedResults,
}

impl Changes {
    /// Compares a plan, of which `steps` have to run, with the latest plan of the same steps, and takes the textures that
    /// will be changed in place from the cache.
    pub(crate) fn find(
        plan: &Plan,
        coverages: &Coverages<'_>,
        steps: &[usize],
        keys: &BTreeMap<SlotRef, ResultKey>,
        cache: &mut ResultCache,
        sources: &mut dyn SourceFill,
    ) -> Changes {
        let Some(before) = cache.latest_like(plan) else {
            return Changes::default();
        };
        let before_covered = coverages.of_plan(before);
        if !before_covered.is_same(coverages) {
            return Changes::default();
        }
        let old_keys = before_covered.slot_keys(before);
        let changes = changes([plan, before], [keys, &old_keys], &mut |old, step| {
            sources.changed_tiles(old, step)
        });
        // A texture whose earlier result is also requested must not be changed.
        let asked: BTreeSet<&ResultKey> = keys.values().collect();
        let mut found = Changes::default();
        for (slot, change) in &changes {
            if let (Change::Tiles(tiles), Some(key)) = (change, old_keys.get(slot)) {
                found.results.insert(*slot, (*key, tiles.clone()));
            }
        }
        for at in steps {
            let written = writes(&plan.steps[*at]);
            let known = written.iter().map(|slot| found.results.get(slot).cloned());
            let Some(known) = known.collect::<Option<Vec<(ResultKey, TileSet)>>>() else {
                continue;
            };
            let is_kept = known.iter().all(|(key, _)| cache.holds(key) && !asked.contains(key));
            let keys: BTreeSet<&ResultKey> = known.iter().map(|(key, _)| key).collect();
            if !is_kept || keys.len() < known.len() || known.is_empty() {
                continue;
            }
            let tiles = known.iter().fold(TileSet::default(), |all, (_, tiles)| all.and(tiles));
            let taken = known.iter().filter_map(|(key, _)| cache.take(key));
            let textures = written.into_iter().zip(taken).collect();
            found.parts.insert(*at, PartialStep { tiles, textures });
        }
        found
    }
}

impl ResultCache {
    /// Returns true if the plan would compute only some tiles of its results again, given that its sources differ from those of an earlier
    /// plan only in some tiles. The function returns whether that is true for a source step, before and now.
    pub fn would_run_in_part(
        &self,
        plan: &Plan,
        shown: Option<&ShownTiles>,
        is_in_part: &dyn Fn(&SourceStep, &SourceStep) -> bool,
    ) -> bool {
        let Some(before) = self.latest_like(plan) else {
            return false;
        };
        let [covered, before_covered] = [plan, before].map(|plan| Coverages::of(plan, shown));
        if !covered.is_same(&before_covered) {
            return false;
        }
        let (keys, old_keys) = (covered.slot_keys(plan), before_covered.slot_keys(before));
        let steps = needed_steps(plan, &self.find(&keys).into_keys().collect());
        // The set of tiles does not matter here, so any tile is used.
        let changes = changes([plan, before], [&keys, &old_keys], &mut |old, step| {
            is_in_part(old, step).then(|| TileSet::new([[0; 3]]))
        });
        steps.iter().flat_map(|at| writes(&plan.steps[*at])).all(|slot| {
            let is_kept = old_keys.get(&slot).is_some_and(|key| self.holds(key));
            is_kept && matches!(changes.get(&slot), Some(Change::Tiles(_)))
        })
    }
}

/// Returns the difference of each slot of a plan from the same slot of an earlier plan of the same steps. `changed_tiles`
/// returns the tiles in which a source differs from the earlier one, if they are known.
fn changes(
    [plan, before]: [&Plan; 2],
    [keys, old_keys]: [&BTreeMap<SlotRef, ResultKey>; 2],
    changed_tiles: &mut dyn FnMut(&SourceStep, &SourceStep) -> Option<TileSet>,
) -> BTreeMap<SlotRef, Change> {
    let mut changes: BTreeMap<SlotRef, Change> = BTreeMap::new();
    for (step, old) in plan.steps.iter().zip(&before.steps) {
        // Slots that no step writes do not exist.
        let of_reads = reads(step)
            .iter()
            .map(|slot| changes.get(slot).cloned().unwrap_or(Change::All))
            .reduce(|all, change| match (all, change) {
                (Change::Tiles(all), Change::Tiles(tiles)) => Change::Tiles(all.and(&tiles)),
                _ => Change::All,
            })
            .unwrap_or_else(|| Change::Tiles(TileSet::default()));
        // If the key of the result has changed but the key of no input has, then the node itself has changed.
        let reads_others = reads(step).iter().any(|slot| keys.get(slot) != old_keys.get(slot));
        let change = match (step, old) {
            (Step::Source(step), Step::Source(old)) => of_source(step, old, of_reads, changed_tiles),
            (Step::Kernel(step), Step::Kernel(old)) if is_same(step, old) => match of_reads {
                Change::Tiles(tiles) if step.keys == old.keys => Change::Tiles(tiles),
                Change::Tiles(tiles) if step.is_of_points() && reads_others => Change::Tiles(tiles),
                _ => Change::All,
            },
            (Step::Move(_) | Step::Survey(_), _) => match of_reads {
                Change::Tiles(tiles) if tiles.count() == 0 => Change::Tiles(tiles),
                _ => Change::All,
            },
            _ => Change::All,
        };
        changes.extend(writes(step).into_iter().map(|slot| (slot, change.clone())));
    }
    changes
}

fn of_source(
    step: &SourceStep,
    old: &SourceStep,
    of_reads: Change,
    changed_tiles: &mut dyn FnMut(&SourceStep, &SourceStep) -> Option<TileSet>,
) -> Change {
    if step.keys == old.keys {
        return Change::Tiles(TileSet::default());
    }
    let Change::Tiles(tiles) = of_reads else {
        return Change::All;
    };
    match changed_tiles(old, step) {
        Some(own) if own.count() <= MOST_TILES => Change::Tiles(own.and(&tiles)),
        Some(_) | None => Change::All,
    }
}

/// Returns true if a kernel computes the same results from the same inputs.
fn is_same(step: &KernelStep, old: &KernelStep) -> bool {
    step.blocks == old.blocks
        && step.flags == old.flags
        && step.feedback == old.feedback
        && step.rays == old.rays
        && step.fills_ghosts == old.fills_ghosts
}
