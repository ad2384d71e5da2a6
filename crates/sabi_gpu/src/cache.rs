//! Cache of results by content key; least recently used results are dropped when the budget is full.

use std::collections::BTreeMap;

use sabi_nodes::link::Plane;
use sabi_plan::{Plan, SlotRef};

use crate::rays::HitCache;

/// Key of the content of one texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ResultKey {
    /// Hash of everything that can change the result.
    pub content: [u8; 32],
    /// Plane of the result.
    pub plane: Plane,
}

struct CachedTexture {
    texture: wgpu::Texture,
    bytes: u64,
    last_used: u64,
}

/// Cached results of earlier runs on one surface.
pub struct ResultCache {
    budget_bytes: u64,
    bytes: u64,
    runs: u64,
    textures: BTreeMap<ResultKey, CachedTexture>,
    /// Cached ray hits, within a quarter of the budget.
    pub(crate) hits: HitCache,
}

impl ResultCache {
    /// An empty cache with a budget.
    pub fn new(budget_bytes: u64) -> ResultCache {
        ResultCache {
            budget_bytes,
            bytes: 0,
            runs: 0,
            textures: BTreeMap::new(),
            hits: HitCache::new(budget_bytes / 4),
        }
    }

    /// Bytes held, and the budget.
    pub fn bytes(&self) -> (u64, u64) {
        (self.bytes + self.hits.bytes(), self.budget_bytes)
    }

    /// Returns true if any plane of a result is cached; `content` is a key of the plan.
    pub fn contains(&self, content: &[u8; 32]) -> bool {
        self.textures.keys().any(|key| key.content == *content)
    }

    /// Drops all results.
    pub fn clear(&mut self) {
        *self = ResultCache::new(self.budget_bytes);
    }

    /// Cached textures by slot.
    pub(crate) fn find(&self, keys: &BTreeMap<SlotRef, ResultKey>) -> BTreeMap<SlotRef, wgpu::Texture> {
        keys.iter()
            .filter_map(|(slot, key)| Some((*slot, self.textures.get(key)?.texture.clone())))
            .collect()
    }

    /// Stores the results of a run, marks those that it used, and drops the least recently used ones over the budget.
    pub(crate) fn insert(
        &mut self,
        keys: &BTreeMap<SlotRef, ResultKey>,
        textures: &[Option<wgpu::Texture>],
        plan: &Plan,
        texels: u64,
    ) {
        self.runs += 1;
        for (slot, key) in keys {
            let Some(texture) = &textures[*slot] else { continue };
            let bytes = plan.slots[*slot].format.texel_bytes() * texels;
            let cached = CachedTexture {
                texture: texture.clone(),
                bytes,
                last_used: self.runs,
            };
            self.bytes += bytes;
            if let Some(before) = self.textures.insert(*key, cached) {
                self.bytes -= before.bytes;
            }
        }
        while self.bytes + self.hits.bytes() > self.budget_bytes {
            let oldest = self
                .textures
                .iter()
                .min_by_key(|(_, cached)| cached.last_used)
                .map(|(key, _)| *key);
            let Some(dropped) = oldest.and_then(|key| self.textures.remove(&key)) else {
                break;
            };
            self.bytes -= dropped.bytes;
        }
    }
}
