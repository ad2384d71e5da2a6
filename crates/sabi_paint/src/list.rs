//! Lists of strokes, by version.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::step_bytes::{decode_step, encode_step};
use crate::stroke::{Step, Stroke};
use crate::version::Version;

/// Number of lists that are kept in memory; others are computed from their steps again.
const READY_LISTS: usize = 32;

/// The strokes of a version, from the lowest to the topmost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StrokeList {
    /// The strokes. A stroke that did not change from one version to the next is the same object in memory.
    pub strokes: Vec<Arc<Stroke>>,
}

impl StrokeList {
    /// Returns a number that none of its groups has.
    pub fn free_group_number(&self) -> u32 {
        let numbers = self
            .strokes
            .iter()
            .filter_map(|stroke| Some(stroke.group.as_ref()?.number));
        numbers.max().map_or(1, |number| number.saturating_add(1))
    }
}

/// A step that leads to a version.
#[derive(Clone, Debug)]
struct KnownStep {
    before: Version,
    step: Step,
    /// The step in the form in which a file stores it. It is stored again exactly as it was read, even if brushes have new
    /// values since then, because the name of the version is a hash of these bytes.
    bytes: Arc<[u8]>,
}

/// All known versions.
#[derive(Clone, Debug, Default)]
pub struct StrokeBook {
    steps: BTreeMap<Version, KnownStep>,
    ready: BTreeMap<Version, Arc<StrokeList>>,
    /// Versions in `ready`. The one used last is at the end.
    used: Vec<Version>,
}

impl StrokeBook {
    /// Adds a step after a version, and returns the version that it leads to.
    pub fn push(&mut self, before: Version, step: &Step) -> Version {
        let bytes = encode_step(step);
        let version = before.after(&bytes);
        // The step is decoded from its bytes, so that a stroke is the same before and after it is stored.
        match decode_step(&bytes, version) {
            Some(step) => {
                self.insert(version, before, step, bytes.into());
                version
            }
            // A step that no file could store changes nothing.
            None => before,
        }
    }

    /// Adds a step that was read, with its bytes.
    pub(crate) fn insert(&mut self, version: Version, before: Version, step: Step, bytes: Arc<[u8]>) {
        self.steps.entry(version).or_insert(KnownStep { before, step, bytes });
    }

    /// Returns the versions from which no known step leads on, sorted by name.
    pub fn ends(&self) -> Vec<Version> {
        let left: BTreeSet<Version> = self.steps.values().map(|known| known.before).collect();
        let all = self.steps.keys().copied();
        all.filter(|version| !left.contains(version)).collect()
    }

    /// Returns true if the step that leads to a version is known. Earlier steps may be lost.
    pub fn knows(&self, version: Version) -> bool {
        self.steps.contains_key(&version)
    }

    /// Forgets a version that nothing refers to and from which no step leads on, for example an unfinished stroke.
    pub fn forget(&mut self, version: Version) {
        self.steps.remove(&version);
        self.ready.remove(&version);
        self.used.retain(|used| *used != version);
    }

    /// Returns the bytes of the known steps to a version, in order, each with the version that it leads to and the version
    /// before. They begin at the empty list, or after lost steps. Empty for an unknown version.
    pub(crate) fn way_to(&self, version: Version) -> Vec<(Version, Version, &[u8])> {
        let mut way = Vec::new();
        let mut at = version;
        // The number of rounds is limited, since a forged file could contain a circle.
        while let Some(known) = self.steps.get(&at).filter(|_| way.len() < self.steps.len()) {
            way.push((at, known.before, &*known.bytes));
            at = known.before;
        }
        way.reverse();
        way
    }

    /// Returns the strokes of a version, without those whose steps are lost; `None` if the version itself is unknown.
    pub fn list(&mut self, version: Version) -> Option<Arc<StrokeList>> {
        if let Some(list) = self.ready.get(&version).cloned() {
            self.used.retain(|used| *used != version);
            self.used.push(version);
            return Some(list);
        }
        if version != Version::EMPTY && !self.knows(version) {
            return None;
        }
        let mut steps = Vec::new();
        let mut at = version;
        let mut strokes = loop {
            if let Some(list) = self.ready.get(&at) {
                break list.strokes.clone();
            }
            let Some(known) = self.steps.get(&at).filter(|_| steps.len() < self.steps.len()) else {
                break Vec::new();
            };
            steps.push(&known.step);
            at = known.before;
        };
        for step in steps.into_iter().rev() {
            apply(&mut strokes, step);
        }
        let list = Arc::new(StrokeList { strokes });
        self.ready.insert(version, Arc::clone(&list));
        self.used.push(version);
        if self.used.len() > READY_LISTS {
            let oldest = self.used.remove(0);
            self.ready.remove(&oldest);
        }
        Some(list)
    }
}

fn apply(strokes: &mut Vec<Arc<Stroke>>, step: &Step) {
    match step {
        Step::Add(stroke) => strokes.push(Arc::clone(stroke)),
        Step::Remove(removed) => strokes.retain(|stroke| !removed.contains(&stroke.id)),
        Step::Change {
            stroke: id,
            name,
            brush,
            is_hidden,
        } => {
            if let Some(stroke) = strokes.iter_mut().find(|stroke| stroke.id == *id) {
                *stroke = Arc::new(Stroke {
                    name: name.clone(),
                    brush: (**brush).clone(),
                    is_hidden: *is_hidden,
                    ..(**stroke).clone()
                });
            }
        }
        Step::Place {
            stroke: id,
            points,
            path,
            eye,
            stencil,
        } => {
            if let Some(stroke) = strokes.iter_mut().find(|stroke| stroke.id == *id) {
                *stroke = Arc::new(Stroke {
                    points: points.clone(),
                    path: path.clone(),
                    eye: *eye,
                    stencil: stencil.clone(),
                    ..(**stroke).clone()
                });
            }
        }
        Step::Group {
            strokes: members,
            group,
        } => {
            for stroke in strokes.iter_mut().filter(|stroke| members.contains(&stroke.id)) {
                *stroke = Arc::new(Stroke {
                    group: group.clone(),
                    ..(**stroke).clone()
                });
            }
        }
        Step::Move { stroke: id, to } => {
            if let Some(from) = strokes.iter().position(|stroke| stroke.id == *id) {
                let stroke = strokes.remove(from);
                strokes.insert((*to).min(strokes.len()), stroke);
            }
        }
    }
}
