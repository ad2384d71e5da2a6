//! Pictures of the model: drawn as far as they have to be, and shown.

use std::sync::Arc;

use eframe::egui_wgpu::RenderState;
use egui::{Color32, Context, Rect, Stroke, TextureId, Ui, pos2};
use sabi_engine::view::{Background, Environment, Light, Mode, Pixels, Scene, Shot, Viewport};
use sabi_engine::{EngineError, Gpu};

use super::{ModelView, REST, Screen, Subject};
use crate::evaluation::{Evaluation, Picture};

impl ModelView {
    /// The picture that is shown, in memory; none while there is none.
    pub(crate) fn picture(&self, gpu: &Arc<Gpu>) -> Option<Pixels> {
        self.screens[0].as_ref()?.viewport.picture()?.read(gpu).ok()
    }

    /// Paints the picture, or the two that are compared; says whether nothing of the ground is seen.
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

    /// One picture, drawn as far as it has to be; none where that failed, which is then said.
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
        // The last picture stays until what draws the next one is made.
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

    /// How something is shown as one looks at it now.
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

    /// Whether what draws this picture is made; begins to make it otherwise.
    fn is_ready(
        &mut self,
        at: usize,
        context: &Context,
        evaluation: &Evaluation,
        picture: &Picture,
        shot: &Shot,
    ) -> Result<bool, String> {
        let gpu = evaluation.gpu();
        let Some(renderer) = self.tools.renderer(context, gpu)? else {
            return Ok(false);
        };
        let screen = self.screens[at].get_or_insert_with(|| Screen {
            viewport: Viewport::new(gpu, renderer.clone()),
            texture: None,
        });
        let Some(environment) = self.surroundings.environment() else {
            return Ok(false);
        };
        let lights = self.lamps.lights();
        let missing = screen.viewport.missing(&scene(picture, environment, &lights), shot);
        self.tools.is_ready(context, (gpu, &renderer), missing)
    }

    /// Draws one screen as far as it has to be, and says whether it had to.
    pub(super) fn draw(
        &mut self,
        at: usize,
        evaluation: &Evaluation,
        picture: &Picture,
        shot: &Shot,
        size: [u32; 2],
        is_moving: bool,
    ) -> Result<bool, EngineError> {
        let (Some(environment), Some(screen)) = (self.surroundings.environment(), &mut self.screens[at]) else {
            return Ok(false);
        };
        let lights = self.lamps.lights();
        let scene = scene(picture, environment, &lights);
        // Light that was changed is another picture too.
        let revision = picture.number ^ (self.surroundings.number() << 48) ^ (self.lamps.number() << 32);
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
