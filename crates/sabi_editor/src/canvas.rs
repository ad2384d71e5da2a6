//! The canvas: it draws a copy of the shown graph and answers with actions. Its state is that of the view: camera,
//! current drag, open menus and keyboard focus. Only this module names the canvas crate, and it uses only the graph
//! types and the node widget of that crate; zoom, wires, selection and menus are its own.

mod add_menu;
mod body;
mod camera;
mod card;
mod dragged_node;
mod focus;
mod frame_rects;
mod frames;
mod gesture;
mod keyboard;
mod mini_map;
mod node_summary;
mod nodes;
mod notes;
mod popups;
mod port_menu;
mod port_question;
mod port_refs;
mod ports;
mod questions;
mod reroute;
mod sensing;
mod sides;
mod snapshot;
mod tooltips;
mod view;
mod wire_names;
mod wires;

use std::sync::Arc;

use egui::{Align2, FontId, Pos2, Rect, Sense, Ui, pos2};
use sabi_editing::connections::PendingWire;
use sabi_editing::{OpenDocument, node_paths, node_size};
use sabi_engine::catalog::Interface;
use sabi_graph::{NodeId, NodeRef, OutputRef, SlotRef};

use crate::action::{Action, ArrowKey};
use crate::bars;
use crate::command::{CanvasCommand, Command, InputPreset};
use crate::context::ViewContext;
use crate::files::new_graph::is_untouched;
use crate::key_map::KeyMap;
use crate::search::Candidate;
use crate::theme::{Theme, type_size};
use add_menu::{AddMenu, Purpose};
use camera::CanvasCamera;
use dragged_node::EdgeScroll;
use focus::PortFocus;
use gesture::Gesture;
use node_summary::NodeState;
use notes::{DraggedNote, NoteText};
use popups::Popups;
use port_refs::PortRef;
use questions::ItemRename;
use snapshot::GraphSnapshot;
use view::CanvasView;

/// Zoom below which nodes are drawn as cards with a picture and a name, and wires are dragged from their sides.
const CARD_ZOOM: f32 = 0.5;
/// Distance between lines of the grid, canvas points.
const GRID_STEP: f32 = 40.0;

/// View of the graph.
#[derive(Default)]
pub(crate) struct Canvas {
    /// Shown part of the graph.
    pub(crate) camera: CanvasCamera,
    snapshot: GraphSnapshot,
    /// Current drag.
    gesture: Gesture,
    popups: Popups,
    focus: PortFocus,
    /// Nodes in the order of their last click or drag: later ones are drawn above.
    draw_order: Vec<NodeId>,
    /// Scrolling during the drag of a node from another panel.
    edge_scroll: EdgeScroll,
    dragged_note: Option<DraggedNote>,
}

/// Data from which the canvas is drawn.
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
    pub(crate) preset: InputPreset,
    /// Node that the 2D view keeps.
    pub(crate) pinned: Option<&'a NodeId>,
    /// True if the mini map is shown.
    pub(crate) has_map: bool,
    /// Hint for a graph in which nothing was done yet.
    pub(crate) hint: Option<[String; 2]>,
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
                time: evaluation.results.time(&result.node),
                fault: evaluation.faults.of(&result.node).map(|fault| context.said(fault)),
                waits: evaluation.faults.waits(&result.node).map(|waits| context.said(waits)),
            }
        };
        let shown = |result: &NodeRef| node_paths::in_shown_graph(document, &result.node);
        let previewed = looks.inspected().and_then(shown);
        let pinned = looks.pinned_2d.as_ref().and_then(shown);
        let canvas_context = CanvasContext {
            document,
            theme: context.theme,
            state_of: &state_of,
            candidates: context.candidates,
            previewed: previewed.as_ref(),
            preset: settings.input_preset,
            pinned: pinned.as_ref(),
            has_map: settings.has_mini_map,
            hint: is_untouched(document.graph()).then(|| hint(context.keys)),
        };
        actions.extend(self.draw(ui, &canvas_context));
        actions
    }
}

impl Canvas {
    /// Draws the graph and returns the requested actions.
    fn draw(&mut self, ui: &mut Ui, context: &CanvasContext<'_>) -> Vec<Action> {
        let panel = ui.available_rect_before_wrap();
        if !panel.is_positive() {
            return Vec::new();
        }
        ui.set_clip_rect(panel.intersect(ui.clip_rect()));
        ui.advance_cursor_after_rect(panel);
        let background = ui.interact(panel, focus_id(), Sense::click_and_drag());
        background.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Other, true, "Canvas"));
        self.edge_scroll.begin_frame(ui);
        if self.camera.begin_frame(context.document, panel) {
            self.gesture = Gesture::Idle;
            self.focus.clear();
        }
        self.focus.follow_selection(context.document);
        self.snapshot.sync(context.document);
        self.camera.zoom_and_pan(ui, panel);
        draw_grid(ui, panel, &self.camera.view, context.theme);
        if let Some(hint) = &context.hint {
            draw_hint(ui, panel, hint, context.theme);
        }
        let mut actions = Vec::new();
        frames::show(self, ui, panel, context, &mut actions);
        notes::show(self, ui, panel, context, &mut actions);
        let wires = wires::visible(context.document, &self.camera.view, panel);
        wires::show(self, ui, context, &wires);
        wire_names::show(self, ui, panel, context, &mut actions);
        nodes::show(self, ui, panel, context, &mut actions);
        gesture::advance(self, ui, &background, context, &wires, &mut actions);
        gesture::draw(self, ui, panel, context);
        if context.has_map {
            mini_map::show(self, ui, panel, context);
        }
        self.popups.show(ui, &self.camera, context, &mut actions);
        if let Some(chosen) = port_question::show(&mut self.popups.ports, ui, context.document) {
            let (wire, port) = (PendingWire::From(chosen.from), PortRef::Input(chosen.to));
            gesture::connect(
                &mut self.popups,
                context.document,
                wire,
                chosen.off,
                &port,
                chosen.at,
                &mut actions,
            );
        }
        actions
    }

    /// Performs a command about the view of the graph.
    pub(crate) fn command(&mut self, command: CanvasCommand, ui: &Ui, document: &OpenDocument) -> Vec<Action> {
        match command {
            CanvasCommand::AddMenu => {
                let into = self.wire_under_pointer(ui, document);
                let selected = into.is_none().then(|| selected_output(document)).flatten();
                self.open_menu(ui, None, selected, into);
            }
            CanvasCommand::ShowAll => self.camera.frame_all(document),
            CanvasCommand::ShowSelected => self.camera.frame_nodes(document, document.selection().iter()),
            CanvasCommand::Rename => {
                self.popups.renaming = document
                    .selected_one()
                    .map(|id| ItemRename::node(id.clone(), document.title(id)));
            }
            CanvasCommand::AddNote => self.popups.note = Some(NoteText::of_new(self.camera.place_for_new(ui))),
            CanvasCommand::NextPort => self.focus.step(document, &self.gesture, true),
            CanvasCommand::PreviousPort => self.focus.step(document, &self.gesture, false),
            CanvasCommand::Wire => return keyboard::wire(self, document),
        }
        Vec::new()
    }

    /// Follows an arrow key.
    pub(crate) fn arrow(&mut self, document: &OpenDocument, key: ArrowKey) -> Vec<Action> {
        keyboard::arrow(self, document, key)
    }

    /// Draws a node that is dragged from another panel where it would be dropped, and scrolls at the edges of the canvas.
    pub(crate) fn drag_new(
        &mut self,
        ui: &Ui,
        theme: &Theme,
        document: &OpenDocument,
        interface: &Interface,
        at: Pos2,
    ) {
        dragged_node::draw(self, ui, theme, document, interface, at);
        self.edge_scroll.scroll(&mut self.camera, ui, at);
    }

    /// Node at a place of the screen on whose material a node dropped there is added as a layer.
    pub(crate) fn node_for_dropped(&self, document: &OpenDocument, interface: &Interface, at: Pos2) -> Option<NodeId> {
        dragged_node::node_at(self, document, interface, at)
    }

    /// Place for a node that is dropped at a place of the screen, and the input whose wire it is inserted into; `None`
    /// outside of the canvas.
    pub(crate) fn place_for_dropped(
        &self,
        document: &OpenDocument,
        interface: &Interface,
        at: Pos2,
    ) -> Option<([f32; 2], Option<SlotRef>)> {
        let wire = dragged_node::wire_at(&self.camera, document, interface, at);
        Some((self.camera.place_at(at)?, wire.map(|wire| wire.to)))
    }

    /// Input of the wire that is highlighted under the pointer.
    fn wire_under_pointer(&self, ui: &Ui, document: &OpenDocument) -> Option<SlotRef> {
        let panel = self.camera.panel?;
        let pointer = ui
            .input(|input| input.pointer.hover_pos())
            .filter(|at| panel.contains(*at))?;
        let wires = wires::visible(document, &self.camera.view, panel);
        wires::under(&wires, pointer).map(|wire| wire.to.clone())
    }

    /// Opens the menu of nodes, to add one that the output `selected` can be connected to or that is inserted into the
    /// wire of the input `into`, or to replace the node `instead`.
    fn open_menu(&mut self, ui: &Ui, instead: Option<NodeId>, selected: Option<OutputRef>, into: Option<SlotRef>) {
        let purpose = Purpose {
            place: self.camera.place_for_new(ui),
            instead,
            selected,
            into,
            ..Purpose::default()
        };
        self.popups.menu = Some(AddMenu::new(self.camera.screen_for_new(ui), purpose));
    }

    /// Opens the menu of nodes, to add one whose mask multiplies a parameter.
    pub(crate) fn ask_for_mask(&mut self, ui: &Ui, document: &OpenDocument, slot: SlotRef) {
        let at = self.camera.screen_for_new(ui);
        port_menu::open_node_menu(&mut self.popups, document, &PortRef::Input(slot), at);
    }

    /// Returns whether a menu or a text field of the canvas has the keyboard focus.
    pub(crate) fn holds_keys(&self) -> bool {
        self.popups.is_open()
    }

    /// Cancels the current drag and takes the focus from a port. Returns whether there was either.
    pub(crate) fn cancel_drag(&mut self) -> bool {
        let was_busy = self.is_busy();
        self.gesture = Gesture::Idle;
        self.focus.clear();
        was_busy
    }

    /// Cancels the current drag, and closes menus and text fields.
    pub(crate) fn cancel_all(&mut self) {
        self.gesture = Gesture::Idle;
        self.popups.close();
    }

    /// Returns whether a drag is in progress or a port has the keyboard focus.
    pub(crate) fn is_busy(&self) -> bool {
        !matches!(self.gesture, Gesture::Idle) || self.focus.is_set()
    }

    /// Returns whether nodes are being dragged.
    pub(crate) fn is_moving_nodes(&self) -> bool {
        matches!(self.gesture, Gesture::Move { .. })
    }

    /// Port that has the keyboard focus, as `node.port`.
    #[cfg(test)]
    pub(crate) fn focused_port(&self) -> Option<String> {
        self.focus.text()
    }
}

/// First output of the selected node, if exactly one node is selected.
fn selected_output(document: &OpenDocument) -> Option<OutputRef> {
    let node = document.selected_one()?;
    let port = document.interface(node)?.outputs.first()?;
    Some(OutputRef {
        node: node.clone(),
        port: Some(port.name.clone()),
    })
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

/// Hint in a graph in which nothing was done yet.
fn hint(keys: &KeyMap) -> [String; 2] {
    let add = keys.shown(Command::Canvas(CanvasCommand::AddMenu));
    [
        "Drag an effect from the Library onto the model.".to_owned(),
        format!("{add} or a right-click adds a node here."),
    ]
}

/// Writes sentences below the middle of the canvas.
fn draw_hint(ui: &Ui, panel: Rect, lines: &[String], theme: &Theme) {
    let mut top = panel.center().y + panel.height() * 0.3;
    for line in lines {
        let font = FontId::proportional(type_size::HEADING);
        let text = ui
            .painter()
            .layout(line.clone(), font, theme.quiet, panel.width() * 0.9);
        let place = Align2::CENTER_TOP.anchor_size(pos2(panel.center().x, top), text.size());
        top = place.bottom();
        ui.painter().galley(place.min, text, theme.quiet);
        let told = ui.interact(place, ui.id().with(("hint", line)), Sense::hover());
        told.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Label, true, line));
    }
}

fn draw_grid(ui: &Ui, panel: Rect, view: &CanvasView, theme: &Theme) {
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
