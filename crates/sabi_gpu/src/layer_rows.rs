//! Rows of a layer of a texture.

use std::ops::Range;

/// Rows of a layer of a texture.
#[derive(Clone)]
pub(crate) struct LayerRows {
    pub(crate) layer: u32,
    pub(crate) level: u32,
    pub(crate) rows: Range<u32>,
}

impl LayerRows {
    /// All rows of the first layer.
    pub(crate) fn of_whole(texture: &wgpu::Texture) -> LayerRows {
        LayerRows {
            layer: 0,
            level: 0,
            rows: 0..texture.height(),
        }
    }
}
