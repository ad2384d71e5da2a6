//! Painting of the viewport: the pictures of one or two results, and texts and measures over them.

use eframe::egui_wgpu::RenderState;
use egui::{Align2, Color32, FontId, Rect, Stroke, Ui, pos2, vec2};
use sabi_view::{Background, Mode, Shot};

use super::model_view_pictures::{Lighting, PictureRequest};
use super::navigation::REST;
use super::{ModelView, Subject, subject_menus};
use crate::evaluation::{Evaluation, ResultPicture};
use crate::knobs::LengthUnits;
use crate::theme::{Theme, type_size};

impl ModelView {
    /// Paints the picture, or the two that are compared. Returns whether they cover the background.
    pub(super) fn paint(
        &mut self,
        ui: &Ui,
        rect: Rect,
        evaluation: &Evaluation,
        render: &RenderState,
        picture: &ResultPicture,
        subject: &Subject<'_>,
    ) -> bool {
        let is_turning = self.navigation.is_moving();
        if is_turning {
            ui.ctx().request_repaint_after(REST);
        }
        let is_moving = is_turning || subject.is_moving;
        let lighting = Lighting::of(&self.environment, &self.lights);
        let unlit = unlit_mode(subject);
        let request = |picture| PictureRequest {
            picture,
            shot: shot_of(self.navigation.camera, &self.shot, picture, unlit),
            lighting: &lighting,
            is_moving,
        };
        let gpu = evaluation.gpu();
        let first = self.pictures.refresh(0, ui, rect, gpu, render, &request(picture));
        self.pictures.fault = first.as_ref().err().cloned();
        let Ok(Some(first)) = first else {
            return false;
        };
        let pinned = subject.pinned.and_then(|seen| evaluation.results.picture(seen));
        let other = self.comparison.share.zip(pinned).and_then(|(share, pinned)| {
            match self.pictures.refresh(1, ui, rect, gpu, render, &request(pinned)) {
                Ok(other) => Some((share, other?)),
                Err(fault) => {
                    self.pictures.fault = Some(fault);
                    None
                }
            }
        });
        let painter = ui.painter();
        let part = |picture, from: f32, to: f32| {
            let uv = Rect::from_min_max(pos2(from, 0.0), pos2(to, 1.0));
            let at = |share: f32| rect.left() + share * rect.width();
            let place = Rect::from_x_y_ranges(at(from)..=at(to), rect.y_range());
            painter.image(picture, place, uv, Color32::WHITE);
        };
        part(first, 0.0, other.map_or(1.0, |(share, _)| share));
        if let Some((share, other)) = other {
            part(other, share, 1.0);
            let at = rect.left() + share * rect.width();
            // The menus lie on the pictures, and not on the line between them.
            let below = rect.with_min_y((rect.top() + self.menus_height).min(rect.bottom()));
            painter.vline(at, below.y_range(), Stroke::new(1.5, subject.theme.accent));
        }
        self.shot.background != Background::Clear
    }
}

/// Mode of results that are not lit. While the user paints, the mask is drawn on clay, so that the shape of the model
/// is seen.
pub(super) fn unlit_mode(subject: &Subject<'_>) -> Mode {
    match subject.painted {
        Some(_) => Mode::NodeOnClay,
        None => Mode::Node,
    }
}

/// Shot of a result from a camera, with the settings of the view. Results that are not lit have the mode `unlit`.
pub(super) fn shot_of(camera: sabi_view::Camera, shot: &Shot, picture: &ResultPicture, unlit: Mode) -> Shot {
    Shot {
        camera,
        mode: if picture.looks.is_lit { shot.mode } else { unlit },
        height_range: picture.looks.height_range,
        ..shot.clone()
    }
}

/// Writes a sentence in the middle of the viewport.
pub(super) fn sentence(ui: &Ui, rect: Rect, theme: &Theme, sentence: &str) {
    let font = FontId::proportional(type_size::BODY);
    let text = ui
        .painter()
        .layout(sentence.to_owned(), font, theme.quiet, rect.width() * 0.8);
    let at = Align2::CENTER_CENTER.anchor_size(rect.center(), text.size());
    ui.painter().galley(at.min, text, theme.quiet);
}

/// Draws a bar as long as a length on the model at the camera's target, with the length as a text.
pub(super) fn length_bar(view: &mut ModelView, ui: &Ui, rect: Rect, evaluation: &Evaluation, theme: &Theme) {
    let (Some(length), Some(model)) = (view.length, &evaluation.model.received) else {
        return;
    };
    let view_from_working = model.placement.scale / model.fitted().working_from_model();
    let camera = &view.navigation.camera;
    let points = (length * view_from_working) as f32 / camera.height_at_target() * rect.height();
    let width = points.min(rect.width() - 40.0).max(1.0);
    let start = pos2(rect.left() + 20.0, rect.bottom() - 24.0);
    let end = start + vec2(width, 0.0);
    let stroke = Stroke::new(2.0, theme.accent);
    ui.painter().line_segment([start, end], stroke);
    for at in [start, end] {
        ui.painter()
            .line_segment([at - vec2(0.0, 5.0), at + vec2(0.0, 5.0)], stroke);
    }
    let text = LengthUnits::on(Some(model)).in_both(length);
    let above = start - vec2(0.0, 16.0);
    let place = subject_menus::CaptionPlace {
        at: above,
        align: Align2::LEFT_CENTER,
        within: rect,
    };
    view.captions.write(ui, theme, "length", &place, &text);
}
