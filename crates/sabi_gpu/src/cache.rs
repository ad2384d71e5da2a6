//! Cache of results by content key; least recently used results are dropped when the budget is full.

use std::collections::{BTreeMap, VecDeque};

use sabi_plan::{Plan, SlotRef};

use crate::plan_likeness::is_alike;
use crate::rays::HitCache;
use crate::result_key::ResultKey;

/// Number of plans that are remembered: enough for all views of a window and some pictures of nodes.
const PLANS: usize = 12;
/// Number of results whose extents are remembered.
const EXTENTS: usize = 16;

/// Number of maps for which is remembered whether they have ghosts beyond a jump.
const JUMPS: usize = 64;

/// Key of a result, and number of its component.
pub(crate) type ExtentKey = (ResultKey, u32);

/// Extent of a tile: lowest key, highest key, and number of texels that are not a number.
pub(crate) type TileExtent = [u32; 3];

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
    /// Plans of the last runs, the latest first.
    plans: VecDeque<Plan>,
    /// Extents of tiles that were requested last, the latest at the end.
    extents: VecDeque<(ExtentKey, Vec<TileExtent>)>,
    /// For the maps that were examined last, the latest at the end: whether they have ghosts beyond a jump.
    jumps: VecDeque<(ResultKey, bool)>,
    /// Cached ray hits. They use at most a quarter of the budget.
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
            plans: VecDeque::new(),
            extents: VecDeque::new(),
            jumps: VecDeque::new(),
            hits: HitCache::new(budget_bytes / 4),
        }
    }

    /// Returns the number of bytes held, and the budget.
    pub fn bytes(&self) -> (u64, u64) {
        (self.bytes + self.hits.bytes(), self.budget_bytes)
    }

    /// Returns true if any plane of a result is cached. `content` is a content key of the plan.
    pub fn contains(&self, content: &[u8; 32]) -> bool {
        self.textures.keys().any(|key| key.content == *content)
    }

    /// Drops all results.
    pub fn clear(&mut self) {
        *self = ResultCache::new(self.budget_bytes);
    }

    /// Returns the latest remembered plan that has the same steps as `plan`.
    pub(crate) fn latest_like(&self, plan: &Plan) -> Option<&Plan> {
        self.plans.iter().find(|known| is_alike(known, plan))
    }

    /// Remembers a plan that was run.
    pub(crate) fn remember(&mut self, plan: &Plan) {
        self.plans.retain(|known| !is_alike(known, plan));
        self.plans.push_front(plan.clone());
        self.plans.truncate(PLANS);
    }

    /// Returns true if a result is cached.
    pub(crate) fn holds(&self, key: &ResultKey) -> bool {
        self.textures.contains_key(key)
    }

    /// Extents of the tiles of a component of a result.
    pub(crate) fn extents(&self, key: &ExtentKey) -> Option<&Vec<TileExtent>> {
        self.extents
            .iter()
            .find(|(known, _)| known == key)
            .map(|(_, extents)| extents)
    }

    /// Stores the extents of the tiles of a component of a result.
    pub(crate) fn put_extents(&mut self, key: ExtentKey, extents: Vec<TileExtent>) {
        self.extents.retain(|(known, _)| *known != key);
        self.extents.push_back((key, extents));
        if self.extents.len() > EXTENTS {
            self.extents.pop_front();
        }
    }

    /// Returns whether a map has ghosts beyond a jump; `None` if that is not known.
    pub(crate) fn jumps(&self, key: &ResultKey) -> Option<bool> {
        let known = self.jumps.iter().find(|(known, _)| known == key);
        known.map(|(_, jumps)| *jumps)
    }

    /// Remembers whether a map has ghosts beyond a jump.
    pub(crate) fn put_jumps(&mut self, key: ResultKey, jumps: bool) {
        self.jumps.retain(|(known, _)| *known != key);
        self.jumps.push_back((key, jumps));
        if self.jumps.len() > JUMPS {
            self.jumps.pop_front();
        }
    }

    /// Removes a texture from the cache, so that it may be changed.
    pub(crate) fn take(&mut self, key: &ResultKey) -> Option<wgpu::Texture> {
        let taken = self.textures.remove(key)?;
        self.bytes -= taken.bytes;
        Some(taken.texture)
    }

    /// Forgets all remembered plans. Called when the surface or a node has been replaced.
    pub fn forget_plans(&mut self) {
        self.plans.clear();
    }

    /// A cached texture.
    pub(crate) fn get(&mut self, key: &ResultKey) -> Option<wgpu::Texture> {
        let cached = self.textures.get_mut(key)?;
        cached.last_used = self.runs;
        Some(cached.texture.clone())
    }

    /// Stores a texture of this many bytes.
    pub(crate) fn put(&mut self, key: ResultKey, texture: wgpu::Texture, bytes: u64) {
        let cached = CachedTexture {
            texture,
            bytes,
            last_used: self.runs,
        };
        self.bytes += bytes;
        if let Some(before) = self.textures.insert(key, cached) {
            self.bytes -= before.bytes;
        }
        self.drop_oldest();
    }

    /// Cached textures by slot.
    pub(crate) fn find(&self, keys: &BTreeMap<SlotRef, ResultKey>) -> BTreeMap<SlotRef, wgpu::Texture> {
        keys.iter()
            .filter_map(|(slot, key)| Some((*slot, self.textures.get(key)?.texture.clone())))
            .collect()
    }

    /// Stores the results of a run, marks the results that it used as recently used, and drops the least recently used ones
    /// while the cache is over its budget.
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
        self.drop_oldest();
    }

    fn drop_oldest(&mut self) {
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
