//! Keys of results.

use std::collections::BTreeMap;

use sabi_nodes::link::Plane;
use sabi_plan::SlotRef;

use crate::tile_set::TileSet;

/// Key of the content of one texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ResultKey {
    /// Hash of everything that can change the result.
    pub content: [u8; 32],
    /// Plane of the result.
    pub plane: Plane,
    /// Hash of the tiles in which it was computed; `None` for all.
    pub tiles: Option<[u8; 32]>,
}

impl ResultKey {
    /// Returns the key of a result that was computed in all tiles.
    pub(crate) fn whole(content: [u8; 32], plane: Plane) -> ResultKey {
        ResultKey {
            content,
            plane,
            tiles: None,
        }
    }
}

/// Differences of results from earlier results, with the keys of the earlier ones.
pub(crate) type ChangedResults = BTreeMap<SlotRef, (ResultKey, TileSet)>;
