//! Small pictures of strokes.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use egui::{ColorImage, TextureHandle, TextureId, TextureOptions, Ui};
use sabi_paint::{Brush, StampPictures, swatch};

use crate::brush::shown_pixel;
use crate::context::ViewContext;

/// Pixels of a swatch, across and down.
pub(super) const SWATCH: [usize; 2] = [112, 36];
/// Most swatches that are kept; all are drawn again once there are more.
const MOST: usize = 400;
/// Time of a frame after which no more swatches are drawn in it.
const FRAME_TIME: Duration = Duration::from_millis(12);

/// Swatches that were drawn, by their brushes.
#[derive(Default)]
pub(super) struct Swatches {
    drawn: BTreeMap<String, TextureHandle>,
    began: Option<Instant>,
}

impl Swatches {
    /// Gives the new frame its own time for drawing swatches.
    pub(super) fn begin_frame(&mut self) {
        self.began = None;
    }

    /// Picture of a stroke of a brush; `None` if it is drawn in a later frame.
    pub(super) fn of(&mut self, ui: &Ui, context: &ViewContext<'_>, brush: &Brush) -> Option<TextureId> {
        let key = key_of(ui, brush);
        if let Some(texture) = self.drawn.get(&key) {
            return Some(texture.id());
        }
        let began = *self.began.get_or_insert_with(Instant::now);
        if began.elapsed() > FRAME_TIME {
            ui.ctx().request_repaint();
            return None;
        }
        if self.drawn.len() >= MOST {
            self.drawn.clear();
        }
        let pictures = pictures_of(context, brush)?;
        let image = drawn(ui, brush, &pictures);
        let texture = ui.ctx().load_texture("swatch", image, TextureOptions::LINEAR);
        let id = texture.id();
        self.drawn.insert(key, texture);
        Some(id)
    }
}

/// Values that the picture of a brush depends on.
fn key_of(ui: &Ui, brush: &Brush) -> String {
    // The size of a swatch follows from its own height, and symmetry and limits do not show in it.
    let seen = Brush {
        radius: 1.0,
        height: 0.0,
        value: 1.0,
        symmetry: Default::default(),
        limits: Default::default(),
        ..brush.clone()
    };
    format!("{seen:?} {:?}", ui.visuals().text_color())
}

/// Pictures that a brush stamps; `None` if one of them is not in memory.
fn pictures_of(context: &ViewContext<'_>, brush: &Brush) -> Option<StampPictures> {
    let mut pictures = StampPictures::new();
    if let Some(tip) = &brush.picture {
        let strokes = &context.document.session.graph().strokes;
        pictures.insert(tip.picture.clone(), strokes.picture(&tip.picture)?);
    }
    Some(pictures)
}

fn drawn(ui: &Ui, brush: &Brush, pictures: &StampPictures) -> ColorImage {
    let paint = ui.visuals().strong_text_color();
    let pixels = swatch(brush, pictures, SWATCH);
    let shown = pixels.iter().map(|pixel| shown_pixel(pixel, paint));
    ColorImage::new(SWATCH, shown.collect())
}
