//! Layout of the pixels of a texture set.

use std::{panic, thread};

use sabi_export::{Padding, PaddingMap, SetKey, SetLayout};

use super::layout_bytes;
use crate::error::EngineError;
use crate::evaluating::texture_sets::TextureSet;
use crate::evaluating::texture_space::set_layout;
use crate::opening::linked_model::LinkedModel;

/// Maximum number of bytes for the pixels of a set that are laid out during an evaluation, when textures take the most
/// memory: those of 2048².
const BYTES_BESIDE: usize = 64 << 20;

/// Pixels of a texture set, with the texels from which each takes its values.
pub(crate) struct SetPixels {
    pub(super) layout: SetLayout,
    pub(super) padding: PaddingMap,
}

impl SetPixels {
    /// Lays out the pixels of a set.
    pub(super) fn new(linked: &LinkedModel, key: SetKey, padding: Padding) -> SetPixels {
        let _span = tracing::debug_span!("lay out pixels").entered();
        let layout = set_layout(linked, key);
        SetPixels {
            padding: PaddingMap::new(&layout, padding),
            layout,
        }
    }

    /// Lays out the pixels of a set during an evaluation, if there is a set that is not larger than 2048². The processor is
    /// idle while the device compiles kernels.
    pub(crate) fn new_while<T>(
        linked: &LinkedModel,
        set: Option<&TextureSet>,
        padding: Padding,
        evaluate: impl FnOnce() -> Result<T, EngineError>,
    ) -> Result<(T, Option<SetPixels>), EngineError> {
        let set = set.filter(|_| layout_bytes(linked.atlas.size) <= BYTES_BESIDE);
        thread::scope(|scope| {
            let task = scope.spawn(|| set.map(|set| SetPixels::new(linked, set.key, padding)));
            let evaluated = evaluate();
            let pixels = task.join().unwrap_or_else(|payload| panic::resume_unwind(payload));
            Ok((evaluated?, pixels))
        })
    }
}
