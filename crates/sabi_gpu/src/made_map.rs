//! Maps that are computed from results of a run, and their keys in a cache.

use sabi_nodes::link::Plane;
use sabi_plan::SlotRef;

use crate::result_key::ResultKey;
use crate::run_result::Run;
use crate::surface::GpuSurface;
use crate::tile_set::TileSet;

/// Map that is computed from results of a run, and its key in a cache.
pub(crate) struct MadeMap {
    /// Its key.
    pub(crate) key: ResultKey,
    /// Its earlier key, and the tiles of its results that have changed since; `None` if that is not known.
    pub(crate) before: Option<(ResultKey, TileSet)>,
}

impl MadeMap {
    /// Returns the map with a margin of tiles, for maps whose texels also depend on the texels around them.
    pub(crate) fn grown(self, surface: &GpuSurface) -> MadeMap {
        MadeMap {
            before: self
                .before
                .map(|(key, tiles)| (key, tiles.grown(&surface.tile_numbers))),
            ..self
        }
    }

    /// Creates the map with this name of some results; `None` if one of them has no key.
    pub(crate) fn of(run: &Run, name: &str, slots: &[Option<SlotRef>]) -> Option<MadeMap> {
        let key_of = |keys: &[Option<ResultKey>]| {
            let mut hash = blake3::Hasher::new();
            hash.update(name.as_bytes());
            for key in keys {
                hash.update(&key.map_or([0; 32], |key| key.content));
                hash.update(format!("{:?}", key.map(|key| (key.plane, key.tiles))).as_bytes());
            }
            ResultKey::whole(*hash.finalize().as_bytes(), Plane::Vector)
        };
        let now = slots.iter().map(|slot| match slot {
            Some(slot) => run.keys.get(slot).copied().map(Some),
            None => Some(None),
        });
        let now = now.collect::<Option<Vec<Option<ResultKey>>>>()?;
        let before = slots.iter().map(|slot| match slot {
            Some(slot) => run.changed.get(slot).map(|(key, tiles)| (Some(*key), tiles.clone())),
            None => Some((None, TileSet::default())),
        });
        let before = before
            .collect::<Option<Vec<(Option<ResultKey>, TileSet)>>>()
            .map(|before| {
                let keys: Vec<Option<ResultKey>> = before.iter().map(|(key, _)| *key).collect();
                let tiles = before.iter().fold(TileSet::default(), |all, (_, tiles)| all.and(tiles));
                (key_of(&keys), tiles)
            });
        Some(MadeMap {
            key: key_of(&now),
            before,
        })
    }
}

/// Identity of some results of a run.
pub struct ResultsIdentity {
    /// Hash of their keys.
    pub key: [u8; 32],
    /// The same for the earlier results, with the tiles in which the shown results may differ; `None` if that is not known.
    pub before: Option<([u8; 32], TileSet)>,
}

impl Run {
    /// Returns the identity of some results; `None` if one of them has no key.
    pub fn identity(&self, surface: &GpuSurface, slots: &[SlotRef]) -> Option<ResultsIdentity> {
        let slots: Vec<Option<SlotRef>> = slots.iter().copied().map(Some).collect();
        // Normals depend on the heights around them.
        let made = MadeMap::of(self, "looks", &slots)?.grown(surface);
        Some(ResultsIdentity {
            key: made.key.content,
            before: made.before.map(|(key, tiles)| (key.content, tiles)),
        })
    }
}
