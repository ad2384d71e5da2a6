//! Things outside of strokes that they paint with.

use crate::picture::StampPictures;

/// Linear colors of a result of another node, by the texels of the atlas that is painted on.
pub type InputColors<'a> = dyn Fn(usize) -> [f32; 3] + Sync + 'a;

/// A color as a canvas can hold it: results of nodes may be brighter than white, or no numbers.
pub(crate) fn bounded(color: [f32; 3]) -> [f32; 3] {
    color.map(|channel| {
        if channel.is_finite() {
            channel.clamp(0.0, 1.0)
        } else {
            0.0
        }
    })
}

/// Things that strokes need besides a surface.
#[derive(Clone, Copy)]
pub struct Supplies<'a> {
    /// Pictures of brushes and stencils. Strokes whose picture is not among them leave nothing.
    pub pictures: &'a StampPictures,
    /// The result that strokes copy from ([`crate::CopyOf::Input`]). Without it such strokes leave nothing.
    pub input: Option<&'a InputColors<'a>>,
}

impl<'a> Supplies<'a> {
    /// Pictures alone.
    pub fn of_pictures(pictures: &'a StampPictures) -> Supplies<'a> {
        Supplies { pictures, input: None }
    }
}
