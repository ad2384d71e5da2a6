//! The viewport: the model in its light, turned by drags.

mod environment_loader;
mod eyedropper;
mod lights;
mod menu;
mod painting;
mod renderer_loader;
mod showing;
mod subject;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use eframe::egui_wgpu::RenderState;
use egui::{
    Align2, CursorIcon, FontId, PointerButton, Rect, Response, Sense, Shape, Stroke, TextureId, Ui, WidgetInfo,
    WidgetType, pos2, vec2,
};
use glam::Vec2;
use sabi_engine::view::{Camera, Lens, Lines, Picked, Shot, Viewpoint, Viewport, aspect_of, pick};
use sabi_engine::{LiveModel, ViewSubject};

use crate::command::{Scope, ViewportCommand};
use crate::evaluation::{Evaluation, Picture};
use crate::knobs::Lengths;
use crate::mouse::{self, DragAction};
use crate::settings::viewport::ViewChoices;
use crate::theme::{Theme, type_size};
use environment_loader::EnvironmentLoader;
use lights::Lights;
use renderer_loader::RendererLoader;
use subject::{Outcome, Subject};

/// Time after the last movement until the picture is drawn at full quality.
const REST: Duration = Duration::from_millis(180);
/// Samples of a picture at full quality.
const SAMPLES: u32 = 8;
/// Distance at which the pointer takes the line between two pictures, points.
const REACH: f32 = 8.0;

/// Picture on the screen, with the texture that the window knows it by.
struct Screen {
    viewport: Viewport,
    texture: Option<(TextureId, wgpu::Texture)>,
}

/// View of the model in its light.
pub(crate) struct ModelView {
    /// The shown result, and the locked one beside it.
    screens: [Option<Screen>; 2],
    renderer_loader: RendererLoader,
    pub(crate) camera: Camera,
    /// File of the model that the camera was set up for.
    framed: Option<PathBuf>,
    environment_loader: EnvironmentLoader,
    lights: Lights,
    pub(crate) shot: Shot,
    /// Left edge of the locked result's picture as a share of the width; none without a comparison.
    pub(crate) wipe: Option<f32>,
    /// Whether the current drag moves the line between two pictures.
    holds_wipe: bool,
    /// Result that is shown until the wanted one arrives.
    last: Option<Picture>,
    moved: Option<Instant>,
    /// Error sentence, where there is no picture.
    fault: Option<String>,
    /// Length that is shown as a bar, working units.
    pub(crate) length: Option<f64>,
    /// Number of pictures that were drawn.
    pub(crate) drawn: u64,
}

impl ModelView {
    /// A view with the environment and choices of settings.
    pub(crate) fn new(environment: &str, choices: &ViewChoices) -> ModelView {
        let camera = Camera::seen_from(
            Viewpoint::THREE_QUARTER,
            [glam::Vec3::splat(-0.5), glam::Vec3::splat(0.5)],
            1.0,
        );
        let mut shot = Shot {
            samples: SAMPLES,
            ..Shot::new(camera)
        };
        choices.apply(&mut shot);
        ModelView {
            screens: [None, None],
            renderer_loader: RendererLoader::default(),
            shot,
            camera,
            framed: None,
            environment_loader: EnvironmentLoader::new(environment),
            lights: Lights::new(&choices.lights),
            wipe: None,
            holds_wipe: false,
            last: None,
            moved: None,
            fault: None,
            length: None,
            drawn: 0,
        }
    }

    /// Choices for settings.
    pub(crate) fn choices(&self) -> ViewChoices {
        ViewChoices::of(&self.shot, self.lights.kept())
    }

    /// Number of lights besides the environment.
    #[cfg(test)]
    pub(crate) fn lights(&self) -> usize {
        self.lights.kept().len()
    }

    /// Whether everything that drawing needs is loaded.
    #[cfg(test)]
    pub(crate) fn is_ready_made(&self) -> bool {
        self.environment_loader.environment().is_some() && !self.renderer_loader.is_loading()
    }

    /// File of the environment; none for a built-in one.
    pub(crate) fn environment_file(&self) -> Option<&Path> {
        self.environment_loader.file()
    }

    /// Reads the environment again, since its file has changed.
    pub(crate) fn reread_environment(&mut self) {
        self.environment_loader.read_again();
    }

    /// Rises with every environment that is shown.
    #[cfg(test)]
    pub(crate) fn environment_number(&self) -> u64 {
        self.environment_loader.number()
    }

    /// Shows an environment: a built-in name, or a file, which is read again if it is shown already.
    pub(crate) fn choose_environment(&mut self, choice: &str) {
        self.environment_loader.choose(choice);
        self.environment_loader.read_again();
    }

    /// Puts the line between two pictures in the middle when a comparison begins.
    fn follow_comparison(&mut self, is_compared: bool) {
        self.wipe = match self.wipe {
            Some(share) if is_compared => Some(share),
            None if is_compared => Some(0.5),
            _ => None,
        };
    }

    /// Draws the model, and turns it as drags ask.
    fn draw_view(
        &mut self,
        ui: &mut Ui,
        evaluation: &Evaluation,
        render: Option<&RenderState>,
        subject: &Subject<'_>,
    ) -> Outcome {
        let mut done = Outcome {
            fault: self.environment_loader.poll(evaluation, ui.ctx()),
            ..Outcome::default()
        };
        let rect = ui.available_rect_before_wrap();
        if !rect.is_positive() {
            return done;
        }
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Other, true, "Model"));
        let ground = ui.painter().add(Shape::Noop);
        // The last result stays until a new one arrives, so that the view does not flicker.
        let picture = evaluation.picture(subject.seen).or(self.last.as_ref()).cloned();
        if let Some(picture) = &picture {
            self.frame_new(&picture.model, rect);
            let drags = mouse::dragged(subject.habit, Scope::Viewport, &response);
            self.turn(ui, &response, rect, drags);
            done.taken = self.clicked_color(&response, rect, evaluation, picture, subject);
        }
        let failure = evaluation.model_failure.as_ref().map(ToString::to_string);
        let is_covered = match (render, &picture) {
            (Some(render), Some(picture)) => self.paint(ui, rect, evaluation, render, picture, subject),
            (render, _) => {
                let why = match render {
                    None => "This window has no graphics device to draw the model with.",
                    // Without an error, the model is still to come.
                    Some(_) => failure.as_deref().unwrap_or("Reading the model…"),
                };
                self.say(ui, rect, subject.theme, why);
                false
            }
        };
        if !is_covered {
            let painted = Shape::rect_filled(rect, 0.0, subject.theme.background);
            ui.painter().set(ground, painted);
        }
        self.last = picture;
        if let Some(fault) = &self.fault {
            self.say(ui, rect, subject.theme, fault);
        }
        self.draw_length(ui, rect, evaluation, subject.theme);
        showing::label(self, ui, rect, evaluation, subject);
        done.environment = menu::show(self, ui, rect, evaluation, subject, &mut done.asked);
        done
    }

    fn say(&self, ui: &Ui, rect: Rect, theme: &Theme, sentence: &str) {
        let font = FontId::proportional(type_size::BODY);
        let text = ui
            .painter()
            .layout(sentence.to_owned(), font, theme.quiet, rect.width() * 0.8);
        let at = Align2::CENTER_CENTER.anchor_size(rect.center(), text.size());
        ui.painter().galley(at.min, text, theme.quiet);
    }

    /// Sets up the camera for a new model.
    fn frame_new(&mut self, model: &LiveModel, rect: Rect) {
        let file = model.linked.model.files.first();
        if file.is_none() || self.framed.as_ref() != file {
            let bounds = model.placement.box_in_view(&model.linked.model.mesh);
            self.camera = Camera::seen_from(Viewpoint::THREE_QUARTER, bounds, aspect(rect));
            self.framed = file.cloned();
        }
    }

    /// Moves the camera or the light as a drag and the wheel ask.
    fn turn(&mut self, ui: &Ui, response: &Response, rect: Rect, drags: Option<DragAction>) {
        let (delta, scroll) = ui.input(|input| (input.pointer.delta(), input.smooth_scroll_delta().y));
        let size = Vec2::new(rect.width(), rect.height());
        let drag = Vec2::new(delta.x, delta.y);
        let before = (self.camera, self.shot.environment_turn_degrees);
        // A drag of the line between two pictures does not turn the model.
        let is_free = !self.moves_wipe(ui, response, rect) && delta != egui::Vec2::ZERO;
        match drags.filter(|_| is_free) {
            Some(DragAction::Orbit) => self.camera.orbit(drag, size),
            Some(DragAction::Pan) => self.camera.pan(drag, size),
            Some(DragAction::Zoom) => self.camera.zoom((-delta.y * 0.01).exp()),
            Some(DragAction::Light) => {
                self.shot.environment_turn_degrees += delta.x / rect.width().max(1.0) * 360.0;
            }
            _ => {}
        }
        let pointer = response.hover_pos();
        if let Some(at) = pointer.filter(|_| scroll != 0.0 && response.contains_pointer()) {
            self.camera
                .zoom_at(share(rect, at), aspect(rect), (-scroll * 0.0025).exp());
        }
        if before != (self.camera, self.shot.environment_turn_degrees) {
            self.moved = Some(Instant::now());
        }
    }

    /// Moves the line between two pictures, where the drag began on it; the cursor shows whether a drag would.
    fn moves_wipe(&mut self, ui: &Ui, response: &Response, rect: Rect) -> bool {
        let Some(line) = self.wipe.map(|wipe| rect.left() + wipe * rect.width()) else {
            self.holds_wipe = false;
            return false;
        };
        let (origin, at) = ui.input(|input| (input.pointer.press_origin(), input.pointer.latest_pos()));
        let is_near = |at: Option<egui::Pos2>| at.is_some_and(|at| (at.x - line).abs() < REACH);
        if response.drag_started_by(PointerButton::Primary) {
            self.holds_wipe = is_near(origin);
        }
        self.holds_wipe &= response.dragged_by(PointerButton::Primary);
        if self.holds_wipe || !response.dragged() && is_near(response.hover_pos()) {
            ui.set_cursor_icon(CursorIcon::ResizeHorizontal);
        }
        if let Some(at) = at.filter(|_| self.holds_wipe) {
            self.wipe = Some(((at.x - rect.left()) / rect.width()).clamp(0.02, 0.98));
        }
        self.holds_wipe
    }

    /// Surface point under a place of the screen.
    fn picked(&self, model: &LiveModel, rect: Rect, at: egui::Pos2) -> Option<Picked> {
        let linked = &model.linked;
        let bvh = linked.bvh.get()?;
        let ray = self.camera.ray(share(rect, at), aspect(rect));
        pick(bvh, &linked.model.mesh, &linked.atlas, ray, &model.placement)
    }

    /// Performs a command about the camera and overlays.
    pub(crate) fn command(
        &mut self,
        command: ViewportCommand,
        evaluation: &Evaluation,
        seen: &ViewSubject,
        rect: Rect,
        pointer: Option<egui::Pos2>,
    ) {
        let picture = evaluation.picture(seen).or(self.last.as_ref());
        let Some(model) = picture.map(|picture| picture.model.clone()) else {
            return;
        };
        let bounds = model.placement.box_in_view(&model.linked.model.mesh);
        let from = |viewpoint| Camera::seen_from(viewpoint, bounds, aspect(rect));
        match command {
            ViewportCommand::ShowAll => self.camera.frame_box(bounds[0], bounds[1], aspect(rect)),
            ViewportCommand::Focus => {
                if let Some(picked) = pointer.and_then(|at| self.picked(&model, rect, at)) {
                    self.camera.focus(picked.position_view, None);
                }
            }
            ViewportCommand::Front => self.camera = from(Viewpoint::FRONT),
            ViewportCommand::Right => self.camera = from(Viewpoint::at(90.0, 0.0)),
            ViewportCommand::Top => self.camera = from(Viewpoint::at(0.0, 90.0)),
            ViewportCommand::Lens => {
                self.camera.lens = match self.camera.lens {
                    Lens::Perspective => Lens::Orthographic,
                    Lens::Orthographic => Lens::Perspective,
                }
            }
            ViewportCommand::Wires => self.toggle_lines(Lines::Wires),
            ViewportCommand::Seams => self.toggle_lines(Lines::Seams),
        }
        self.moved = Some(Instant::now());
    }

    fn toggle_lines(&mut self, lines: Lines) {
        match self.shot.lines.iter().position(|known| *known == lines) {
            Some(at) => {
                self.shot.lines.remove(at);
            }
            None => self.shot.lines.push(lines),
        }
    }

    /// Draws a bar as long as a length on the model at the camera's target, with the length in words.
    fn draw_length(&self, ui: &Ui, rect: Rect, evaluation: &Evaluation, theme: &Theme) {
        let (Some(length), Some(model)) = (self.length, &evaluation.shown_model) else {
            return;
        };
        let view_from_working = model.placement.scale / model.fitted().working_from_model();
        let points = (length * view_from_working) as f32 / self.camera.height_at_target() * rect.height();
        let width = points.min(rect.width() - 40.0).max(1.0);
        let start = pos2(rect.left() + 20.0, rect.bottom() - 24.0);
        let end = start + vec2(width, 0.0);
        let stroke = Stroke::new(2.0, theme.accent);
        ui.painter().line_segment([start, end], stroke);
        for at in [start, end] {
            ui.painter()
                .line_segment([at - vec2(0.0, 5.0), at + vec2(0.0, 5.0)], stroke);
        }
        let words = Lengths::on(Some(model)).in_both(length);
        let above = start - vec2(0.0, 16.0);
        showing::told(ui, theme, "length", above, Align2::LEFT_CENTER, &words);
    }
}

fn aspect(rect: Rect) -> f32 {
    aspect_of(Vec2::new(rect.width(), rect.height()))
}

/// Place on the screen as a share of the picture.
fn share(rect: Rect, at: egui::Pos2) -> Vec2 {
    let share = (at - rect.min) / rect.size();
    Vec2::new(share.x, share.y)
}
