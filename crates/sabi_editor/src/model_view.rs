//! The viewport: the model in its light, turned by drags.

mod brush;
pub(crate) mod channels;
mod comparison;
pub(crate) mod drop_place;
mod environment_loader;
mod eyedropper;
mod lights;
mod menu;
mod model_view_pictures;
mod navigation;
mod painting;
mod renderer_loader;
mod row;
mod saved_picture;
mod saved_views;
mod softness;
mod stencil_picture;
mod subject;
mod subject_menus;

use eframe::egui_wgpu::RenderState;
use egui::{Rect, Sense, Shape, Ui, WidgetInfo, WidgetType};
use sabi_engine::live::ViewSubject;
use sabi_export::SetKey;
use sabi_view::{Camera, Lens, Lines, Mode, Shot, Viewpoint};

use crate::action::Action;
use crate::activity_text::activity_text;
use crate::brush::BrushTool;
use crate::command::{Scope, ViewportCommand};
use crate::evaluation::{Evaluation, ResultPicture};
use crate::mouse;
use crate::outdated_results;
use crate::settings::viewport::ViewChoices;
use comparison::Comparison;
use environment_loader::EnvironmentLoader;
use lights::Lights;
use model_view_pictures::ModelViewPictures;
use navigation::{Navigation, aspect, picked_by};
use row::RowView;
use saved_picture::SavedPicture;
use softness::SoftnessCache;
use stencil_picture::StencilPicture;
use subject::{ModelViewOutput, Subject};
use subject_menus::Captions;

/// Samples of a picture at full quality.
const SAMPLES: u32 = 8;

/// View of the model in its light.
pub(crate) struct ModelView {
    pub(crate) pictures: ModelViewPictures,
    pub(crate) navigation: Navigation,
    pub(crate) environment: EnvironmentLoader,
    pub(crate) lights: Lights,
    pub(crate) shot: Shot,
    pub(crate) comparison: Comparison,
    /// Result that is shown until the wanted one arrives.
    last: Option<ResultPicture>,
    /// Models beside the main one.
    row: RowView,
    /// Length that is shown as a bar, working units.
    pub(crate) length: Option<f64>,
    /// Name that is typed for a view that is kept.
    name_of_view: String,
    pub(crate) saved_picture: SavedPicture,
    softness: SoftnessCache,
    brush: BrushTool,
    stencil_picture: StencilPicture,
    captions: Captions,
    /// Height of the menus with their margin in the last frame, points.
    menus_height: f32,
    /// Place of the view in the window when it was last shown.
    area: Option<Rect>,
    /// Place of the main model in it.
    main_cell: Option<Rect>,
}

impl ModelView {
    /// A view with the environment and choices of settings.
    pub(crate) fn new(environment: &str, choices: &ViewChoices) -> ModelView {
        let navigation = Navigation::new();
        let mut shot = Shot {
            samples: SAMPLES,
            ..Shot::new(navigation.camera)
        };
        choices.apply(&mut shot);
        ModelView {
            pictures: ModelViewPictures::default(),
            navigation,
            environment: EnvironmentLoader::new(environment),
            lights: Lights::new(&choices.lights),
            shot,
            comparison: Comparison::default(),
            last: None,
            row: RowView::default(),
            length: None,
            name_of_view: String::new(),
            saved_picture: SavedPicture::default(),
            softness: SoftnessCache::default(),
            brush: BrushTool::default(),
            stencil_picture: StencilPicture::default(),
            captions: Captions::default(),
            menus_height: 0.0,
            area: None,
            main_cell: None,
        }
    }

    /// Choices for settings.
    pub(crate) fn choices(&self) -> ViewChoices {
        ViewChoices::of(&self.shot, self.lights.kept())
    }

    /// Returns whether everything that drawing needs is loaded.
    #[cfg(test)]
    pub(crate) fn is_loaded(&self) -> bool {
        self.environment.environment().is_some() && !self.pictures.is_loading()
    }

    /// Place of the main model in the window when it was last shown.
    #[cfg(test)]
    pub(crate) fn main_cell(&self) -> Option<Rect> {
        self.main_cell
    }

    /// Draws the model, and moves the camera by drags.
    fn draw_view(
        &mut self,
        ui: &mut Ui,
        evaluation: &Evaluation,
        render: Option<&RenderState>,
        subject: &Subject<'_>,
    ) -> ModelViewOutput {
        let mut output = ModelViewOutput {
            fault: self.environment.poll(evaluation, ui.ctx()),
            ..ModelViewOutput::default()
        };
        let area = ui.available_rect_before_wrap();
        if !area.is_positive() {
            return output;
        }
        self.captions.begin_frame();
        let response = ui.allocate_rect(area, Sense::click_and_drag());
        // The menus belong to all cells, and lie above them.
        let has_row = !subject.beside.is_empty();
        let menus = if has_row { self.menus_height } else { 0.0 };
        let below = area.with_min_y((area.top() + menus).min(area.bottom()));
        let cells = row::cells(below, 1 + subject.beside.len());
        let rect = cells[0];
        self.area = Some(area);
        self.main_cell = Some(rect);
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Other, true, "Model"));
        let background = ui.painter().add(Shape::Noop);
        // The last result stays until a new one arrives, so that the view does not flicker.
        let newest = evaluation.results.picture(subject.shown);
        let picture = newest.or(self.last.as_ref()).cloned();
        if let Some(picture) = &picture {
            self.fit_to_cells(cells.len(), rect, picture);
            self.navigation.frame_new(&picture.model, rect);
            if !self.paint_on(ui, &response, rect, picture, subject, &mut output.actions) {
                self.move_camera(ui, &response, &cells, subject);
                let set = self.clicked_set(&response, rect, picture);
                output.actions.extend(set.map(Action::ShowSet));
            }
            output.color = self.clicked_color(&response, rect, evaluation, picture, subject);
        }
        let is_covered = self.paint_picture(ui, rect, evaluation, render, picture.as_ref(), subject);
        if let Some(picture) = picture.as_ref().filter(|_| self.saved_picture.is_busy()) {
            ui.ctx().request_repaint();
            let done = self.advance_saved_picture(evaluation.gpu(), picture);
            output.actions.extend(done.map(Action::Notice));
        }
        if !is_covered || has_row {
            let painted = Shape::rect_filled(area, 0.0, subject.theme.background);
            ui.painter().set(background, painted);
        }
        if picture.as_ref().is_some_and(|picture| evaluation.is_outdated(picture)) {
            let cancel = outdated_results::cover_with_cancel(ui, rect, evaluation, subject.theme);
            output.actions.extend(cancel);
        }
        if picture.is_none() {
            output
                .actions
                .extend(outdated_results::cancel_first(ui, rect, evaluation));
        }
        self.paint_beside(ui, &cells, render, picture.as_ref(), subject, &mut output.actions);
        self.last = picture;
        if let Some(fault) = &self.pictures.fault {
            painting::sentence(ui, rect, subject.theme, fault);
        }
        painting::length_bar(self, ui, rect, evaluation, subject.theme);
        subject_menus::label(self, ui, rect, evaluation, subject);
        softness::show(self, ui, rect, evaluation, subject, &mut output.actions);
        self.show_stencil(ui, rect, subject);
        self.show_brush(ui, &response, rect, subject);
        output.environment = menu::show(self, ui, area, evaluation, subject, &mut output.actions);
        output
    }

    /// Texture set of the surface that was clicked.
    fn clicked_set(&self, response: &egui::Response, rect: Rect, picture: &ResultPicture) -> Option<SetKey> {
        let at = response.interact_pointer_pos().filter(|_| response.clicked())?;
        let at = Some(at).filter(|at| rect.contains(*at))?;
        let model = &picture.model;
        let picked = picked_by(&self.navigation.camera, model, rect, at)?;
        let chart = model.linked.atlas.charts.get(picked.chart as usize)?;
        let set = model.sets.iter().find(|set| set.key.is_home_of(chart))?;
        Some(set.key)
    }

    /// Moves the camera by drags, relative to the cell that the pointer is over.
    fn move_camera(&mut self, ui: &Ui, response: &egui::Response, cells: &[Rect], subject: &Subject<'_>) {
        let action = mouse::dragged(subject.preset, Scope::Viewport, response);
        // A drag of the line between two pictures does not move the camera.
        let is_on_line = self.comparison.drag(ui, response, cells[0]);
        let light_turn = &mut self.shot.environment_turn_degrees;
        let is_in = |cell: &&Rect| response.hover_pos().is_some_and(|at| cell.contains(at));
        let under = cells.iter().find(is_in).copied().unwrap_or(cells[0]);
        self.navigation
            .drag(ui, response, under, action.filter(|_| !is_on_line), light_turn);
    }

    /// Paints the model, or a sentence about why there is none. Returns whether the model covers the background.
    fn paint_picture(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        evaluation: &Evaluation,
        render: Option<&RenderState>,
        picture: Option<&ResultPicture>,
        subject: &Subject<'_>,
    ) -> bool {
        let failure = evaluation.model.failure.as_ref().map(ToString::to_string);
        let activity = evaluation.activity().map(|activity| activity_text(&activity));
        let reading = activity.unwrap_or_else(|| "Reading the model…".to_owned());
        let reason = match (render, picture) {
            (Some(render), Some(picture)) => return self.paint(ui, rect, evaluation, render, picture, subject),
            (None, _) => "This window has no graphics device to draw the model with.",
            // Without an error, the model is still being read.
            (Some(_), None) => failure.as_deref().unwrap_or(&reading),
        };
        painting::sentence(ui, rect, subject.theme, reason);
        false
    }

    /// Performs a command about the camera and overlays.
    pub(crate) fn command(
        &mut self,
        command: ViewportCommand,
        evaluation: &Evaluation,
        shown: &ViewSubject,
        rect: Rect,
        pointer: Option<egui::Pos2>,
    ) {
        let picture = evaluation.results.picture(shown).or(self.last.as_ref());
        let Some(model) = picture.map(|picture| picture.model.clone()) else {
            return;
        };
        // Only the main model is picked, and none of those beside it.
        let rect = self.main_cell.filter(|_| !self.row.is_empty()).unwrap_or(rect);
        let pointer = pointer.filter(|at| rect.contains(*at));
        let points = model.placement.points_in_view(&model.linked.model.mesh);
        let from = |viewpoint| Camera::seen_from(viewpoint, &points, aspect(rect));
        let camera = &mut self.navigation.camera;
        match command {
            ViewportCommand::ShowAll => camera.frame(&points, aspect(rect)),
            ViewportCommand::Focus => {
                if let Some(picked) = pointer.and_then(|at| self.navigation.picked(&model, rect, at)) {
                    self.navigation.camera.focus(picked.position_view, None);
                }
            }
            ViewportCommand::Front => *camera = from(Viewpoint::FRONT),
            ViewportCommand::Right => *camera = from(Viewpoint::at(90.0, 0.0)),
            ViewportCommand::Top => *camera = from(Viewpoint::at(0.0, 90.0)),
            ViewportCommand::Lens => {
                camera.lens = match camera.lens {
                    Lens::Perspective => Lens::Orthographic,
                    Lens::Orthographic => Lens::Perspective,
                }
            }
            ViewportCommand::Wires => toggle_lines(&mut self.shot, Lines::Wires),
            ViewportCommand::Seams => toggle_lines(&mut self.shot, Lines::Seams),
            ViewportCommand::NextChannel => self.shot.mode = channels::after(self.shot.mode, 1),
            ViewportCommand::PreviousChannel => self.shot.mode = channels::after(self.shot.mode, -1),
            ViewportCommand::Material => self.shot.mode = Mode::Material,
        }
        self.navigation.mark_moved();
    }
}

/// Shows lines over the model, or hides them.
fn toggle_lines(shot: &mut Shot, lines: Lines) {
    match shot.lines.iter().position(|known| *known == lines) {
        Some(at) => {
            shot.lines.remove(at);
        }
        None => shot.lines.push(lines),
    }
}
