//! Changes of a plan to the results of a plan that was run before: where only some tiles differ, only these are computed again, in the
//! textures of before.

use std::collections::{BTreeMap, BTreeSet};

use sabi_plan::{KernelStep, Plan, SlotRef, SourceStep, Step};

use crate::cache::ResultCache;
use crate::coverage::Coverages;
use crate::needed_steps::{needed_steps, reads, writes};
use crate::result_key::{ChangedResults, ResultKey};
use crate::shown_tiles::ShownTiles;
use crate::source_fill::SourceFill;
use crate::tile_set::TileSet;

/// Difference of a result from that of the same step before.
#[derive(Clone, Debug, PartialEq)]
enum Change {
    /// Nothing but these tiles.
    Tiles(TileSet),
    /// Unknown, or everything.
    All,
}

/// Most tiles that are computed by themselves: more are quicker to upload together with all others.
const MOST_TILES: u32 = 4096;

/// Step that computes only some tiles again.
pub(crate) struct Part {
    /// The tiles.
    pub(crate) tiles: TileSet,
    /// Textures of the results of before, by slot.
    pub(crate) textures: Vec<(SlotRef, wgpu::Texture)>,
}

/// Changes of a plan to the results of an earlier one.
#[derive(Default)]
pub(crate) struct Changes {
    /// Steps that compute some tiles alone, by their index.
    pub(crate) parts: BTreeMap<usize, Part>,
    /// Results whose differences from results of before are known.
    pub(crate) results: ChangedResults,
}

impl Changes {
    /// Holds a plan, of which these steps have to run, against the latest plan of the same steps, and takes the textures that are
    /// changed in place from the cache.
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
        // A texture whose result is asked for as well stays as it is.
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
            found.parts.insert(*at, Part { tiles, textures });
        }
        found
    }
}

impl ResultCache {
    /// Returns true if a plan would compute only some tiles of its results again, where its sources differ from those of a plan before in
    /// some tiles, as the function says of a step before and now.
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
        // Any tile stands for those that differ.
        let changes = changes([plan, before], [&keys, &old_keys], &mut |old, step| {
            is_in_part(old, step).then(|| TileSet::new([[0; 3]]))
        });
        steps.iter().flat_map(|at| writes(&plan.steps[*at])).all(|slot| {
            let is_kept = old_keys.get(&slot).is_some_and(|key| self.holds(key));
            is_kept && matches!(changes.get(&slot), Some(Change::Tiles(_)))
        })
    }
}

/// Difference of each slot of a plan from the same slot of a plan of the same steps. `changed_tiles` gives the tiles in which a source
/// differs from the one before, where that is known.
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
        // Another key of the result, while no input has another one, says that the node itself is another one.
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

/// Returns true if a kernel computes the same of the same inputs.
fn is_same(step: &KernelStep, old: &KernelStep) -> bool {
    step.blocks == old.blocks
        && step.flags == old.flags
        && step.feedback == old.feedback
        && step.rays == old.rays
        && step.fills_ghosts == old.fills_ghosts
}
