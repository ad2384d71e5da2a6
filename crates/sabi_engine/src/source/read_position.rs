//! Position that is connected to a source: where a picture is read, and its change from texel to texel.

use glam::DVec3;
use sabi_gpu::PlaneData;
use sabi_surface::atlas::EMPTY;

use super::texels::{SourceSurface, SurfacePoint};

/// Connected positions by texel of the atlas.
pub(crate) struct ReadPositions<'a> {
    surface: &'a SourceSurface<'a>,
    plane: &'a PlaneData,
}

/// Position at one texel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReadPosition {
    /// The position: lengths in working units, or texture coordinates with y upward.
    pub(crate) at: DVec3,
    /// Change over one texel along the u and the v of the atlas.
    pub(crate) steps: [DVec3; 2],
}

impl<'a> ReadPositions<'a> {
    pub(crate) fn new(surface: &'a SourceSurface<'a>, plane: &'a PlaneData) -> ReadPositions<'a> {
        ReadPositions { surface, plane }
    }

    /// Returns the position at a point. Numbers that are not finite count as 0.
    ///
    /// The change is the smaller one of those to the texels on both sides: positions jump from one cell of a pattern to the
    /// next, and a picture that was averaged over the jump would be a blurred line there.
    pub(crate) fn of(&self, point: &SurfacePoint) -> ReadPosition {
        let at = self.value(point.index);
        let [width, height] = self.surface.atlas.page_size.map(|side| side as usize);
        let (column, row) = (point.index % width, point.index / width % height);
        let steps = [(column, width, 1), (row, height, width)].map(|(place, side, stride)| {
            let before = (place > 0).then(|| point.index - stride);
            let after = (place + 1 < side).then_some(point.index + stride);
            let behind = self.covered(before).map(|value| at - value);
            let ahead = self.covered(after).map(|value| value - at);
            match (behind, ahead) {
                (Some(behind), Some(ahead)) if behind.length_squared() < ahead.length_squared() => behind,
                (_, Some(ahead)) => ahead,
                (Some(behind), None) => behind,
                (None, None) => DVec3::ZERO,
            }
        });
        ReadPosition { at, steps }
    }

    /// Returns the position at a texel, if the surface covers it.
    fn covered(&self, index: Option<usize>) -> Option<DVec3> {
        let index = index.filter(|index| self.surface.atlas.owners[*index] != EMPTY)?;
        Some(self.value(index))
    }

    fn value(&self, index: usize) -> DVec3 {
        let [x, y, z, _] = self.plane.texel(index);
        DVec3::from([x, y, z].map(|number| if number.is_finite() { f64::from(number) } else { 0.0 }))
    }
}
