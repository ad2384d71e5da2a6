//! Bars: numbers that are dragged, stepped or typed.

use egui::text_edit::TextEditState;
use egui::{
    Align2, CursorIcon, Event, Id, Key, Modifiers, MouseWheelUnit, Rect, Response, Sense, Ui, WidgetInfo, accesskit,
};

use super::buttons::focus_ring;
use super::keys::{FINE, lock_arrow_keys};
use super::knob_ui::{DragValues, KnobUi};
use super::length::Quantity;
use super::text_field::{FieldResult, KnobTextField};
use super::text_painting::write;
use super::values::{rounded, step_of, text_of};
use super::{KnobRow, keys};
use crate::theme::{space, type_size};

/// Keys, and the steps of each.
const STEPS: [(Key, f64); 6] = [
    (Key::ArrowRight, 1.0),
    (Key::ArrowUp, 1.0),
    (Key::ArrowLeft, -1.0),
    (Key::ArrowDown, -1.0),
    (Key::PageUp, 10.0),
    (Key::PageDown, -10.0),
];
/// Points of smooth scrolling for one step.
const POINTS_OF_A_STEP: f32 = 24.0;
/// Least width that drags are measured with, points.
const LEAST_WIDTH: f64 = 120.0;

/// Bar of one number.
pub(super) struct NumberBar<'a> {
    pub(super) id: Id,
    /// Id of the row below which errors are shown.
    pub(super) row_id: Id,
    pub(super) row: &'a KnobRow<'a>,
    pub(super) rect: Rect,
    /// Accessible name.
    pub(super) name: &'a str,
    /// Text in the bar.
    pub(super) inside: &'a str,
    pub(super) value: f64,
    /// Values at which the bar is empty and full.
    pub(super) ends: [f64; 2],
    /// Limits of the value.
    pub(super) range: Option<[f64; 2]>,
    pub(super) is_whole: bool,
    pub(super) measure: Quantity,
    /// True if the bar is filled up to its value.
    pub(super) is_filled: bool,
}

/// Result of a bar in this frame.
#[derive(Debug, Default)]
pub(super) struct BarResponse {
    /// New value, if it changed.
    pub(super) value: Option<f64>,
    /// True if the pointer is over the bar or drags it, or if its value is being typed.
    pub(super) is_active: bool,
}

impl NumberBar<'_> {
    pub(super) fn show(&self, ui: &mut Ui, knob_ui: &mut KnobUi<'_>) -> BarResponse {
        if knob_ui.is_typing(self.id) {
            let value = self.typed(ui, knob_ui);
            return BarResponse { value, is_active: true };
        }
        let response = ui
            .interact(self.rect, self.id, Sense::click_and_drag())
            .on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
        self.describe(ui, &response);
        if ui.is_rect_visible(self.rect) {
            self.paint(ui, knob_ui, &response);
        }
        let value = self.dragged(ui, knob_ui, &response);
        let value = value.or_else(|| self.keyed(ui, knob_ui, &response));
        let value = value.or_else(|| self.wheeled(ui, knob_ui, &response));
        self.open(ui, knob_ui, &response);
        BarResponse {
            value,
            is_active: response.hovered() || knob_ui.is_dragged(self.id),
        }
    }

    fn step(&self) -> f64 {
        step_of(self.ends, self.is_whole)
    }

    /// Number within the limits, rounded to the digits of a step.
    fn settled(&self, number: f64, step: f64) -> f64 {
        let near = if self.is_whole {
            number.round()
        } else {
            rounded(number, step)
        };
        self.clamped(near)
    }

    fn clamped(&self, number: f64) -> f64 {
        let [low, high] = self.range.unwrap_or([f64::MIN, f64::MAX]);
        number.max(low).min(high)
    }

    fn dragged(&self, ui: &Ui, knob_ui: &mut KnobUi<'_>, response: &Response) -> Option<f64> {
        let is_fine = ui.input(|input| input.modifiers.shift);
        let speed = if is_fine { FINE } else { 1.0 };
        let (delta, drag) = knob_ui.drag_delta(response, |_| Some(DragValues::of([self.value, 0.0, 0.0])))?;
        let points = f64::from(self.rect.width()).max(LEAST_WIDTH);
        let exact = drag.values.exact[0] + f64::from(delta.x) / points * (self.ends[1] - self.ends[0]) * speed;
        drag.values.exact[0] = self.clamped(exact);
        Some(self.settled(drag.values.exact[0], self.step() * FINE * speed))
    }

    /// Handles keys, and requests of assistive technology.
    fn keyed(&self, ui: &Ui, knob_ui: &mut KnobUi<'_>, response: &Response) -> Option<f64> {
        let mut steps = ui.input(|input| {
            let requests = |action| input.num_accesskit_action_requests(self.id, action) as f64;
            requests(accesskit::Action::Increment) - requests(accesskit::Action::Decrement)
        });
        let mut jump = ui.input(|input| {
            let mut requests = input.accesskit_action_requests(self.id, accesskit::Action::SetValue);
            requests.find_map(|request| match &request.data {
                Some(accesskit::ActionData::NumericValue(number)) => Some(*number),
                Some(accesskit::ActionData::Value(text)) => self.measure.evaluate(text, Some(self.value)).ok(),
                _ => None,
            })
        });
        if response.has_focus() {
            lock_arrow_keys(ui, response);
            ui.input_mut(|input| {
                for (key, step) in STEPS {
                    steps += step * keys::steps(input, key);
                }
                for (key, end) in [(Key::Home, self.ends[0]), (Key::End, self.ends[1])] {
                    jump = input.consume_key(Modifiers::NONE, key).then_some(end).or(jump);
                }
            });
            let is_erased = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
            if is_erased(Key::Backspace) || is_erased(Key::Delete) {
                knob_ui.reset(self.row);
            }
        }
        jump.map(|number| self.settled(number, self.step() * FINE))
            .or_else(|| self.stepped(steps))
    }

    /// Steps by the wheel while Ctrl is held.
    fn wheeled(&self, ui: &Ui, knob_ui: &mut KnobUi<'_>, response: &Response) -> Option<f64> {
        if !response.hovered() {
            return None;
        }
        let turn: f32 = ui.input(|input| {
            let turns = input.events.iter().map(|event| match event {
                Event::MouseWheel {
                    unit, delta, modifiers, ..
                } if modifiers.command || modifiers.ctrl => match unit {
                    MouseWheelUnit::Point => delta.y / POINTS_OF_A_STEP,
                    MouseWheelUnit::Line | MouseWheelUnit::Page => delta.y,
                },
                _ => 0.0,
            });
            turns.sum()
        });
        let whole = (knob_ui.memory.wheel + turn).trunc();
        knob_ui.memory.wheel += turn - whole;
        let is_fine = ui.input(|input| input.modifiers.shift);
        self.stepped(f64::from(whole) * if is_fine { FINE } else { 1.0 })
    }

    fn stepped(&self, steps: f64) -> Option<f64> {
        // Whole numbers have no fine steps.
        let steps = if self.is_whole && steps != 0.0 {
            steps.signum() * steps.abs().ceil()
        } else {
            steps
        };
        (steps != 0.0).then(|| self.settled(self.value + steps * self.step(), self.step() * FINE * FINE))
    }

    /// Opens the text field by a click or a key, or takes the keyboard focus.
    fn open(&self, ui: &Ui, knob_ui: &mut KnobUi<'_>, response: &Response) {
        let [has_command, is_entered] = ui.input(|input| {
            [
                input.modifiers.command || input.modifiers.ctrl,
                input.key_pressed(Key::Enter),
            ]
        });
        let is_opened = response.double_clicked() || response.clicked() && has_command;
        if is_opened || response.has_focus() && is_entered {
            let text = if self.row.differs {
                String::new()
            } else {
                self.precise()
            };
            knob_ui.open_field(self.id, text, true);
        } else if response.clicked() {
            response.request_focus();
        } else if response.has_focus() {
            // A digit replaces the number.
            let typed = ui.input(|input| {
                input.events.iter().find_map(|event| match event {
                    Event::Text(text) if text.starts_with(|first: char| "0123456789.-+*/=(".contains(first)) => {
                        Some(text.clone())
                    }
                    _ => None,
                })
            });
            if let Some(text) = typed {
                knob_ui.open_field(self.id, text, false);
            }
        }
    }

    /// Number with all of its digits.
    fn precise(&self) -> String {
        format!("{}{}", self.value, self.measure.sign())
    }

    fn typed(&self, ui: &mut Ui, knob_ui: &mut KnobUi<'_>) -> Option<f64> {
        let shown = if self.row.differs {
            String::new()
        } else {
            self.precise()
        };
        let typed = knob_ui.field(
            ui,
            &KnobTextField {
                // The text field has the id of the bar, so that the keyboard stays with it.
                id: self.id,
                rect: self.rect,
                name: self.name,
                shown: &shown,
                hint: "",
            },
        );
        let [is_entered, is_left] = ui.input(|input| [input.key_pressed(Key::Enter), input.key_pressed(Key::Escape)]);
        let value = match typed {
            FieldResult::Editing => return None,
            FieldResult::Unchanged => None,
            FieldResult::Changed(text) => {
                let present = (!self.row.differs).then_some(self.value);
                match self.measure.evaluate(&text, present).and_then(kept) {
                    Ok(number) => Some(self.clamped(if self.is_whole { number.round() } else { number })),
                    Err(sentence) => {
                        knob_ui.fault(self.row_id, sentence);
                        if is_entered {
                            knob_ui.open_field(self.id, text, false);
                            return None;
                        }
                        None
                    }
                }
            }
        };
        if is_entered || is_left {
            // A quirk of egui: while it has the state of a text field under this id, it treats the widget as a text
            // field.
            ui.data_mut(|data| data.remove::<TextEditState>(self.id));
            ui.memory_mut(|memory| memory.request_focus(self.id));
        }
        value
    }

    fn shown(&self) -> String {
        match self.row.differs {
            true => "mixed".to_owned(),
            false => format!("{}{}", text_of(self.value, self.step()), self.measure.sign()),
        }
    }

    fn describe(&self, ui: &Ui, response: &Response) {
        response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), self.value, self.name));
        ui.ctx().accesskit_node_builder(self.id, |node| {
            let note = self.measure.note(self.value).filter(|_| !self.row.differs);
            node.set_value(match note {
                Some(note) => format!("{} = {note} here", self.shown()),
                None => self.shown(),
            });
            if let Some([low, high]) = self.range {
                node.set_min_numeric_value(low);
                node.set_max_numeric_value(high);
            }
            node.set_numeric_value_step(self.step());
            node.add_action(accesskit::Action::SetValue);
            node.add_action(accesskit::Action::Increment);
            node.add_action(accesskit::Action::Decrement);
        });
    }

    fn paint(&self, ui: &Ui, knob_ui: &KnobUi<'_>, response: &Response) {
        let theme = knob_ui.theme;
        let painter = ui.painter();
        let is_held = response.hovered() || knob_ui.is_dragged(self.id);
        let ground = if is_held { theme.hovered } else { theme.raised };
        painter.rect_filled(self.rect, space::CORNER, ground);
        if self.is_filled && !self.row.differs {
            let (mix, share) = if self.row.is_changed() {
                (theme.accent, 0.42)
            } else {
                (theme.quiet, 0.24)
            };
            let [begin, end] = self.filled().map(|share| egui::lerp(self.rect.x_range(), share));
            let within = Rect::from_x_y_ranges(begin.min(end)..=begin.max(end), self.rect.y_range());
            let fill = ground.lerp_to_gamma(mix, share);
            painter
                .with_clip_rect(within.intersect(ui.clip_rect()))
                .rect_filled(self.rect, space::CORNER, fill);
            // Marks the end of the filled part, which is at the value.
            let x = end.min(self.rect.right() - 1.0).max(self.rect.left() + 1.0);
            let edge = ground.lerp_to_gamma(mix, 0.9);
            painter.vline(x, self.rect.shrink(3.0).y_range(), (1.5, edge));
        }
        focus_ring(ui, knob_ui, response);
        let within = self.rect.shrink2(egui::vec2(6.0 * knob_ui.zoom, 0.0));
        let size = type_size::BODY * knob_ui.zoom;
        let color = if self.row.differs { theme.quiet } else { theme.text };
        let taken = write(painter, within, Align2::RIGHT_CENTER, &self.shown(), size, color);
        let rest = within.with_max_x(within.right() - taken - space::TIGHT);
        if !self.inside.is_empty() {
            write(painter, rest, Align2::LEFT_CENTER, self.inside, size, knob_ui.beside());
        } else if let Some(note) = self.measure.note(self.value).filter(|_| !self.row.differs) {
            let small = type_size::SMALL * knob_ui.zoom;
            write(painter, rest, Align2::LEFT_CENTER, &note, small, knob_ui.beside());
        }
    }

    /// Filled part, 0 to 1; it begins at zero where values can be negative.
    fn filled(&self) -> [f32; 2] {
        let [low, high] = self.ends;
        let share = |number: f64| {
            let share = (number - low) / (high - low);
            if share.is_finite() {
                share.clamp(0.0, 1.0) as f32
            } else {
                0.0
            }
        };
        [
            if low < 0.0 && high > 0.0 { share(0.0) } else { 0.0 },
            share(self.value),
        ]
    }
}

/// Number as a graph file stores it. The error is a sentence.
fn kept(number: f64) -> Result<f64, String> {
    let kept = sabi_graph::canonical_number(number);
    kept.ok_or_else(|| format!("{number:e} is larger than a graph file can hold."))
}
