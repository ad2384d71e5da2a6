//! The picture of a stencil as a texture of the window.

use egui::{ColorImage, TextureHandle, TextureId, TextureOptions, Ui};
use sabi_paint::PictureTip;

use crate::brush::{ShownStencil, shown_pixel};

/// Largest side of the texture.
const SIDE: usize = 1024;

/// The picture of the stencil that was shown last.
#[derive(Default)]
pub(super) struct StencilPicture {
    shown: Option<(PictureTip, TextureHandle)>,
}

impl StencilPicture {
    /// The texture of a stencil: its colors, or the text color where it lets the brush through.
    pub(super) fn of(&mut self, ui: &Ui, stencil: &ShownStencil) -> TextureId {
        let wanted = stencil.choices.picture.as_ref();
        if let Some((tip, texture)) = &self.shown
            && wanted == Some(tip)
        {
            return texture.id();
        }
        let part = wanted.map(|tip| tip.part).unwrap_or_default(); // A stencil that is shown has a picture.
        let through = ui.visuals().strong_text_color();
        let (size, pixels) = stencil.picture.shown(part, SIDE);
        let shown = pixels.iter().map(|pixel| shown_pixel(pixel, through));
        let image = ColorImage::new(size, shown.collect());
        let texture = ui.ctx().load_texture("stencil", image, TextureOptions::LINEAR);
        let id = texture.id();
        self.shown = wanted.map(|tip| (tip.clone(), texture));
        id
    }
}
