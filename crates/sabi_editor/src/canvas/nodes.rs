//! The nodes in the panel; those outside of it are not drawn.

use std::collections::BTreeMap;
use std::sync::Arc;

use egui::layers::ShapeIdx;
use egui::{Rect, Response, Shape, Ui, WidgetInfo, WidgetType, vec2};
use egui_node_graph::{GraphNodeWidget, NodeOrientation, PanZoom};
use sabi_editing::OpenDocument;
use sabi_editing::command::{FrameCommand, NavigationCommand, SelectionCommand};
use sabi_editing::node_size::{TITLE_HEIGHT, is_reroute};
use sabi_engine::catalog::Interface;
use sabi_graph::{NodeId, PortType};

use super::gesture::{Gesture, begin_move};
use super::node_summary::RowContext;
use super::sensing::window_id;
use super::snapshot::CanvasNodeId;
use super::{CARD_ZOOM, Canvas, CanvasContext, body, card, node_rect, ports, reroute, sides, tooltips};
use crate::action::Action;
use crate::command::{CanvasCommand, Command, GraphCommand, LookCommand, WindowCommand};
use crate::knobs::KnobEvent;
use crate::model_view::channels::CHANNELS;

/// Index of the background among the first shapes of a node's widget: an outline comes first.
const BACKDROP: usize = 2;

/// Draws the nodes in the panel, and adds the requested actions.
pub(super) fn show(
    canvas: &mut Canvas,
    ui: &mut Ui,
    panel: Rect,
    context: &CanvasContext<'_>,
    actions: &mut Vec<Action>,
) {
    let seen = canvas.camera.view.visible_rect(panel);
    let ids: Vec<NodeId> = in_order(canvas, context, seen);
    let is_card = canvas.camera.view.zoom < CARD_ZOOM;
    let usual = ui.style().clone();
    if !is_card {
        ui.set_style(zoomed(&usual, canvas.camera.view.zoom));
    }
    for id in &ids {
        let Some(key) = canvas.snapshot.key(id) else { continue };
        let shown = &mut canvas.snapshot.graph[key].user_data;
        shown.state = (context.state_of)(id);
        shown.is_previewed = context.previewed == Some(id);
        shown.is_pinned = context.pinned == Some(id);
        let is_reroute = is_reroute(&shown.interface);
        let mut has_knob_menu = false;
        let response = if is_reroute {
            reroute::show(canvas, ui, panel, context, key)
        } else if is_card {
            card::show(canvas, ui, panel, context, key)
        } else {
            let drawn = widget(canvas, ui, panel, context, key, actions);
            has_knob_menu = drawn.as_ref().is_some_and(|drawn| drawn.has_knob_menu);
            drawn.map(|drawn| drawn.response)
        };
        let Some(response) = response else { continue };
        let title = &canvas.snapshot.graph[key].user_data.title;
        let is_selected = context.document.selection().contains(id);
        response.widget_info(|| WidgetInfo::selected(WidgetType::SelectableLabel, true, is_selected, title));
        let shown = &canvas.snapshot.graph[key].user_data;
        let sentence = shown.state.fault.as_ref().or(shown.state.waits.as_ref());
        let pinned = shown.is_pinned.then_some("pinned to the 2D view");
        if let Some(said) = sentence.map(String::as_str).or(pinned) {
            ui.ctx()
                .accesskit_node_builder(response.id, |node| node.set_description(said));
        }
        interact(canvas, id, &response, context, actions);
        if !has_knob_menu {
            context_menu(canvas, ui, id, &response, context, actions);
        }
        let title = response
            .rect
            .with_max_y(response.rect.top() + TITLE_HEIGHT * canvas.camera.view.zoom);
        let tooltip_area = if is_card || is_reroute { response.rect } else { title };
        // While a wire or a node is dragged, a tooltip would cover where it goes.
        if matches!(canvas.gesture, Gesture::Idle) {
            tooltips::show(
                ui,
                context,
                &canvas.snapshot.graph[key].user_data,
                &response,
                tooltip_area,
            );
        }
        if is_card {
            sides::show(canvas, ui, panel, context, id, actions);
        } else {
            ports::show(canvas, ui, panel, context, id, actions);
        }
    }
    ui.set_style(usual);
}

/// Ids of the nodes in the panel in drawing order: recently clicked or dragged nodes last, and selected ones after
/// them.
fn in_order(canvas: &mut Canvas, context: &CanvasContext<'_>, seen: Rect) -> Vec<NodeId> {
    let graph = context.document.graph();
    canvas.draw_order.retain(|id| graph.node(id.as_str()).is_some());
    let is_seen = |id: &&NodeId| node_rect(context.document, id).is_some_and(|rect| rect.intersects(seen));
    let turns: BTreeMap<&NodeId, usize> = canvas.draw_order.iter().zip(1..).collect();
    let mut in_turn: Vec<NodeId> = graph.ids().filter(is_seen).cloned().collect();
    // Nodes that were never clicked have no turn and come first, in the order of the graph.
    in_turn.sort_by_key(|id| (context.document.selection().contains(id), turns.get(id).copied()));
    in_turn
}

/// Node that was drawn.
struct DrawnNode {
    response: Response,
    /// True if the menu of one of its parameters was asked for, in place of its own.
    has_knob_menu: bool,
}

/// Draws one node with the canvas crate's widget.
fn widget(
    canvas: &mut Canvas,
    ui: &mut Ui,
    panel: Rect,
    context: &CanvasContext<'_>,
    key: CanvasNodeId,
    actions: &mut Vec<Action>,
) -> Option<DrawnNode> {
    let zoom = canvas.camera.view.zoom;
    let id = canvas.snapshot.graph[key].user_data.id.clone();
    let place = context.document.node(&id)?.pos;
    let rect = canvas.camera.view.screen_rect(panel, node_rect(context.document, &id)?);
    let mut row_context = RowContext {
        theme: context.theme.clone(),
        zoom,
        knob_events: Vec::new(),
        has_asked_for_menu: false,
    };
    // The widget draws its own background, which is replaced afterwards.
    let before = ui.painter().add(Shape::Noop);
    let pan_zoom = PanZoom {
        pan: canvas.camera.view.pan,
        zoom,
        ..PanZoom::default()
    };
    let widget = GraphNodeWidget {
        position: &mut (vec2(place[0], place[1]) * zoom).to_pos2(),
        orientation: &mut NodeOrientation::LeftToRight,
        graph: &mut canvas.snapshot.graph,
        port_locations: &mut Default::default(),
        node_rects: &mut Default::default(),
        node_id: key,
        ongoing_drag: None,
        selected: false,
        pan: canvas.camera.view.pan + panel.min.to_vec2(),
    };
    // Its response is ignored, since ports and drags are handled here.
    let _ = widget.show(&pan_zoom, ui, &mut row_context);
    let shown = &canvas.snapshot.graph[key].user_data;
    let is_selected = context.document.selection().contains(&id);
    let backdrop = body::backdrop(context.theme, shown, rect, zoom, is_selected);
    ui.painter().set(ShapeIdx(before.0 + BACKDROP), backdrop);
    actions.extend(
        std::mem::take(&mut row_context.knob_events)
            .into_iter()
            .map(|(node, event)| knob(node, event)),
    );
    Some(DrawnNode {
        response: ui.ctx().read_response(window_id(ui, key))?,
        has_knob_menu: row_context.has_asked_for_menu,
    })
}

fn knob(node: NodeId, event: KnobEvent) -> Action {
    Action::Knob { node, event }
}

/// Handles clicks and drags on a node.
fn interact(
    canvas: &mut Canvas,
    id: &NodeId,
    response: &Response,
    context: &CanvasContext<'_>,
    actions: &mut Vec<Action>,
) {
    let modifiers = response.ctx.input(|input| input.modifiers);
    if response.double_clicked() {
        actions.push(Action::edit(NavigationCommand::Enter(id.clone())));
        return;
    }
    if response.clicked() {
        raise(canvas, id);
        actions.push(match (modifiers.command, modifiers.shift) {
            (true, true) => Action::Pin { node: id.clone() },
            (false, false) => Action::Select(vec![id.clone()]),
            (true, false) | (false, true) => Action::edit(SelectionCommand::Toggle(id.clone())),
        });
        if !modifiers.command && !modifiers.shift {
            actions.push(Action::Show {
                node: id.clone(),
                port: None,
            });
        }
    }
    if response.drag_started_by(egui::PointerButton::Primary) {
        raise(canvas, id);
        begin_move(canvas, id, response, context, actions);
    }
}

fn raise(canvas: &mut Canvas, id: &NodeId) {
    canvas.draw_order.retain(|known| known != id);
    canvas.draw_order.push(id.clone());
}

fn context_menu(
    canvas: &mut Canvas,
    ui: &Ui,
    id: &NodeId,
    response: &Response,
    context: &CanvasContext<'_>,
    actions: &mut Vec<Action>,
) {
    if response.secondary_clicked() && !context.document.selection().contains(id) {
        actions.push(Action::Select(vec![id.clone()]));
    }
    let is_group = context.document.node(id).is_some_and(|node| node.group.is_some());
    response.context_menu(|ui_menu| {
        if ui_menu.button("Replace with…").clicked() {
            canvas.open_menu(ui, Some(id.clone()), None, None);
        }
        if is_group && ui_menu.button("Enter the group").clicked() {
            actions.push(Action::edit(NavigationCommand::Enter(id.clone())));
        }
        let frames = context.document.graph().frames().values();
        let is_framed = frames.into_iter().any(|frame| frame.nodes.contains(id));
        if is_framed && ui_menu.button("Remove from the frame").clicked() {
            actions.push(Action::edit(FrameCommand::Assign(None)));
        }
        channel_menu(ui_menu, id, context.document, actions);
        ui_menu.separator();
        let commands = [
            Command::Look(LookCommand::Preview),
            Command::Look(LookCommand::Pin),
            Command::Graph(GraphCommand::Mute),
            Command::Graph(GraphCommand::Collapse),
            Command::Graph(GraphCommand::HidePorts),
            Command::Graph(GraphCommand::NameWires),
            Command::Canvas(CanvasCommand::Rename),
            Command::Graph(GraphCommand::Duplicate),
            Command::Graph(GraphCommand::DuplicateWired),
            Command::Graph(GraphCommand::Copy),
            Command::Graph(GraphCommand::Group),
            Command::Graph(GraphCommand::Ungroup),
            Command::Graph(GraphCommand::Frame),
            Command::Graph(GraphCommand::TakeOut),
            Command::Graph(GraphCommand::Heal),
            Command::Graph(GraphCommand::Delete),
            Command::Window(WindowCommand::Help),
        ];
        for command in commands
            .into_iter()
            .filter(|command| is_group || *command != Command::Graph(GraphCommand::Ungroup))
        {
            if ui_menu.button(command.title()).clicked() {
                actions.push(Action::Do(command));
            }
        }
    });
}

/// Offers the channels of a node's material, each to be shown on the model alone.
fn channel_menu(ui: &mut Ui, id: &NodeId, document: &OpenDocument, actions: &mut Vec<Action>) {
    let gives_material =
        |interface: &Arc<Interface>| interface.outputs.iter().any(|port| port.ty == Some(PortType::Material));
    if !document.interface(id).is_some_and(gives_material) {
        return;
    }
    ui.menu_button("Show a channel on the model", |ui| {
        for (title, mode) in CHANNELS {
            if ui.button(title).clicked() {
                actions.push(Action::ShowChannel { node: id.clone(), mode });
            }
        }
    });
}

/// Style for a zoom of the canvas.
fn zoomed(style: &egui::Style, zoom: f32) -> egui::Style {
    let mut style = style.clone();
    for font in style.text_styles.values_mut() {
        // Glyphs are cached by size: rounded sizes bound the memory for them.
        font.size = (font.size * zoom * 2.0).round() / 2.0;
    }
    let spacing = &mut style.spacing;
    spacing.item_spacing = egui::Vec2::ZERO;
    spacing.button_padding *= zoom;
    // Ports are placed by rows, whose height must not depend on the style.
    spacing.interact_size = egui::Vec2::ZERO;
    spacing.icon_width *= zoom;
    spacing.icon_width_inner *= zoom;
    spacing.icon_spacing *= zoom;
    style
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::rc::Rc;

    use egui::{Pos2, pos2};
    use egui_kittest::Harness;
    use egui_node_graph::AnyParameterId;
    use sabi_engine::Session;

    use super::super::snapshot::GraphSnapshot;
    use super::*;
    use crate::theme::{ColorScheme, Theme};
    use sabi_editing::node_size::{NODE_WIDTH, rows_of};
    use sabi_editing::{OpenDocument, history};
    use sabi_graph::{Edit, NodeDisplay, NodeRows};

    /// Ports and size of a node as the canvas crate's widget has them.
    fn drawn(document: &OpenDocument, id: &NodeId, zoom: f32) -> (Vec<(AnyParameterId, Pos2)>, Rect) {
        let mut snapshot = GraphSnapshot::default();
        snapshot.sync(document);
        let key = snapshot.key(id).expect("a node of the snapshot");
        let theme = Arc::new(Theme::of(ColorScheme::Dark));
        let found = Rc::new(RefCell::new((Vec::new(), Rect::NOTHING)));
        let given = found.clone();
        let mut harness = Harness::builder().with_size(vec2(900.0, 3000.0)).build_ui(move |ui| {
            theme.apply(ui.ctx());
            ui.set_style(zoomed(&ui.style().clone(), zoom));
            let mut row_context = RowContext {
                theme: theme.clone(),
                zoom,
                knob_events: Vec::new(),
                has_asked_for_menu: false,
            };
            let mut ports = Default::default();
            let widget = GraphNodeWidget {
                position: &mut Pos2::ZERO.clone(),
                orientation: &mut NodeOrientation::LeftToRight,
                graph: &mut snapshot.graph,
                port_locations: &mut ports,
                node_rects: &mut Default::default(),
                node_id: key,
                ongoing_drag: None,
                selected: false,
                pan: egui::Vec2::ZERO,
            };
            let pan_zoom = PanZoom {
                zoom,
                ..PanZoom::default()
            };
            let _ = widget.show(&pan_zoom, ui, &mut row_context);
            let ports = ports.iter().map(|(port, at)| (*port, *at)).collect::<Vec<_>>();
            let whole = ui.ctx().read_response(window_id(ui, key));
            *given.borrow_mut() = (ports, whole.map_or(Rect::NOTHING, |whole| whole.rect));
        });
        harness.run_steps(3);
        found.replace((Vec::new(), Rect::NOTHING))
    }

    /// Checks that ports and size are where `node_size` says.
    fn check(document: &OpenDocument, id: &NodeId, zoom: f32, how: NodeRows) {
        let interface = document.interface(id).expect("a node");
        let rows = rows_of(document, id).expect("a node");
        let (ports, rect) = drawn(document, id, zoom);
        let inputs = (0..interface.inputs.len()).filter(|row| rows.shows_input(*row));
        let inputs = inputs.map(|row| (true, pos2(0.0, rows.input(row))));
        let outputs = (0..interface.outputs.len()).filter(|row| rows.shows_output(*row));
        let outputs = outputs.map(|row| (false, pos2(NODE_WIDTH, rows.output(row))));
        for (is_input, place) in inputs.chain(outputs) {
            let expected = (place.to_vec2() * zoom).to_pos2();
            let is_there = ports.iter().any(|(port, at)| {
                matches!(port, AnyParameterId::Input(_)) == is_input && (*at - expected).length() < 1.0
            });
            assert!(
                is_there,
                "{} at {zoom} with {how:?} rows: {expected:?} in {ports:?}",
                interface.id
            );
        }
        let size = vec2(NODE_WIDTH, rows.size()[1]) * zoom;
        assert!(
            (rect.size() - size).length() < 1.5,
            "{} at {zoom} with {how:?} rows: {rect:?}, and we say {size:?}",
            interface.id
        );
    }

    #[test]
    fn ports_of_every_kind_are_where_its_wires_end_at_every_zoom() {
        let mut document = OpenDocument::new(Session::new(None));
        let drawn_by_widget = document.catalog().entries().filter(|entry| !is_reroute(entry));
        let kinds: Vec<String> = drawn_by_widget.map(|entry| entry.id.clone()).collect();
        for (at, kind) in kinds.iter().enumerate() {
            let id = sabi_editing::nodes::add(&mut document, kind, [0.0, 0.0], None).expect("a kind of the catalog");
            let body = document.body();
            for zoom in [[1.0, 0.6], [1.7, 1.0], [0.6, 3.0]][at % 3] {
                check(&document, &id, zoom, NodeRows::All);
            }
            for (zoom, rows) in [(1.0, NodeRows::Wired), (1.7, NodeRows::None)] {
                let display = NodeDisplay {
                    rows,
                    ..NodeDisplay::default()
                };
                let (body, node) = (body.clone(), id.clone());
                document.edit("Fold", vec![Edit::SetDisplay { body, node, display }]);
                check(&document, &id, zoom, rows);
                history::undo(&mut document);
            }
            history::undo(&mut document);
        }
    }
}
