//! The question for a line over a picture, along which a gradient is picked.

use std::path::PathBuf;

use egui::{
    Align2, Button, Color32, ColorImage, Context, FontId, Id, Modal, Pos2, Rect, Response, RichText, Sense, Stroke,
    TextureHandle, TextureOptions, Ui, Vec2, WidgetInfo, WidgetType,
};
use sabi_editing::knob_target::KnobTarget;
use sabi_engine::picked_gradient::PickedPicture;
use sabi_engine::source::SessionPictures;
use sabi_nodes::kind::{WrittenStop, WrittenValue};

use crate::action::Action;
use crate::context::{View, ViewContext};
use crate::knobs::paint_gradient;
use crate::paths::file_name;
use crate::task::Task;
use crate::theme::{Theme, space, type_size};

/// Most pixels along a side of the picture that colors are picked from.
const MOST_PIXELS: u32 = 1024;
/// Most points that the picture takes in the window, and height of the gradient below it.
const ROOM: Vec2 = Vec2::new(640.0, 420.0);
const RAMP: f32 = 28.0;
/// Distance at which the pointer takes an end of the line, points.
const NEAR: f32 = 12.0;
/// Most stops of a gradient, as `shaders/nodes/color/gradient.wgsl` has room for.
pub(crate) const MOST_STOPS: usize = 16;

/// The question, while it is open.
#[derive(Default)]
pub(crate) struct GradientPicker {
    picking: Option<GradientPick>,
}

/// A gradient that is being picked.
struct GradientPick {
    parameter: KnobTarget,
    file: PathBuf,
    state: PickState,
}

/// Picture that is picked from.
enum PickState {
    Loading(Task<Result<PickedPicture, String>>),
    /// Reason why there is no picture.
    Failed(String),
    Shown(Box<PictureWithLine>),
}

/// Picture with the line over it.
struct PictureWithLine {
    picture: PickedPicture,
    texture: TextureHandle,
    /// Ends of the line: 0 to 1 to the right and down.
    line: [[f64; 2]; 2],
    /// End that is dragged.
    held: usize,
    stops: Vec<WrittenStop>,
}

/// Answer in a frame.
enum PickerAnswer {
    None,
    Use,
    Another,
    Closed,
}

impl GradientPicker {
    /// Opens a picture.
    pub(crate) fn open(&mut self, context: &Context, parameter: KnobTarget, file: PathBuf) {
        let read = file.clone();
        let task = Task::start(context, move || {
            PickedPicture::read(&SessionPictures::default(), &read, MOST_PIXELS)
        });
        self.picking = Some(GradientPick {
            parameter,
            file,
            state: PickState::Loading(task),
        });
    }
}

impl View for GradientPicker {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let Some(picking) = &mut self.picking else {
            return Vec::new();
        };
        picking.state.advance(ui.ctx());
        let mut answer = PickerAnswer::None;
        let modal = Modal::new(Id::new("gradient picker")).show(ui.ctx(), |ui| {
            ui.set_width(ROOM.x);
            ui.heading("Pick a gradient");
            ui.label(RichText::new(file_name(&picking.file)).color(context.theme.quiet));
            picking.state.show(ui, context.theme);
            answer = picking.buttons(ui);
        });
        if modal.should_close() && matches!(answer, PickerAnswer::None) {
            answer = PickerAnswer::Closed;
        }
        match answer {
            PickerAnswer::None => Vec::new(),
            PickerAnswer::Closed => {
                self.picking = None;
                Vec::new()
            }
            PickerAnswer::Another => self.end(|picking| Some(Action::AskForGradient(picking.parameter))),
            PickerAnswer::Use => self.end(|picking| {
                let PickState::Shown(shown) = picking.state else {
                    return None;
                };
                let stops = WrittenValue::Stops(shown.stops).to_value();
                let parameter = picking.parameter;
                Some(Action::SetGradient { parameter, stops })
            }),
        }
    }
}

impl GradientPicker {
    /// Returns whether a picture is shown.
    #[cfg(test)]
    pub(crate) fn has_picture(&self) -> bool {
        matches!(&self.picking, Some(picking) if matches!(picking.state, PickState::Shown(_)))
    }

    /// Returns whether a picture could not be read.
    #[cfg(test)]
    pub(crate) fn has_fault(&self) -> bool {
        matches!(&self.picking, Some(picking) if matches!(picking.state, PickState::Failed(_)))
    }

    fn end(&mut self, action: impl FnOnce(GradientPick) -> Option<Action>) -> Vec<Action> {
        self.picking.take().and_then(action).into_iter().collect()
    }
}

impl GradientPick {
    fn buttons(&self, ui: &mut Ui) -> PickerAnswer {
        let can_use = matches!(self.state, PickState::Shown(_));
        let mut answer = PickerAnswer::None;
        ui.horizontal(|ui| {
            if ui
                .add_enabled(can_use, Button::new(RichText::new("Use it").strong()))
                .clicked()
            {
                answer = PickerAnswer::Use;
            }
            if ui.button("Another picture…").clicked() {
                answer = PickerAnswer::Another;
            }
            if ui.button("Cancel").clicked() {
                answer = PickerAnswer::Closed;
            }
        });
        answer
    }
}

impl PickState {
    /// Takes a picture that was read.
    fn advance(&mut self, context: &Context) {
        let PickState::Loading(task) = self else { return };
        let Some(read) = task.poll() else { return };
        *self = match read {
            Ok(Ok(picture)) => PickState::Shown(Box::new(PictureWithLine::new(context, picture))),
            Ok(Err(why)) => PickState::Failed(why),
            Err(_) => PickState::Failed("The picture could not be read; try again, or choose another one.".to_owned()),
        };
    }

    fn show(&mut self, ui: &mut Ui, theme: &Theme) {
        match self {
            PickState::Loading(_) => {
                ui.label("Reading the picture…");
            }
            PickState::Failed(why) => {
                ui.colored_label(theme.fault, why.as_str());
            }
            PickState::Shown(shown) => shown.show(ui, theme),
        }
    }
}

impl PictureWithLine {
    fn new(context: &Context, picture: PickedPicture) -> PictureWithLine {
        let size = picture.pixels.size.map(|side| side as usize);
        let image = ColorImage::from_rgba_unmultiplied(size, &picture.pixels.rgba);
        let mut shown = PictureWithLine {
            texture: context.load_texture("picture to pick from", image, TextureOptions::LINEAR),
            picture,
            line: [[0.1, 0.5], [0.9, 0.5]],
            held: 1,
            stops: Vec::new(),
        };
        shown.pick();
        shown
    }

    fn pick(&mut self) {
        let [from, to] = self.line;
        self.stops = self.picture.gradient(from, to, MOST_STOPS);
    }

    fn show(&mut self, ui: &mut Ui, theme: &Theme) {
        ui.label("Drag a line over the picture, or click to move the nearer end of the line.");
        let size = self.texture.size_vec2();
        let scale = (ROOM / size).min_elem();
        let picture = |ui: &mut Ui| ui.allocate_exact_size(size * scale, Sense::click_and_drag());
        let (rect, response) = ui.vertical_centered(picture).inner;
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, ui.is_enabled(), "Picture to pick from"));
        if self.take(rect, &response) {
            self.pick();
        }
        let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
        ui.painter().image(self.texture.id(), rect, whole, Color32::WHITE);
        self.paint_line(ui, rect);
        ui.add_space(space::USUAL);
        let (ramp, response) = ui.allocate_exact_size(Vec2::new(ROOM.x, RAMP), Sense::hover());
        paint_gradient(ui.painter(), ramp, &self.stops);
        let count = match self.stops.len() {
            1 => "1 stop".to_owned(),
            count => format!("{count} stops"),
        };
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, ui.is_enabled(), &count));
        ui.label(RichText::new(count).size(type_size::SMALL).color(theme.quiet));
    }

    /// Moves the line by the pointer. Returns whether it has changed.
    fn take(&mut self, rect: Rect, response: &Response) -> bool {
        let Some(place) = response.interact_pointer_pos() else {
            return false;
        };
        let share = |place: Pos2| {
            let at = (place - rect.min) / rect.size();
            [f64::from(at.x), f64::from(at.y)].map(|at| at.clamp(0.0, 1.0))
        };
        let far = |end: &usize| place_of(rect, self.line[*end]).distance(place);
        let nearer = usize::from(far(&1) < far(&0));
        if response.drag_started() {
            // Includes the distance until the press became a drag.
            let origin = place - response.total_drag_delta().unwrap_or_default();
            let near = (0..2).find(|end| place_of(rect, self.line[*end]).distance(origin) < NEAR);
            if near.is_none() {
                self.line[0] = share(origin);
            }
            self.held = near.unwrap_or(1);
        } else if response.clicked() {
            self.held = nearer;
        } else if !response.dragged() {
            return false;
        }
        let was = std::mem::replace(&mut self.line[self.held], share(place));
        was != self.line[self.held]
    }

    fn paint_line(&self, ui: &Ui, rect: Rect) {
        let ends = self.line.map(|end| place_of(rect, end));
        let painter = ui.painter();
        painter.line_segment(ends, Stroke::new(4.0, Color32::BLACK));
        painter.line_segment(ends, Stroke::new(2.0, Color32::WHITE));
        for (end, name) in ends.iter().zip(["0", "1"]) {
            painter.circle(*end, 7.0, Color32::WHITE, Stroke::new(1.5, Color32::BLACK));
            let font = FontId::proportional(type_size::SMALL);
            painter.text(*end, Align2::CENTER_CENTER, name, font, Color32::BLACK);
        }
    }
}

fn place_of(rect: Rect, end: [f64; 2]) -> Pos2 {
    rect.min + rect.size() * Vec2::new(end[0] as f32, end[1] as f32)
}
