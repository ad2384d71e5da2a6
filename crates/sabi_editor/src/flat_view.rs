//! The 2D view: one result in texture space, with exact values, channels and a histogram.

mod bar;
mod brush;
mod eyedropper;
mod picture;
mod triangle_grid;
mod wires;

use std::sync::Arc;

use egui::{
    Align2, Color32, ColorImage, FontId, PointerButton, Pos2, Rect, Sense, Stroke, TextureHandle, TextureOptions, Ui,
    Vec2, WidgetInfo, WidgetType, pos2, vec2,
};
use egui_phosphor::regular as icon;
use sabi_engine::live::InspectedResult;
use sabi_export::SetKey;
use sabi_graph::NodeRef;

use crate::action::{Action, ClickedColor, LookAction};
use crate::activity_text::activity_text;
use crate::brush::{BrushTool, PaintSubject, ShownPath};
use crate::command::TextureCommand;
use crate::context::{View, ViewContext};
use crate::evaluation::Evaluation;
use crate::outdated_results;
use crate::shown_results::title_of;
use crate::task::{Task, TaskFailure};
use crate::theme::{Theme, space, type_size};
use brush::{SeenTexture, TriangleGrids};
pub(crate) use picture::Histogram;
use picture::picture_of;
use wires::Wires;

/// Columns of a histogram.
const BINS: usize = 128;

/// View of one result in texture space.
pub(crate) struct FlatView {
    /// Middle of the texture relative to the middle of the panel, points.
    pan: Vec2,
    /// Points in one texel; `None` to fit the texture to the panel.
    pub(crate) zoom: Option<f32>,
    /// Texture set of the model that is shown; the first where the model does not have this one.
    pub(crate) set: Option<SetKey>,
    /// Index of the plane that is shown.
    plane: usize,
    /// Component of the plane that is shown alone; `None` for all as a color.
    component: Option<usize>,
    is_tiled: bool,
    has_wires: bool,
    /// Picture that is shown until another one is made.
    shown: Option<ShownPicture>,
    /// Source for which making a picture has failed.
    failed: Option<PictureSource>,
    /// Picture that is being made.
    loading: Option<(PictureSource, Task<(ColorImage, Histogram)>)>,
    wires: Wires,
    /// Triangles by their places in the texture, among which the brush finds the one under the pointer.
    triangles: TriangleGrids,
    brush: BrushTool,
}

/// Source of a picture: values, the index of a plane, and a component of it.
type PictureSource = (Arc<InspectedResult>, usize, Option<usize>);

struct ShownPicture {
    of: PictureSource,
    texture: TextureHandle,
    histogram: Histogram,
}

/// Result that the view shows, and its state.
struct FlatViewSubject<'a> {
    /// Result to show; `None` before a node is clicked.
    wanted: Option<&'a NodeRef>,
    /// Title of the result.
    title: &'a str,
    /// Sentence about why there is no result.
    fault: Option<String>,
    /// True if the result is pinned.
    is_pinned: bool,
    /// True if a click picks a color.
    is_picking_color: bool,
    /// The node that drags paint on, while they paint.
    painted: Option<&'a PaintSubject>,
    theme: &'a Theme,
}

/// Requests made in the view.
#[derive(Default)]
struct FlatViewOutput {
    /// True if the pin was clicked.
    unpins: bool,
    /// Clicked color.
    color: Option<ClickedColor>,
    /// Actions of the brush.
    actions: Vec<Action>,
}

impl Default for FlatView {
    fn default() -> FlatView {
        FlatView {
            pan: Vec2::ZERO,
            zoom: None,
            set: None,
            plane: 0,
            component: None,
            is_tiled: false,
            has_wires: false,
            shown: None,
            failed: None,
            loading: None,
            wires: Wires::default(),
            triangles: TriangleGrids::default(),
            brush: BrushTool::default(),
        }
    }
}

impl View for FlatView {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let looks = context.looks;
        let wanted = looks.inspected();
        let title = wanted.map_or_else(String::new, |result| title_of(context.document, result));
        let painted = PaintSubject::of(context);
        let fault = wanted.and_then(|node| context.evaluation.faults.sentence(&node.node));
        let subject = FlatViewSubject {
            wanted,
            title: &title,
            fault: fault.map(|sentence| context.said(sentence)),
            is_pinned: looks.pinned_2d.is_some(),
            is_picking_color: looks.color_target.is_some(),
            painted: painted.as_ref(),
            theme: context.theme,
        };
        let output = self.draw(ui, context.evaluation, &subject);
        let unpin = output.unpins.then_some(Action::Look(LookAction::UnpinFrom2d));
        let color = output.color.map(Action::TakeColor);
        unpin.into_iter().chain(color).chain(output.actions).collect()
    }
}

impl FlatView {
    /// Draws the result of the inspected node.
    fn draw(&mut self, ui: &mut Ui, evaluation: &Evaluation, subject: &FlatViewSubject<'_>) -> FlatViewOutput {
        let mut output = FlatViewOutput::default();
        let FlatViewSubject {
            wanted, theme, title, ..
        } = *subject;
        let inspected = evaluation.results.inspected.as_ref();
        let values = inspected
            .filter(|(node, _)| Some(node) == wanted)
            .map(|(_, values)| values.clone());
        output.unpins = self.bar(ui, evaluation, subject, values.as_deref());
        let Some(values) = values else {
            let doing = evaluation
                .activity()
                .map_or_else(|| "Evaluating…".to_owned(), |activity| activity_text(&activity));
            let sentence = match (wanted, subject.fault.as_deref()) {
                (_, Some(fault)) => fault,
                (Some(_), None) => &doing,
                (None, None) => "Click a node to see its result as a texture.",
            };
            ui.centered_and_justified(|ui| ui.colored_label(theme.quiet, sentence));
            return output;
        };
        let rect = ui.available_rect_before_wrap();
        if !rect.is_positive() {
            return output;
        }
        self.refresh(ui, &values);
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, format!("Texture of {title}")));
        let painter = ui.painter().with_clip_rect(rect);
        painter.rect_filled(rect, 0.0, theme.background);
        let Some(shown) = &self.shown else {
            self.tell_failure(&painter, rect, theme);
            return output;
        };
        let square = self.paint(&painter, shown, rect, values.size);
        painter.rect_stroke(square, 0.0, Stroke::new(1.0, theme.line), egui::StrokeKind::Outside);
        if self.has_wires
            && let Some(model) = &evaluation.model.received
        {
            self.wires.draw(&painter, model, values.set.key, square, theme);
        }
        let canvas = self.canvas(evaluation, square, values.set.key);
        if !self.paint_on(ui, &response, evaluation, subject, &canvas, &mut output) {
            self.turn(ui, &response, rect, &values);
        }
        self.probe(ui, &response, square, &values, theme);
        if let Some(shown) = &self.shown {
            shown.histogram.draw(&painter, rect, square, theme);
        }
        if evaluation.is_inspected_outdated() {
            outdated_results::cover(&painter, rect, evaluation, theme);
        } else if let Some(activity) = evaluation.activity().filter(|_| evaluation.is_busy()) {
            let text = format!("{} {}", icon::HOURGLASS_MEDIUM, activity_text(&activity));
            // Above the histogram.
            let corner = rect.right_bottom() - vec2(8.0, picture::HISTOGRAM + 2.0 * space::USUAL);
            let font = FontId::proportional(type_size::SMALL);
            painter.text(corner, Align2::RIGHT_BOTTOM, text, font, theme.quiet);
        }
        if subject.is_picking_color {
            output.color = self.clicked_color(&response, square, &values);
        }
        output
    }

    /// Says that no picture could be made, if that is so.
    fn tell_failure(&self, painter: &egui::Painter, rect: Rect, theme: &Theme) {
        if self.failed.is_some() {
            let sentence = "No picture could be made of this result, which is a bug in the program.";
            let font = FontId::proportional(type_size::BODY);
            painter.text(rect.center(), Align2::CENTER_CENTER, sentence, font, theme.fault);
        }
    }

    /// The texture set in a square of the screen, for the brush.
    fn canvas(&mut self, evaluation: &Evaluation, square: Rect, set: SetKey) -> SeenTexture {
        let model = evaluation.model.received.as_ref();
        SeenTexture {
            // Without a model, no place is looked up.
            triangles: model.map_or_else(Default::default, |model| self.triangles.of(model, set)),
            square,
            set,
        }
    }

    /// Lets the brush paint on the texture, and draws the marked path over it. Returns whether the drag belongs to the
    /// brush.
    fn paint_on(
        &mut self,
        ui: &Ui,
        response: &egui::Response,
        evaluation: &Evaluation,
        subject: &FlatViewSubject<'_>,
        canvas: &SeenTexture,
        output: &mut FlatViewOutput,
    ) -> bool {
        let model = evaluation.model.received.as_ref();
        model.is_some_and(|model| {
            let is_drag = self
                .brush
                .paint(ui, response, subject.painted, model, canvas, &mut output.actions);
            let stroke = subject.painted.and_then(|painted| painted.path.as_ref());
            if let Some(path) = stroke.and_then(|stroke| ShownPath::of(model, canvas, stroke)) {
                path.show(&ui.painter().with_clip_rect(response.rect), subject.theme.accent);
            }
            is_drag
        })
    }

    /// Paints the picture, with copies around it if it is tiled. Returns its rectangle.
    fn paint(&self, painter: &egui::Painter, shown: &ShownPicture, rect: Rect, size: u32) -> Rect {
        let side = size as f32 * self.scale(rect, size);
        let square = Rect::from_center_size(rect.center() + self.pan, Vec2::splat(side));
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let copies: &[i32] = if self.is_tiled { &[-1, 0, 1] } else { &[0] };
        for row in copies {
            for column in copies {
                let tint = if (*row, *column) == (0, 0) {
                    Color32::WHITE
                } else {
                    Color32::from_white_alpha(110)
                };
                let copy = square.translate(vec2(*column as f32, *row as f32) * side);
                painter.image(shown.texture.id(), copy, whole, tint);
            }
        }
        square
    }

    /// Returns whether a picture of these values is shown.
    #[cfg(test)]
    pub(crate) fn shows(&self, values: &Arc<InspectedResult>) -> bool {
        let shown = self.shown.as_ref();
        shown.is_some_and(|shown| Arc::ptr_eq(&shown.of.0, values))
    }

    /// Performs a command about the 2D view.
    pub(crate) fn command(&mut self, command: TextureCommand) {
        match command {
            TextureCommand::ShowAll => (self.pan, self.zoom) = (Vec2::ZERO, None),
            TextureCommand::TrueSize => self.zoom = Some(1.0),
            TextureCommand::Tile => self.is_tiled = !self.is_tiled,
            TextureCommand::UvWires => self.has_wires = !self.has_wires,
        }
    }

    /// Starts to make a picture on a thread of its own if a new one is needed; until it is done, the last one is shown.
    fn refresh(&mut self, ui: &Ui, values: &Arc<InspectedResult>) {
        let Some(plane) = values.planes.get(self.plane) else {
            self.shown = None;
            return;
        };
        let component = self.component.filter(|at| *at < plane.components);
        let wanted = (values.clone(), self.plane, component);
        let is_wanted = |of: &PictureSource| Arc::ptr_eq(&of.0, &wanted.0) && (of.1, of.2) == (wanted.1, wanted.2);
        if let Some(come) = self.loading.as_ref().and_then(|(_, task)| task.poll())
            && let Some((of, _)) = self.loading.take()
        {
            match come {
                Ok((image, histogram)) => self.take(ui, of, image, histogram),
                Err(TaskFailure) => (self.shown, self.failed) = (None, Some(of)),
            }
        }
        let mut known = self
            .shown
            .as_ref()
            .map(|shown| &shown.of)
            .into_iter()
            .chain(&self.failed);
        let is_there = known.any(is_wanted);
        if is_there || self.loading.is_some() {
            return;
        }
        let (values, at, component) = wanted.clone();
        let task = Task::start(ui.ctx(), move || {
            let plane = &values.planes[at];
            (
                picture_of(&values, plane, component),
                Histogram::of(&values, plane, component, BINS),
            )
        });
        self.loading = Some((wanted, task));
    }

    fn take(&mut self, ui: &Ui, of: PictureSource, image: ColorImage, histogram: Histogram) {
        let options = TextureOptions {
            magnification: egui::TextureFilter::Nearest,
            ..TextureOptions::LINEAR
        };
        self.shown = Some(match self.shown.take() {
            Some(mut shown) => {
                shown.texture.set(image, options);
                ShownPicture { of, histogram, ..shown }
            }
            None => ShownPicture {
                of,
                histogram,
                texture: ui.ctx().load_texture("texture of a result", image, options),
            },
        });
    }

    fn scale(&self, rect: Rect, size: u32) -> f32 {
        let fitting = (rect.width().min(rect.height()) - 2.0 * space::USUAL).max(8.0) / size.max(1) as f32;
        self.zoom.unwrap_or(fitting)
    }

    fn turn(&mut self, ui: &Ui, response: &egui::Response, rect: Rect, values: &InspectedResult) {
        let (delta, scroll) = ui.input(|input| (input.pointer.delta(), input.smooth_scroll_delta().y));
        if response.dragged_by(PointerButton::Middle) || response.dragged_by(PointerButton::Primary) {
            self.pan += delta;
        }
        let Some(pointer) = response.hover_pos().filter(|_| scroll != 0.0) else {
            return;
        };
        let before = self.scale(rect, values.size);
        let after = (before * (scroll * 0.0025).exp()).clamp(0.02, 64.0);
        let held = pointer - rect.center() - self.pan;
        self.pan += held - held * (after / before);
        self.zoom = Some(after);
    }

    /// Shows the exact values under the pointer.
    fn probe(&self, ui: &Ui, response: &egui::Response, square: Rect, values: &InspectedResult, theme: &Theme) {
        let Some(at) = response.hover_pos() else { return };
        let Some(([x, y], texel)) = self.texel_at(at, square, values.size) else {
            return;
        };
        let Some(plane) = values.planes.get(self.plane) else {
            return;
        };
        let numbers = &plane.values[texel * plane.components..(texel + 1) * plane.components];
        let numbers: Vec<String> = numbers.iter().map(|number| format!("{number}")).collect();
        let where_to = if values.is_on_surface[texel] {
            ""
        } else {
            "  (outside the UV islands)"
        };
        let text = format!("{x}, {y}   {}{where_to}", numbers.join("  "));
        let font = FontId::monospace(type_size::SMALL);
        let corner = response.rect.left_bottom() + vec2(space::USUAL, -space::USUAL);
        let galley = ui.painter().layout_no_wrap(text.clone(), font, theme.text);
        let rect = Align2::LEFT_BOTTOM.anchor_size(corner, galley.size());
        ui.painter().rect_filled(rect.expand(3.0), space::CORNER, theme.panel);
        ui.painter().galley(rect.min, galley, theme.text);
        let probe = ui.interact(rect, ui.id().with("probe"), Sense::hover());
        probe.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, &text));
    }

    /// Texel under a place, by column and row and by its index; `None` beside the picture.
    fn texel_at(&self, at: Pos2, square: Rect, size: u32) -> Option<([usize; 2], usize)> {
        let share = (at - square.min) / square.size();
        let inside = |share: f32| if self.is_tiled { share.rem_euclid(1.0) } else { share };
        let [x, y] = [inside(share.x), inside(share.y)].map(|share| (share * size as f32).floor());
        let limits = 0.0..size as f32;
        let is_inside = limits.contains(&x) && limits.contains(&y);
        let place = [x as usize, y as usize];
        is_inside.then(|| (place, place[1] * size as usize + place[0]))
    }
}
