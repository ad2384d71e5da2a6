//! The brush that is held, with its tip, its font and its stencil.

use std::path::Path;

use sabi_engine::rendering::StampSquare;
use sabi_engine::source::Strokes;
use sabi_paint::{PictureName, PicturePart, PictureTip};

use super::shell::Shell;
use crate::brush::text::{font_bytes, picture_of};
use crate::brush_shelf::{self, BrushShelf, KeptBrush};
use crate::settings::brush::BrushChoices;
use crate::settings::stencil::StencilChoices;
use crate::settings::text_font::TextFont;
use crate::shown_results::ShownResults;

/// The brush that is held: a choice of the settings, whose pictures are among the strokes of the open document, and with
/// the brushes that are kept for other graphs.
pub(super) struct HeldBrush<'a> {
    /// Strokes of the open document.
    pub(super) strokes: Strokes,
    pub(super) brushes: &'a mut BrushShelf,
    pub(super) looks: &'a mut ShownResults,
    pub(super) shell: &'a mut Shell,
}

impl HeldBrush<'_> {
    /// Uses a brush from now on; its picture is kept for other graphs.
    pub(super) fn choose(&mut self, brush: BrushChoices) {
        let before = &self.shell.settings.brush;
        if before.area.is_single() && !brush.area.is_single() {
            // Handles would be in the way of strokes.
            self.looks.marked_strokes.clear();
        }
        let picture = brush.picture.clone().filter(|_| before.picture != brush.picture);
        if let Some(tip) = picture {
            let kept = self.brushes.keep_picture(&tip.picture, &self.strokes);
            self.shell.report(kept);
        }
        self.shell.settings.brush = brush;
    }

    /// Uses a picture as the tip of the brush.
    pub(super) fn take_picture(&mut self, file: &Path) {
        let taken = self.strokes.take_picture(file);
        if let Some(picture) = self.shell.report(taken) {
            self.stamp_picture(picture);
        }
    }

    /// Uses a font for texts from now on, if it can be read.
    pub(super) fn choose_font(&mut self, font: TextFont) {
        let read = font.file.as_deref().map(font_bytes).transpose();
        if self.shell.report(read).is_some() {
            self.shell.settings.text_font = font;
        }
    }

    /// Uses a text as the tip of the brush.
    pub(super) fn take_text(&mut self, text: &str) {
        let drawn = picture_of(text, &self.shell.settings.text_font);
        let Some(drawn) = self.shell.report(drawn) else {
            return;
        };
        let Some(shapes) = drawn else {
            self.shell.notify("Type the text that the brush is to stamp.");
            return;
        };
        let taken = self.strokes.keep_shapes(shapes.size, &shapes.alpha);
        if let Some(picture) = self.shell.report(taken) {
            self.stamp_picture(picture);
        }
    }

    /// Uses the rendered result of a node as the tip of the brush.
    pub(super) fn take_node_tip(&mut self, made: Result<StampSquare, String>) {
        let taken = made.and_then(|made| {
            let part = if made.is_mask {
                PicturePart::Light
            } else {
                PicturePart::Colors
            };
            let picture = self.strokes.keep_picture(made.png, "png")?;
            Ok(PictureTip { picture, part })
        });
        if let Some(tip) = self.shell.report(taken) {
            self.choose(self.shell.settings.brush.with_picture(tip));
        }
    }

    /// Makes a picture of the document's strokes the tip of the brush, and keeps it for other graphs.
    fn stamp_picture(&mut self, picture: PictureName) {
        let tip = likely_tip(&self.strokes, picture);
        self.choose(self.shell.settings.brush.with_picture(tip));
    }

    /// Uses a kept brush. Settings that it does not list, such as the color of one that comes with the program, have
    /// their defaults.
    pub(super) fn use_kept(&mut self, kept: KeptBrush) {
        let brush = match &kept.file {
            Some(file) => self.shell.report(brush_shelf::opened(file, &self.strokes)),
            None => Some(kept.brush),
        };
        if let Some(brush) = brush {
            self.choose(brush);
        }
    }

    /// Uses these settings of the stencil from now on.
    pub(super) fn choose_stencil(&mut self, stencil: StencilChoices) {
        self.shell.settings.stencil = stencil;
        self.find_stencil_picture();
    }

    /// Uses a picture as the stencil, and keeps it for other graphs.
    pub(super) fn take_stencil(&mut self, file: &Path) {
        let taken = self.strokes.take_picture(file);
        let Some(picture) = self.shell.report(taken) else {
            return;
        };
        let kept = self.brushes.keep_picture(&picture, &self.strokes);
        self.shell.report(kept);
        self.shell.settings.stencil = StencilChoices::with_picture(likely_tip(&self.strokes, picture));
    }

    /// Loads the picture of the stencil into the open document, if that does not have it yet.
    fn find_stencil_picture(&mut self) {
        let stencil = &self.shell.settings.stencil;
        let Some(tip) = stencil.picture.clone().filter(|_| stencil.is_used) else {
            return;
        };
        if self.strokes.picture(&tip.picture).is_none() {
            let found = self.brushes.find_picture(&tip.picture, &self.strokes);
            if self
                .shell
                .report(found.map_err(|_| "The picture of the stencil is gone; choose another one.".to_owned()))
                .is_none()
            {
                self.shell.settings.stencil = StencilChoices::default();
            }
        }
    }

    /// Loads the pictures of the brush and of the stencil into the open document, if that does not have them yet.
    pub(super) fn find_picture(&mut self) {
        self.find_stencil_picture();
        let Some(tip) = self.shell.settings.brush.picture.clone() else {
            return;
        };
        if self.strokes.picture(&tip.picture).is_none() {
            let found = self.brushes.find_picture(&tip.picture, &self.strokes);
            if self.shell.report(found).is_none() {
                self.shell.settings.brush.picture = None;
            }
        }
    }

    /// Keeps the brush under a name.
    pub(super) fn keep(&mut self, name: &str) {
        self.find_picture();
        let kept = self.brushes.keep(name, &self.shell.settings.brush, &self.strokes);
        self.shell.report(kept);
    }

    /// Keeps the brush of a file, and uses it.
    pub(super) fn take_kept(&mut self, file: &Path) {
        let taken = self.brushes.take(file, &self.strokes);
        if let Some(brush) = self.shell.report(taken) {
            self.choose(brush);
        }
    }
}

/// Tip of a picture that was just taken, with the part of the picture that the artist most likely means.
fn likely_tip(strokes: &Strokes, picture: PictureName) -> PictureTip {
    let part = strokes.picture(&picture).map(|stamp| stamp.likely_part());
    PictureTip {
        part: part.unwrap_or_default(), // It is in memory.
        picture,
    }
}
