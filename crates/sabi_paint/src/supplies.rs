//! Data outside of strokes that painting needs.

use crate::picture::StampPictures;

/// Linear colors of a result of another node, by texel of the atlas that is painted on.
pub type InputColors<'a> = dyn Fn(usize) -> [f32; 3] + Sync + 'a;

/// Returns a color that a canvas can store. Results of nodes may be brighter than white, or NaN.
pub(crate) fn bounded(color: [f32; 3]) -> [f32; 3] {
    color.map(|channel| {
        if channel.is_finite() {
            channel.clamp(0.0, 1.0)
        } else {
            0.0
        }
    })
}

/// Data that strokes need in addition to a surface.
#[derive(Clone, Copy)]
pub struct Supplies<'a> {
    /// Pictures of brushes and stencils. Strokes whose picture is missing have no effect.
    pub pictures: &'a StampPictures,
    /// The result that strokes copy from ([`crate::CopyOf::Input`]). Without it, such strokes have no effect.
    pub input: Option<&'a InputColors<'a>>,
}

impl<'a> Supplies<'a> {
    /// Returns supplies with only pictures.
    pub fn of_pictures(pictures: &'a StampPictures) -> Supplies<'a> {
        Supplies { pictures, input: None }
    }
}
