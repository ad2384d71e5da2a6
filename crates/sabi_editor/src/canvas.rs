//! The canvas: it draws a copy of the shown graph and answers with actions. Its state is that of the view: pan and zoom, the
//! current drag, and open menus. This module alone names the canvas crate, of which it takes the graph types and the node
//! widget; zoom, wires, selection and menus are its own.

mod add_menu;
mod body;
mod card;
mod dragged_node;
mod focus;
mod frame_rects;
mod frames;
mod gesture;
mod mini_map;
mod node_summary;
mod nodes;
mod port_menu;
mod port_refs;
mod ports;
mod questions;
mod reroute;
mod sensing;
mod sides;
mod snapshot;
mod tips;
mod view;
mod wires;

use std::collections::BTreeMap;
use std::sync::Arc;

use egui::{Pos2, Rect, Sense, Ui, pos2, vec2};
use sabi_editing::{OpenDocument, navigation, node_paths, node_size};
use sabi_graph::{NodeId, NodeRef};

use crate::action::Action;
use crate::bars;
use crate::command::{CanvasCommand, InputPreset};
use crate::context::ViewContext;
use crate::search::Candidate;
use crate::theme::Theme;
use add_menu::{AddMenu, Outcome, Purpose};
use gesture::Gesture;
use node_summary::NodeState;
use questions::{MergeQuestion, Renaming};
use snapshot::Snapshot;
use view::View;
use wires::Wire;

/// Zoom below which nodes are drawn as cards with a picture and a name, and wires are dragged from their sides.
const CARD_ZOOM: f32 = 0.5;
/// Distance between lines of the grid, canvas points.
const GRID_STEP: f32 = 40.0;

/// View of the graph: what part is shown, what is dragged, and which menu is open.
#[derive(Default)]
pub(crate) struct Canvas {
    view: View,
    /// Views of other groups, by the path to them.
    views: BTreeMap<Vec<NodeId>, View>,
    path: Vec<NodeId>,
    snapshot: Snapshot,
    /// Current drag.
    gesture: Gesture,
    menu: Option<AddMenu>,
    merge: Option<MergeQuestion>,
    renaming: Option<Renaming>,
    /// Port that has the keyboard.
    port: Option<focus::FocusedPort>,
    /// The same port by its name.
    focused: Option<port_refs::PortRef>,
    /// Nodes in the order of their last click or drag: later ones are drawn above.
    touched: Vec<NodeId>,
    /// Whether a drag from another panel has been away from the edges, and so may scroll the canvas.
    is_brought: bool,
    /// Rectangle of the panel in the last frame.
    panel: Option<Rect>,
    /// Whether all nodes were zoomed to once.
    was_framed: bool,
}

/// What the canvas is drawn from.
struct CanvasContext<'a> {
    pub(crate) document: &'a OpenDocument,
    pub(crate) theme: &'a Arc<Theme>,
    /// State of a node's result.
    pub(crate) state_of: &'a dyn Fn(&NodeId) -> NodeState,
    /// Nodes and groups that can be added.
    pub(crate) candidates: &'a [Candidate],
    /// Node that the 2D view shows.
    pub(crate) previewed: Option<&'a NodeId>,
    /// Preset that gives drags their meaning.
    pub(crate) habit: InputPreset,
    /// Node that the 2D view keeps.
    pub(crate) pinned: Option<&'a NodeId>,
    /// Whether the mini map is shown.
    pub(crate) has_map: bool,
}

impl crate::context::View for Canvas {
    fn show(&mut self, ui: &mut Ui, context: &ViewContext<'_>) -> Vec<Action> {
        let mut actions = bars::path(ui, context);
        let ViewContext {
            document,
            evaluation,
            looks,
            settings,
            ..
        } = *context;
        let state_of = |id: &NodeId| {
            let result = looks.chosen(document, id);
            NodeState {
                picture: context.result_picture(&result),
                time: evaluation.time(&result.node),
                fault: evaluation.fault(&result.node).cloned(),
                waits: evaluation.waits(&result.node).cloned(),
            }
        };
        let here = |result: &NodeRef| node_paths::in_shown_graph(document, &result.node);
        let previewed = looks.inspected().and_then(here);
        let pinned = looks.pinned.as_ref().and_then(here);
        let around = CanvasContext {
            document,
            theme: context.theme,
            state_of: &state_of,
            candidates: context.candidates,
            previewed: previewed.as_ref(),
            habit: settings.habit,
            pinned: pinned.as_ref(),
            has_map: settings.has_mini_map,
        };
        actions.extend(self.draw(ui, &around));
        actions
    }
}

impl Canvas {
    /// Draws the graph and gives what is asked for.
    fn draw(&mut self, ui: &mut Ui, around: &CanvasContext<'_>) -> Vec<Action> {
        let panel = ui.available_rect_before_wrap();
        if !panel.is_positive() {
            return Vec::new();
        }
        ui.set_clip_rect(panel.intersect(ui.clip_rect()));
        ui.advance_cursor_after_rect(panel);
        let background = ui.interact(panel, focus_id(), Sense::click_and_drag());
        background.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Other, true, "Canvas"));
        self.panel = Some(panel);
        self.is_brought &= ui.input(|input| input.pointer.any_down());
        self.follow_path(around.document);
        if !self.was_framed {
            self.frame_all(around.document);
        }
        self.follow_selection(around.document);
        self.snapshot.sync(around.document);
        self.zoom_and_pan(ui, panel);
        draw_grid(ui, panel, &self.view, around.theme);
        let mut actions = Vec::new();
        frames::show(self, ui, panel, around, &mut actions);
        let wires = wires::visible(around.document, &self.view, panel);
        self.draw_wires(ui, around, &wires);
        nodes::show(self, ui, panel, around, &mut actions);
        gesture::advance(self, ui, &background, around, &wires, &mut actions);
        gesture::draw(self, ui, panel, around);
        if around.has_map {
            mini_map::show(self, ui, panel, around);
        }
        self.show_questions(ui, around, &mut actions);
        actions
    }

    /// Performs a command about the view of the graph.
    pub(crate) fn command(&mut self, command: CanvasCommand, ui: &Ui, document: &OpenDocument) -> Vec<Action> {
        match command {
            CanvasCommand::AddMenu => self.open_menu(ui, None),
            CanvasCommand::ShowAll => self.frame_all(document),
            CanvasCommand::ShowSelected => self.frame_nodes(document, document.selection().iter()),
            CanvasCommand::Rename => {
                self.renaming = document
                    .selected_one()
                    .map(|id| Renaming::node(id.clone(), document.title(id)));
            }
            CanvasCommand::NextPort => self.step_port(document, true),
            CanvasCommand::PreviousPort => self.step_port(document, false),
            CanvasCommand::Wire => return self.wire_by_key(document),
        }
        Vec::new()
    }

    /// Place for a new node: under the pointer, or in the middle of the panel.
    pub(crate) fn place_for_new(&self, ui: &Ui) -> [f32; 2] {
        let panel = self.panel.unwrap_or(Rect::from_min_size(Pos2::ZERO, vec2(1.0, 1.0)));
        self.view.place(panel, self.screen_for_new(ui))
    }

    /// Middle of the part of the canvas that is shown.
    pub(crate) fn middle(&self) -> [f32; 2] {
        self.panel
            .map_or([0.0; 2], |panel| self.view.place(panel, panel.center()))
    }

    /// Place on the canvas at a place of the screen; none beside the panel.
    pub(crate) fn place_at(&self, at: Pos2) -> Option<[f32; 2]> {
        let panel = self.panel.filter(|panel| panel.contains(at))?;
        Some(self.view.place(panel, at))
    }

    fn screen_for_new(&self, ui: &Ui) -> Pos2 {
        let panel = self.panel.unwrap_or(Rect::from_min_size(Pos2::ZERO, vec2(1.0, 1.0)));
        let pointer = ui.input(|input| input.pointer.hover_pos());
        pointer.filter(|at| panel.contains(*at)).unwrap_or(panel.center())
    }

    /// Opens the menu of nodes, to add one or to replace the node `instead`.
    pub(crate) fn open_menu(&mut self, ui: &Ui, instead: Option<NodeId>) {
        let purpose = Purpose {
            place: self.place_for_new(ui),
            instead,
            ..Purpose::default()
        };
        self.menu = Some(AddMenu::new(self.screen_for_new(ui), purpose));
    }

    /// Whether a menu or a text field of the canvas has the keyboard.
    pub(crate) fn holds_keys(&self) -> bool {
        self.menu.is_some() || self.renaming.is_some() || self.merge.is_some()
    }

    /// Cancels what is being dragged and takes the keyboard from a port; gives whether there was either.
    pub(crate) fn cancel_drag(&mut self) -> bool {
        let held = self.is_busy();
        self.gesture = Gesture::Idle;
        self.leave_port();
        held
    }

    /// Cancels what is being dragged, and closes menus and text fields.
    pub(crate) fn cancel_all(&mut self) {
        self.gesture = Gesture::Idle;
        self.menu = None;
        self.renaming = None;
        self.merge = None;
    }

    /// Whether something is being dragged, or a port has the keyboard.
    pub(crate) fn is_busy(&self) -> bool {
        !matches!(self.gesture, Gesture::Idle) || self.port.is_some()
    }

    /// Whether nodes are being dragged.
    pub(crate) fn is_moving_nodes(&self) -> bool {
        matches!(self.gesture, Gesture::Move { .. })
    }

    fn follow_path(&mut self, document: &OpenDocument) {
        let path: Vec<NodeId> = navigation::breadcrumb(document).into_iter().map(|(id, _)| id).collect();
        if path == self.path {
            return;
        }
        let left = std::mem::replace(&mut self.path, path);
        self.views.insert(left, self.view);
        match self.views.get(&self.path) {
            Some(view) => self.view = *view,
            None => self.was_framed = false,
        }
        self.gesture = Gesture::Idle;
        self.leave_port();
    }

    /// Zooms to all nodes.
    pub(crate) fn frame_all(&mut self, document: &OpenDocument) {
        self.frame_nodes(document, document.graph().ids());
        self.was_framed = true;
    }

    /// Zooms to these nodes.
    pub(crate) fn frame_nodes<'i>(&mut self, document: &OpenDocument, ids: impl Iterator<Item = &'i NodeId>) {
        let rects = ids.filter_map(|id| node_rect(document, id));
        let all = rects.fold(Rect::NOTHING, |all, rect| all.union(rect));
        if let Some(panel) = self.panel {
            self.view.frame(panel, all);
        }
    }

    /// Nodes in the panel, those near its middle first.
    pub(crate) fn visible(&self, document: &OpenDocument) -> Vec<NodeId> {
        let Some(panel) = self.panel else {
            return Vec::new();
        };
        let seen = self.view.seen(panel);
        let rects = document
            .graph()
            .ids()
            .filter_map(|id| Some((node_rect(document, id)?, id)));
        let mut visible: Vec<(f32, &NodeId)> = rects
            .filter(|(rect, _)| rect.intersects(seen))
            .map(|(rect, id)| (rect.center().distance(seen.center()), id))
            .collect();
        visible.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        visible.into_iter().map(|(_, id)| id.clone()).collect()
    }

    fn zoom_and_pan(&mut self, ui: &Ui, panel: Rect) {
        let Some(pointer) = ui
            .input(|input| input.pointer.hover_pos())
            .filter(|at| panel.contains(*at))
        else {
            return;
        };
        let is_on_top = ui.ctx().layer_id_at(pointer).is_none_or(|layer| layer == ui.layer_id());
        if !is_on_top {
            return;
        }
        let (scroll, pinch, modifiers) =
            ui.input(|input| (input.smooth_scroll_delta(), input.zoom_delta(), input.modifiers));
        if pinch != 1.0 {
            self.view.zoom_at(panel, pointer, pinch);
        } else if modifiers.shift {
            self.view.pan += scroll;
        } else if scroll != egui::Vec2::ZERO {
            self.view.pan.x += scroll.x;
            self.view.zoom_at(panel, pointer, (scroll.y * 0.0025).exp());
        }
    }

    fn draw_wires(&self, ui: &Ui, around: &CanvasContext<'_>, wires: &[Wire]) {
        let pointer = ui.input(|input| input.pointer.hover_pos());
        let hot = self.gesture.hot_wire(self, around.document, wires, pointer);
        for wire in wires {
            let look = if self.gesture.cuts(wire) {
                wires::Look::Cut
            } else if hot == Some(&wire.to) {
                wires::Look::Hot
            } else if around.document.is_selected(&wire.to.node) || around.document.is_selected(&wire.from.node) {
                wires::Look::Near
            } else {
                wires::Look::Usual
            };
            wires::draw(ui.painter(), around.theme, wire, self.view.zoom, look);
        }
    }

    fn show_questions(&mut self, ui: &mut Ui, around: &CanvasContext<'_>, actions: &mut Vec<Action>) {
        if let Some(menu) = &mut self.menu {
            match menu.show(ui, around.document, around.theme, around.candidates) {
                Outcome::Open => {}
                Outcome::Closed => self.menu = None,
                Outcome::Chosen(action) => {
                    self.menu = None;
                    actions.push(action);
                }
            }
        }
        questions::merge(&mut self.merge, ui, actions);
        questions::rename(self, ui, around, actions);
    }
}

/// Id that has the keyboard focus while keys act on the canvas.
pub(crate) fn focus_id() -> egui::Id {
    egui::Id::new("keys are for the canvas")
}

/// Rectangle of a node on the canvas.
fn node_rect(document: &OpenDocument, id: &NodeId) -> Option<Rect> {
    let pos = document.node(id)?.pos;
    Some(Rect::from_min_size(
        pos2(pos[0], pos[1]),
        node_size::of(document, id).into(),
    ))
}

fn draw_grid(ui: &Ui, panel: Rect, view: &View, theme: &Theme) {
    ui.painter().rect_filled(panel, 0.0, theme.canvas);
    let step = GRID_STEP * view.zoom;
    // Lines this close look like a gray area and take long to draw.
    if step < 14.0 {
        return;
    }
    let first = |origin: f32, low: f32| low + (origin - low).rem_euclid(step);
    let origin = view.screen(panel, [0.0, 0.0]);
    let stroke = egui::Stroke::new(1.0, theme.grid);
    let mut x = first(origin.x, panel.left());
    while x < panel.right() {
        ui.painter().vline(x, panel.y_range(), stroke);
        x += step;
    }
    let mut y = first(origin.y, panel.top());
    while y < panel.bottom() {
        ui.painter().hline(panel.x_range(), y, stroke);
        y += step;
    }
}
