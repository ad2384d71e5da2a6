//! Pictures of the model: drawn where they have changed, and painted.

use std::sync::Arc;

use eframe::egui_wgpu::RenderState;
use egui::{Color32, Context, Rect, Stroke, TextureId, Ui, pos2};
use sabi_engine::view::{Background, Environment, Light, Mode, Pixels, Scene, Shot, Viewport};
use sabi_engine::{EngineError, Gpu};

use super::{ModelView, REST, Screen, Subject};
use crate::evaluation::{Evaluation, Picture};

impl ModelView {
    /// Pixels of the shown picture, if there is one.
    pub(crate) fn picture(&self, gpu: &Arc<Gpu>) -> Option<Pixels> {
        self.screens[0].as_ref()?.viewport.picture()?.read(gpu).ok()
    }

    /// Paints the picture, or the two that are compared; gives whether they cover the background.
    pub(super) fn paint(
        &mut self,
        ui: &Ui,
        rect: Rect,
        evaluation: &Evaluation,
        render: &RenderState,
        picture: &Picture,
        subject: &Subject<'_>,
    ) -> bool {
        let is_turning = self.moved.is_some_and(|moved| moved.elapsed() < REST);
        if is_turning {
            ui.ctx().request_repaint_after(REST);
        }
        let is_moving = is_turning || subject.is_moving;
        let locked = subject.locked.and_then(|seen| evaluation.picture(seen)).cloned();
        let wipe = self.wipe.zip(locked);
        let first = self.refreshed(0, ui, rect, evaluation, render, picture, is_moving);
        let Some(first) = first else { return false };
        let other = wipe.and_then(|(share, locked)| {
            let other = self.refreshed(1, ui, rect, evaluation, render, &locked, is_moving)?;
            Some((share, other))
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
            painter.vline(at, rect.y_range(), Stroke::new(1.5, subject.theme.accent));
        }
        self.shot.background != Background::Clear
    }

    /// One picture, drawn if it has changed; none where that failed, with the error shown in the view.
    #[expect(
        clippy::too_many_arguments,
        reason = "what is drawn where, with what, of what, and how well"
    )]
    fn refreshed(
        &mut self,
        at: usize,
        ui: &Ui,
        rect: Rect,
        evaluation: &Evaluation,
        render: &RenderState,
        picture: &Picture,
        is_moving: bool,
    ) -> Option<TextureId> {
        let scale = ui.ctx().pixels_per_point();
        let size = [rect.width(), rect.height()].map(|side| (side * scale).round().max(1.0) as u32);
        let shot = self.shot_of(picture);
        // The last picture stays until the pipelines of the next one are made.
        let drawn = match self.is_ready(at, ui.ctx(), evaluation, picture, &shot) {
            Ok(true) => self
                .draw(at, evaluation, picture, &shot, size, is_moving)
                .map_err(|error| error.to_string()),
            waits => waits,
        };
        match drawn {
            Ok(has_drawn) => {
                self.fault = None;
                if has_drawn {
                    self.drawn += 1;
                    tracing::debug!(drawn = self.drawn, "the model was drawn");
                    ui.ctx().request_repaint();
                }
            }
            Err(why) => {
                self.fault = Some(why);
                return None;
            }
        }
        let screen = self.screens[at].as_mut()?;
        let shown = screen.viewport.picture()?.texture().clone();
        if let Some((id, known)) = &screen.texture
            && *known == shown
        {
            return Some(*id);
        }
        let view = shown.create_view(&wgpu::TextureViewDescriptor::default());
        let mut renderer = render.renderer.write();
        let filter = wgpu::FilterMode::Linear;
        let id = match &screen.texture {
            Some((id, _)) => {
                renderer.update_egui_texture_from_wgpu_texture(&render.device, &view, filter, *id);
                *id
            }
            None => renderer.register_native_texture(&render.device, &view, filter),
        };
        screen.texture = Some((id, shown));
        Some(id)
    }

    /// Shot of a result as the view is set up now.
    pub(super) fn shot_of(&self, picture: &Picture) -> Shot {
        Shot {
            camera: self.camera,
            mode: if picture.looks.is_lit {
                self.shot.mode
            } else {
                Mode::Node
            },
            height_range: picture.looks.height_range,
            ..self.shot.clone()
        }
    }

    /// Whether the pipelines of a picture are made; starts making them otherwise.
    fn is_ready(
        &mut self,
        at: usize,
        context: &Context,
        evaluation: &Evaluation,
        picture: &Picture,
        shot: &Shot,
    ) -> Result<bool, String> {
        let gpu = evaluation.gpu();
        let Some(renderer) = self.renderer_loader.renderer(context, gpu)? else {
            return Ok(false);
        };
        let screen = self.screens[at].get_or_insert_with(|| Screen {
            viewport: Viewport::new(gpu, renderer.clone()),
            texture: None,
        });
        let Some(environment) = self.environment_loader.environment() else {
            return Ok(false);
        };
        let lights = self.lights.lights();
        let missing = screen.viewport.missing(&scene(picture, environment, &lights), shot);
        self.renderer_loader.is_ready(context, (gpu, &renderer), missing)
    }

    /// Draws one picture if it has changed; gives whether it had.
    pub(super) fn draw(
        &mut self,
        at: usize,
        evaluation: &Evaluation,
        picture: &Picture,
        shot: &Shot,
        size: [u32; 2],
        is_moving: bool,
    ) -> Result<bool, EngineError> {
        let (Some(environment), Some(screen)) = (self.environment_loader.environment(), &mut self.screens[at]) else {
            return Ok(false);
        };
        let lights = self.lights.lights();
        let scene = scene(picture, environment, &lights);
        // A changed light makes another picture, too.
        let revision = picture.number ^ (self.environment_loader.number() << 48) ^ (self.lights.number() << 32);
        let viewport = &mut screen.viewport;
        Ok(viewport.show(evaluation.gpu(), &scene, revision, shot, size, is_moving)?)
    }
}

fn scene<'a>(picture: &'a Picture, environment: &'a Environment, lights: &'a [Light]) -> Scene<'a> {
    Scene {
        model: &picture.model.view,
        looks: &picture.looks.looks,
        look_of_material: &picture.looks.look_of_material,
        environment,
        lights,
    }
}
