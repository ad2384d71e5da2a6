//! Models beside the main one: a cell of the view for each, all seen by one camera.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Weak};
use std::time::Duration;

use eframe::egui_wgpu::RenderState;
use egui::{Align2, Color32, Frame, Margin, Pos2, Rect, RichText, Ui, UiBuilder, WidgetInfo, WidgetType, pos2, vec2};
use egui_phosphor::regular as icon;
use glam::Vec3;
use sabi_engine::live::LiveModel;
use sabi_view::{Camera, Viewpoint};

use super::model_view_pictures::{FIRST_BESIDE, Lighting, PictureRequest};
use super::navigation::{SAME_ASPECT, aspect};
use super::painting::{self, shot_of, unlit_mode};
use super::{ModelView, Subject, subject_menus};
use crate::action::{Action, ModelAction};
use crate::activity_text::activity_text;
use crate::dock::Panel;
use crate::evaluation::{Evaluation, ResultPicture};
use crate::model_warnings;
use crate::paths::file_stem;
use crate::theme::{space, type_size};

/// Height of the row with the name of a model, points.
const NAMES: f32 = 20.0;
/// Time after which the progress of a model is drawn again.
const DRAWN_AGAIN: Duration = Duration::from_millis(500);

/// State of the view for the models beside the main one.
#[derive(Default)]
pub(super) struct RowView {
    /// Last picture and framing of each model, by its file.
    cells: BTreeMap<PathBuf, ModelCell>,
    /// Number of cells and their aspect when the camera was moved for them last.
    fitted: Option<(usize, f32)>,
}

#[derive(Default)]
struct ModelCell {
    /// Result that is shown until the wanted one arrives.
    last: Option<ResultPicture>,
    framing: Option<(Weak<LiveModel>, f32, Framing)>,
    /// Place of the cell and the camera that it was drawn with last.
    seen: Option<(Rect, Camera)>,
    /// Sentence about why the model cannot be shown.
    fault: Option<String>,
}

/// Framing of a model from the usual viewpoint.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Framing {
    target: Vec3,
    /// Height of the picture at the target, view units.
    height: f32,
}

impl Framing {
    fn of(points: &[Vec3], aspect: f32) -> Framing {
        let camera = Camera::seen_from(Viewpoint::THREE_QUARTER, points, aspect);
        Framing {
            target: camera.target,
            height: camera.height_at_target(),
        }
    }
}

impl ModelCell {
    /// Framing of a model in a cell; computed again for another model or shape.
    fn framing(&mut self, model: &Arc<LiveModel>, aspect: f32) -> Framing {
        let now = Arc::downgrade(model);
        let known = self.framing.take();
        let known = known.filter(|(of, at, _)| of.ptr_eq(&now) && (at - aspect).abs() < SAME_ASPECT);
        let compute = || {
            let points = model.placement.points_in_view(&model.linked.model.mesh);
            Framing::of(&points, aspect)
        };
        let framing = known.map_or_else(compute, |(_, _, framing)| framing);
        self.framing = Some((now, aspect, framing));
        framing
    }
}

/// Divides a view into cells, side by side and in as few rows as keep them large.
pub(super) fn cells(rect: Rect, count: usize) -> Vec<Rect> {
    let count = count.max(1);
    let rows_of = |columns: usize| count.div_ceil(columns);
    let side = |columns: usize| (rect.width() / columns as f32).min(rect.height() / rows_of(columns) as f32);
    let columns = (1..=count).max_by(|one, other| side(*one).total_cmp(&side(*other)));
    let columns = columns.unwrap_or(1); // There is at least one.
    let size = vec2(rect.width() / columns as f32, rect.height() / rows_of(columns) as f32);
    let cell = |at: usize| {
        let corner = vec2((at % columns) as f32, (at / columns) as f32) * size;
        Rect::from_min_size(rect.min + corner, size)
    };
    (0..count).map(cell).collect()
}

/// The camera that sees a model as the main camera sees the main model: turned, moved and zoomed by the same amount.
fn camera_beside(main: Camera, of_main: Framing, own: Framing) -> Camera {
    let scale = own.height / of_main.height;
    Camera {
        target: own.target + (main.target - of_main.target) * scale,
        distance: main.distance * scale,
        ..main
    }
}

impl RowView {
    /// Returns whether there is no model but the main one.
    pub(super) fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Picture in the cell at a place of the screen, with the place of the cell and its camera.
    pub(super) fn seen_at(&self, at: Pos2) -> Option<(&ResultPicture, Rect, Camera)> {
        self.cells.values().find_map(|cell| {
            let (rect, camera) = cell.seen.filter(|(rect, _)| rect.contains(at))?;
            Some((cell.last.as_ref()?, rect, camera))
        })
    }
}

#[cfg(test)]
impl ModelView {
    /// Returns whether a model beside the main one is drawn.
    pub(crate) fn has_picture_beside(&self, at: usize) -> bool {
        self.pictures.has_beside(at)
    }

    /// Place of the cell of a model beside the main one.
    pub(crate) fn cell_beside(&self, model: &Path) -> Option<Rect> {
        self.row.cells.get(model)?.seen.map(|(cell, _)| cell)
    }

    /// Sentence in the cell of a model that cannot be shown.
    pub(crate) fn fault_beside(&self, model: &Path) -> Option<&String> {
        self.row.cells.get(model)?.fault.as_ref()
    }

    /// File of the model whose picture is in the cell of a model.
    pub(crate) fn pictured_beside(&self, model: &Path) -> Option<&PathBuf> {
        let picture = self.row.cells.get(model)?.last.as_ref()?;
        picture.model.linked.model.files.first()
    }
}

impl ModelView {
    /// Keeps the model as large in its cell as it was before the number of cells changed.
    pub(super) fn fit_to_cells(&mut self, count: usize, cell: Rect, picture: &ResultPicture) {
        let now = (count, aspect(cell));
        let Some((before, aspect_before)) = self.row.fitted.replace(now) else {
            return;
        };
        // A camera that was not moved is set up for the new cell instead.
        if before == count || self.navigation.is_untouched() {
            return;
        }
        let points = picture.model.placement.points_in_view(&picture.model.linked.model.mesh);
        let [after, before] = [now.1, aspect_before].map(|aspect| Framing::of(&points, aspect).height);
        self.navigation.camera.zoom(before / after);
    }

    /// Paints the models beside the main one, each in its cell, with its name and its buttons.
    pub(super) fn paint_beside(
        &mut self,
        ui: &mut Ui,
        cells: &[Rect],
        render: Option<&RenderState>,
        main: Option<&ResultPicture>,
        subject: &Subject<'_>,
        actions: &mut Vec<Action>,
    ) {
        let files: Vec<&Path> = subject
            .beside
            .iter()
            .map(|evaluation| evaluation.model.file())
            .collect();
        self.row.cells.retain(|file, _| files.contains(&file.as_path()));
        if let Some(render) = render {
            self.pictures.release_from(FIRST_BESIDE + files.len(), render);
        }
        let Some((first, others)) = cells.split_first().filter(|_| !files.is_empty()) else {
            return;
        };
        let line = egui::Stroke::new(1.0, subject.theme.background);
        if let Some(main) = main {
            let file = main.model.linked.model.files.first();
            let name = file.map_or_else(String::new, |file| file_stem(file).into_owned());
            let place = subject_menus::CaptionPlace {
                at: pos2(first.left() + 10.0, first.bottom() - 10.0),
                align: Align2::LEFT_CENTER,
                within: first.shrink(space::TIGHT),
            };
            self.captions.write(ui, subject.theme, "main model", &place, &name);
        }
        for (at, (evaluation, cell)) in subject.beside.iter().zip(others).enumerate() {
            let own = self.row.cells.entry(evaluation.model.file().to_owned()).or_default();
            own.fault = failure_of(evaluation);
            // An error is shown whether or not the main model has a picture.
            let state = match (&own.fault, render, main) {
                (Some(fault), _, _) => {
                    sentence_in_cell(ui, *cell, subject, fault);
                    None
                }
                (None, Some(render), Some(main)) => {
                    self.paint_cell(ui, at, *cell, evaluation, render, main, *first, subject)
                }
                _ => None,
            };
            ui.painter().rect_stroke(*cell, 0.0, line, egui::StrokeKind::Inside);
            if evaluation.is_busy() {
                ui.ctx().request_repaint_after(DRAWN_AGAIN);
            }
            name_row(ui, *cell, evaluation, state, subject, actions);
        }
    }

    /// Paints one model beside the main one, or a sentence about why it is not shown. Returns a word about its
    /// progress.
    fn paint_cell(
        &mut self,
        ui: &Ui,
        at: usize,
        cell: Rect,
        evaluation: &Evaluation,
        render: &RenderState,
        main: &ResultPicture,
        first: Rect,
        subject: &Subject<'_>,
    ) -> Option<String> {
        // A picture of the model that had this place before would stand under the name of this one.
        let newest = evaluation.results.picture(subject.shown);
        let newest = newest.filter(|picture| !evaluation.is_outdated(picture)).cloned();
        let state = state_of(evaluation, newest.is_some());
        let own = self.row.cells.entry(evaluation.model.file().to_owned()).or_default();
        let picture = newest.or_else(|| own.last.take());
        own.last.clone_from(&picture);
        let Some(picture) = picture else {
            let doing = doing(evaluation).unwrap_or_else(|| "Reading the model…".to_owned());
            sentence_in_cell(ui, cell, subject, &doing);
            return None;
        };
        let framing = own.framing(&picture.model, aspect(cell));
        let main_cell = self.row.cells.entry(PathBuf::new()).or_default();
        let of_main = main_cell.framing(&main.model, aspect(first));
        let camera = camera_beside(self.navigation.camera, of_main, framing);
        if let Some(own) = self.row.cells.get_mut(evaluation.model.file()) {
            own.seen = Some((cell, camera));
        }
        let request = PictureRequest {
            picture: &picture,
            shot: shot_of(camera, &self.shot, &picture, unlit_mode(subject)),
            lighting: &Lighting::of(&self.environment, &self.lights),
            is_moving: self.navigation.is_moving(),
        };
        let drawn = self
            .pictures
            .refresh(FIRST_BESIDE + at, ui, cell, evaluation.gpu(), render, &request);
        match drawn {
            Ok(Some(texture)) => {
                let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                ui.painter().image(texture, cell, whole, Color32::WHITE);
            }
            Ok(None) => {}
            Err(fault) => painting::sentence(ui, cell, subject.theme, &fault),
        }
        state
    }
}

/// Covers a cell with a sentence in place of a picture.
fn sentence_in_cell(ui: &Ui, cell: Rect, subject: &Subject<'_>, text: &str) {
    ui.painter().rect_filled(cell, 0.0, subject.theme.background);
    painting::sentence(ui, cell, subject.theme, text);
}

/// Words about the progress of a model while it does not show the wanted result.
fn state_of(evaluation: &Evaluation, has_picture: bool) -> Option<String> {
    let doing = doing(evaluation);
    match (has_picture, evaluation.is_busy()) {
        (false, _) => doing.or_else(|| Some("waiting".to_owned())),
        (true, true) => doing.or_else(|| Some("updating".to_owned())),
        (true, false) => None,
    }
}

/// Activity of the evaluation on a model; `None` while it waits for its turn.
fn doing(evaluation: &Evaluation) -> Option<String> {
    evaluation.activity().map(|activity| activity_text(&activity))
}

/// Sentence about why a model cannot be shown.
fn failure_of(evaluation: &Evaluation) -> Option<String> {
    let model = &evaluation.model;
    let failure = model.failure.as_ref().or(evaluation.lost.as_ref());
    let failure = failure.or(evaluation.failure.as_ref());
    failure.map(|error| format!("{}: {error}", file_stem(model.file())))
}

/// Room for the badge and the cross behind the state of a model in its cell, points.
const BADGE_AND_CROSS: f32 = 64.0;

/// Name of a model in its cell, which makes it the main one, and the button that removes it.
fn name_row(
    ui: &mut Ui,
    cell: Rect,
    evaluation: &Evaluation,
    state: Option<String>,
    subject: &Subject<'_>,
    actions: &mut Vec<Action>,
) {
    let row = Rect::from_min_max(
        pos2(cell.left() + space::USUAL, cell.bottom() - NAMES - 4.0),
        pos2(cell.right() - space::USUAL, cell.bottom() - 4.0),
    );
    let model = evaluation.model.file();
    let name = file_stem(model).into_owned();
    ui.scope_builder(UiBuilder::new().max_rect(row).id_salt(("beside", model)), |ui| {
        ui.set_clip_rect(cell);
        let frame = Frame::new()
            .fill(subject.theme.background.gamma_multiply(0.6))
            .corner_radius(space::CORNER)
            .inner_margin(Margin::symmetric(4, 0));
        frame.show(ui, |ui| {
            ui.horizontal(|ui| {
                let text = RichText::new(&name).size(type_size::SMALL);
                let button = ui.add(egui::Button::new(text).frame(false));
                button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, format!("{name} beside")));
                if button.on_hover_text("Make it the first model of the view").clicked() {
                    actions.push(Action::Model(ModelAction::Show(model.to_owned())));
                }
                if let Some(state) = state {
                    let words = RichText::new(state).size(type_size::SMALL).color(subject.theme.quiet);
                    let room = ui.available_width() - BADGE_AND_CROSS;
                    if room > 0.0 {
                        ui.scope(|ui| {
                            ui.set_max_width(room);
                            ui.add(egui::Label::new(words).truncate());
                        });
                    }
                }
                let warnings = evaluation.model.warnings();
                if model_warnings::badge(ui, subject.theme, &name, warnings) {
                    actions.push(Action::ShowPanel(Panel::Problems));
                }
                let remove = ui.add(egui::Button::new(RichText::new(icon::X).size(type_size::SMALL)).frame(false));
                remove.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, format!("Remove {name}")));
                if remove.on_hover_text("Remove it from the view").clicked() {
                    actions.push(Action::Model(ModelAction::RemoveBeside(model.to_owned())));
                }
            });
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_cover_the_view_side_by_side_and_stay_large() {
        let wide = Rect::from_min_size(pos2(10.0, 20.0), vec2(1200.0, 400.0));
        assert_eq!(cells(wide, 1), [wide]);
        let three = cells(wide, 3);
        assert_eq!(three[1], Rect::from_min_size(pos2(410.0, 20.0), vec2(400.0, 400.0)));
        let tall = Rect::from_min_size(pos2(0.0, 0.0), vec2(300.0, 900.0));
        assert_eq!(cells(tall, 3)[1].min, pos2(0.0, 300.0));
        let square = Rect::from_min_size(pos2(0.0, 0.0), vec2(600.0, 600.0));
        let four = cells(square, 4);
        assert_eq!(four[3], Rect::from_min_size(pos2(300.0, 300.0), vec2(300.0, 300.0)));
        for count in 1..=8 {
            let all = cells(square, count);
            assert_eq!(all.len(), count);
            assert!(all.iter().all(|cell| square.expand(0.1).contains_rect(*cell)));
        }
    }

    #[test]
    fn every_model_is_framed_alike_and_stays_so_while_the_camera_turns_and_zooms() {
        let cube = [Vec3::splat(-0.5), Vec3::splat(0.5)];
        let bar = [Vec3::new(-0.05, 0.0, -0.05), Vec3::new(0.05, 1.0, 0.05)];
        let [of_cube, of_bar] = [cube, bar].map(|points| Framing::of(&points, 1.0));
        let mut main = Camera::seen_from(Viewpoint::THREE_QUARTER, &cube, 1.0);
        let beside = camera_beside(main, of_cube, of_bar);
        let alone = Camera::seen_from(Viewpoint::THREE_QUARTER, &bar, 1.0);
        assert!((beside.target - alone.target).length() < 1e-4);
        assert!((beside.distance - alone.distance).abs() < 1e-4);
        main.turn(70.0);
        main.zoom(3.0);
        let beside = camera_beside(main, of_cube, of_bar);
        assert_eq!(beside.yaw_degrees, main.yaw_degrees);
        assert!((beside.distance - alone.distance / 3.0).abs() < 1e-4);
    }
}
