//! Maps that are made of results of a run, as a cache knows them.

use sabi_nodes::link::Plane;
use sabi_plan::SlotRef;

use crate::result_key::ResultKey;
use crate::run_result::Run;
use crate::surface::GpuSurface;
use crate::tile_set::TileSet;

/// Map that is made of results of a run, as a cache knows it.
pub(crate) struct MadeMap {
    /// Its key.
    pub(crate) key: ResultKey,
    /// Key that it had before, and the tiles of its results that differ since; none where that is not known.
    pub(crate) before: Option<(ResultKey, TileSet)>,
}

impl MadeMap {
    /// The map whose texels each depend on those around as well.
    pub(crate) fn grown(self, surface: &GpuSurface) -> MadeMap {
        MadeMap {
            before: self
                .before
                .map(|(key, tiles)| (key, tiles.grown(&surface.tile_numbers))),
            ..self
        }
    }

    /// A map of this name that is made of some results; none where one of them has no key.
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
    /// That of the same results before, with the tiles beyond which nothing that is shown of them differs; none where that is not
    /// known.
    pub before: Option<([u8; 32], TileSet)>,
}

impl Run {
    /// Identity of some results; none where one of them has no key.
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
