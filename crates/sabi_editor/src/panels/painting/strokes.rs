//! The strokes of a paint node on the shown model.

mod order;
mod tools;

use std::collections::BTreeSet;
use std::sync::Arc;

use egui::{Button, Image, Key, Rect, Response, ScrollArea, Sense, TextEdit, Ui, vec2};
use egui_phosphor::regular as icon;
use sabi_editing::command::PaintCommand;
use sabi_editing::painting::{strokes_of, strokes_on};
use sabi_graph::NodeId;
use sabi_paint::{Action as BrushAction, Area, Brush, Step, Stroke, StrokeGroup, StrokeList, Version};

use order::{StrokeRow, rows_of};
use tools::{StrokeTools, tool};

use super::swatches::{SWATCH, Swatches};
use crate::action::{Action, PaintAction};
use crate::context::ViewContext;
use crate::panels::reordering;

/// Height of a row, points.
const ROW: f32 = 24.0;
/// Space before the strokes of a group, points.
const INDENT: f32 = 14.0;

/// Rows of strokes, and the one whose name is typed.
#[derive(Default)]
pub(super) struct StrokeRows {
    /// Row that a range is marked from.
    anchor: Option<usize>,
    renamed: Option<(NameSubject, String)>,
    /// Numbers of the groups whose strokes are not shown.
    closed: BTreeSet<u32>,
    tools: StrokeTools,
}

/// Strokes that are dragged to another place in the list, with their title.
struct DraggedStrokes(BTreeSet<Version>, String);

/// Subject of a name that is typed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum NameSubject {
    Stroke(Version),
    Group(u32),
}

/// State of the field for a name.
enum NameFieldState {
    /// The field is not shown.
    Nothing,
    Still,
    /// Another name was typed.
    Name(String),
}

/// Request of a row or a tool.
enum StrokeListRequest {
    /// Change the list by these steps, with their name in the history.
    Steps(&'static str, Vec<Step>),
    /// Mark these strokes.
    Mark(BTreeSet<Version>),
}

impl StrokeRows {
    /// Shows the strokes on the shown model, the topmost first.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        context: &ViewContext<'_>,
        swatches: &mut Swatches,
        id: &NodeId,
    ) -> Vec<Action> {
        let Some(model) = &context.evaluation.model.received else {
            return Vec::new();
        };
        let linked = &model.linked;
        let name = &linked.model.stem;
        let mut actions = Vec::new();
        let list = strokes_on(context.document, id, name).unwrap_or_default(); // Nothing is painted there.
        if list.strokes.is_empty() {
            ui.weak(format!("Nothing is painted on {name} yet."));
        }
        let done = self.tools.show(ui, context, &list, linked.largest_side, &mut actions);
        let asked = done.or(self.rows(ui, context, swatches, &list));
        actions.extend(asked.map(|asked| {
            Action::Paint(match asked {
                StrokeListRequest::Mark(strokes) => PaintAction::Mark(strokes),
                StrokeListRequest::Steps(title, steps) => PaintAction::Change(PaintCommand::Steps {
                    node: id.clone(),
                    model: name.clone(),
                    before: strokes_of(context.document, id).unwrap_or_default(), // It has a list.
                    title: title.to_owned(),
                    steps,
                }),
            })
        }));
        actions
    }

    fn rows(
        &mut self,
        ui: &mut Ui,
        context: &ViewContext<'_>,
        swatches: &mut Swatches,
        list: &StrokeList,
    ) -> Option<StrokeListRequest> {
        let rows = rows_of(list, &self.closed);
        let mut asked = None;
        let mut places: Vec<Rect> = Vec::new();
        let mut first = 0;
        let area = ScrollArea::vertical().id_salt("strokes");
        area.show_rows(ui, ROW, rows.len(), |ui, shown| {
            first = shown.start;
            for row in &rows[shown] {
                let row = ui.horizontal(|ui| match row {
                    StrokeRow::Group { group, top, .. } => {
                        ui.push_id(("group", group.number, *top), |ui| self.group(ui, context, list, group))
                            .inner
                    }
                    StrokeRow::Stroke(index) => {
                        let id = list.strokes[*index].id;
                        ui.push_id(id.0, |ui| self.row(ui, context, swatches, list, *index))
                            .inner
                    }
                });
                places.push(row.response.rect);
                asked = asked.take().or(row.inner);
            }
        });
        let title = |dragged: &DraggedStrokes| Some(dragged.1.clone());
        if let Some((dragged, gap)) = reordering::dropped(ui, context.theme, &places, title) {
            let steps = order::moved(list, &dragged.0, order::below_gap(&rows, first + gap));
            if !steps.is_empty() {
                asked = Some(StrokeListRequest::Steps("Order of strokes", steps));
            }
        }
        asked
    }

    /// Title of a group.
    fn group(
        &mut self,
        ui: &mut Ui,
        context: &ViewContext<'_>,
        list: &StrokeList,
        group: &Arc<StrokeGroup>,
    ) -> Option<StrokeListRequest> {
        let is_closed = self.closed.contains(&group.number);
        let (caret, name) = match is_closed {
            true => (icon::CARET_RIGHT, "Open the group"),
            false => (icon::CARET_DOWN, "Close the group"),
        };
        if tool(ui, caret, name) && !self.closed.remove(&group.number) {
            self.closed.insert(group.number);
        }
        if let Some(is_hidden) = eye(ui, group.is_hidden, "the group") {
            let group = StrokeGroup {
                is_hidden,
                ..(**group).clone()
            };
            return Some(StrokeListRequest::Steps(
                "Visibility of a group",
                vec![order::changed(list, group)],
            ));
        }
        let typed = self.typed_name(ui, NameSubject::Group(group.number), &group.name);
        match typed {
            NameFieldState::Nothing => {}
            NameFieldState::Still => return None,
            NameFieldState::Name(name) => {
                let group = StrokeGroup {
                    name,
                    ..(**group).clone()
                };
                return Some(StrokeListRequest::Steps(
                    "Name of a group",
                    vec![order::changed(list, group)],
                ));
            }
        }
        let members = order::members(list, group.number);
        let title = format!("{}  ({})", group.name, members.len());
        let is_marked = members.is_subset(&context.looks.marked_strokes);
        let label = named_row(ui, is_marked, &title);
        label.dnd_set_drag_payload(DraggedStrokes(members.clone(), title));
        if label.double_clicked() {
            self.renamed = Some((NameSubject::Group(group.number), group.name.clone()));
        }
        label.clicked().then_some(StrokeListRequest::Mark(members))
    }

    /// Row of a stroke.
    fn row(
        &mut self,
        ui: &mut Ui,
        context: &ViewContext<'_>,
        swatches: &mut Swatches,
        list: &StrokeList,
        index: usize,
    ) -> Option<StrokeListRequest> {
        let stroke = &list.strokes[index];
        if stroke.group.is_some() {
            ui.add_space(INDENT);
        }
        let changed = |name: String, is_hidden: bool| Step::Change {
            stroke: stroke.id,
            name,
            brush: Box::new(stroke.brush.clone()),
            is_hidden,
        };
        if let Some(is_hidden) = eye(ui, stroke.is_hidden, "the stroke") {
            let step = changed(stroke.name.clone(), is_hidden);
            return Some(StrokeListRequest::Steps("Visibility of a stroke", vec![step]));
        }
        let size = vec2(0.6 * SWATCH[0] as f32, 0.6 * SWATCH[1] as f32);
        match swatches.of(ui, context, &shown_brush(stroke)) {
            Some(texture) => ui.add(Image::new((texture, size))),
            None => ui.allocate_response(size, Sense::hover()),
        };
        match self.typed_name(ui, NameSubject::Stroke(stroke.id), &stroke.name) {
            NameFieldState::Nothing => {}
            NameFieldState::Still => return None,
            NameFieldState::Name(name) => {
                let step = changed(name, stroke.is_hidden);
                return Some(StrokeListRequest::Steps("Name of a stroke", vec![step]));
            }
        }
        let title = title_of(stroke, index);
        let marked = &context.looks.marked_strokes;
        let label = named_row(ui, marked.contains(&stroke.id), &title);
        let dragged = if marked.contains(&stroke.id) {
            marked.clone()
        } else {
            BTreeSet::from([stroke.id])
        };
        label.dnd_set_drag_payload(DraggedStrokes(dragged, title));
        if label.double_clicked() {
            self.renamed = Some((NameSubject::Stroke(stroke.id), stroke.name.clone()));
        } else if label.clicked() {
            return Some(StrokeListRequest::Mark(self.mark(ui, marked, list, index)));
        }
        None
    }

    /// The field for a name, while it is typed.
    fn typed_name(&mut self, ui: &mut Ui, named: NameSubject, before: &str) -> NameFieldState {
        let Some((_, text)) = self.renamed.as_mut().filter(|(other, _)| *other == named) else {
            return NameFieldState::Nothing;
        };
        let field = ui.add(TextEdit::singleline(text).hint_text("Name").desired_width(120.0));
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            self.renamed = None;
            return NameFieldState::Still;
        }
        if !field.lost_focus() {
            field.request_focus();
            return NameFieldState::Still;
        }
        let name = self.renamed.take().map(|(_, name)| name.trim().to_owned());
        match name.filter(|name| name != before) {
            Some(name) => NameFieldState::Name(name),
            None => NameFieldState::Still,
        }
    }

    /// The marked strokes after a click on a row: only this one; with Ctrl, this one in addition; with Shift, all from
    /// the row that was clicked before.
    fn mark(&mut self, ui: &Ui, known: &BTreeSet<Version>, list: &StrokeList, index: usize) -> BTreeSet<Version> {
        let modifiers = ui.input(|input| input.modifiers);
        let id = list.strokes[index].id;
        let mut marked = known.clone();
        if let Some(anchor) = self
            .anchor
            .filter(|anchor| modifiers.shift && *anchor < list.strokes.len())
        {
            let range = anchor.min(index)..=anchor.max(index);
            marked.extend(list.strokes[range].iter().map(|stroke| stroke.id));
            return marked;
        }
        self.anchor = Some(index);
        if !modifiers.command {
            return BTreeSet::from([id]);
        }
        if !marked.remove(&id) {
            marked.insert(id);
        }
        marked
    }
}

/// The name of a row, which marks it and is dragged; a long one is cut off.
fn named_row(ui: &mut Ui, is_marked: bool, title: &str) -> Response {
    let label = ui.add(Button::selectable(is_marked, title).truncate());
    label.interact(Sense::click_and_drag())
}

/// Brush that the picture of a stroke is drawn with: a decal is drawn upright, and once.
fn shown_brush(stroke: &Stroke) -> Brush {
    let brush = stroke.brush.clone();
    if !stroke.area.is_single() {
        return brush;
    }
    Brush {
        angle_degrees: 0.0,
        spacing: 4.0,
        ..brush
    }
}

/// A button that shows or hides; returns whether its subject is to be hidden from now on.
fn eye(ui: &mut Ui, is_hidden: bool, subject: &str) -> Option<bool> {
    let (sign, verb) = match is_hidden {
        true => (icon::EYE_SLASH, "Show"),
        false => (icon::EYE, "Hide"),
    };
    tool(ui, sign, &format!("{verb} {subject}")).then_some(!is_hidden)
}

/// Number of strokes of a paint node on the shown model.
pub(super) fn count(context: &ViewContext<'_>, id: &NodeId) -> usize {
    let model = context.evaluation.model.received.as_ref();
    let list = model.and_then(|model| strokes_on(context.document, id, &model.linked.model.stem));
    list.map_or(0, |list| list.strokes.len())
}

/// Name of a stroke in the list.
fn title_of(stroke: &Stroke, index: usize) -> String {
    if !stroke.name.is_empty() {
        return stroke.name.clone();
    }
    let what = match (stroke.action, stroke.area) {
        (BrushAction::Paint, Area::Way) => "Stroke",
        (BrushAction::Paint, Area::Decal) => "Decal",
        (BrushAction::Paint, Area::Label) => "Label",
        (BrushAction::Paint, Area::Ribbon) => "Ribbon",
        (BrushAction::Paint, Area::Inside) => "Inside",
        (BrushAction::Paint, Area::Gradient) => "Gradient",
        (BrushAction::Paint, _) => "Fill",
        (BrushAction::Erase, _) => "Eraser",
        (BrushAction::Smear, _) => "Smear",
        (BrushAction::Blur, _) => "Blur",
        (BrushAction::Sharpen, _) => "Sharpening",
        (BrushAction::Clone, _) if stroke.copies_input() => "Copy of a node",
        (BrushAction::Clone, _) => "Clone",
    };
    format!("{what} {}", index + 1)
}
