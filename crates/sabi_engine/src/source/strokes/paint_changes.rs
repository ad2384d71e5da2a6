//! Differences of the paint between two versions of strokes, so that only changed texels are evaluated again.

use std::sync::{Arc, PoisonError};

use sabi_paint::{Canvas, Version};

use super::Strokes;

/// Nodes and atlases whose latest canvas is remembered: those of a graph in two sizes.
const REMEMBERED: usize = 8;

/// A node on an atlas.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PaintedNodePlace {
    /// Key of the surface with its atlas.
    pub(crate) surface_key: [u8; 32],
    /// Id of the node.
    pub(crate) node: String,
}

/// Canvas that a node used last on an atlas.
pub(super) struct LatestCanvas {
    place: PaintedNodePlace,
    version: Version,
    canvas: Arc<Canvas>,
    /// Previous version, and the first texel of each group of eight that has changed since.
    changed: Option<(Version, Arc<Vec<u32>>)>,
}

impl Strokes {
    /// Returns the first texel of each group of eight in which the paint of a node differs between two versions, if these
    /// are the last two that were requested on an atlas. If there is no earlier version, nothing was painted before.
    pub(crate) fn changed_texels(
        &self,
        place: &PaintedNodePlace,
        before: Option<Version>,
        now: Version,
    ) -> Option<Arc<Vec<u32>>> {
        let latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        let own = latest
            .iter()
            .find(|known| known.place == *place && known.version == now)?;
        let Some(before) = before else {
            let empty = own.canvas.emptied();
            return own.canvas.changed_since(&empty).map(Arc::new);
        };
        let (since, texels) = own.changed.as_ref()?;
        (*since == before).then(|| Arc::clone(texels))
    }

    /// Remembers the canvas of a node on an atlas, and its differences from the previous one.
    pub(super) fn remember_canvas(&self, place: PaintedNodePlace, version: Version, canvas: &Arc<Canvas>) {
        let mut latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        let known = latest.iter().position(|known| known.place == place);
        let before = known.and_then(|at| latest.remove(at));
        let changed = before.and_then(|before| match before.version == version {
            // The canvas is for another output with the same strokes.
            true => before.changed,
            false => Some((before.version, Arc::new(canvas.changed_since(&before.canvas)?))),
        });
        latest.push_back(LatestCanvas {
            place,
            version,
            canvas: Arc::clone(canvas),
            changed,
        });
        if latest.len() > REMEMBERED {
            latest.pop_front();
        }
    }
}
