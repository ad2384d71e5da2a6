//! Camera of the canvas: the shown part of the graph, and the parts that were shown of other graphs.

use std::collections::{BTreeMap, BTreeSet};

use egui::{Pos2, Rect, Ui, Vec2, vec2};
use sabi_editing::notes::approximate_size;
use sabi_editing::{OpenDocument, navigation, ports};
use sabi_graph::NodeId;

use super::node_rect;
use super::port_refs::{PortRef, room_of_name, shown_ports_of};
use super::view::CanvasView;

/// Distance from an edge of the panel at which a drag scrolls the canvas, screen points.
pub(super) const SCROLL_EDGE: f32 = 28.0;
/// Highest speed of scrolling at an edge, screen points a second.
const SCROLL_SPEED: f32 = 900.0;

/// Camera of the canvas.
#[derive(Default)]
pub(crate) struct CanvasCamera {
    pub(super) view: CanvasView,
    /// Views of other graphs, by the instances that lead to them.
    views: BTreeMap<Vec<NodeId>, CanvasView>,
    /// Instances that lead to the shown graph.
    path: Vec<NodeId>,
    /// Rectangle of the panel in the last frame.
    pub(super) panel: Option<Rect>,
    /// True once the view was fitted to all nodes.
    is_fitted: bool,
    /// View that shows all nodes, with the size of the panel that it was made for.
    fitted: Option<(CanvasView, Vec2)>,
}

/// Nodes of the shown graph before an edit.
pub(crate) struct NodesBefore {
    /// Nodes that are wholly in view.
    seen: BTreeSet<NodeId>,
    /// All other nodes.
    others: BTreeSet<NodeId>,
}

/// Rectangle of a node with the names of its exposed ports beside it, canvas points.
fn named_rect(document: &OpenDocument, id: &NodeId) -> Option<Rect> {
    let node = node_rect(document, id)?;
    let mut rect = node;
    for (place, _) in shown_ports_of(document, id) {
        let Some(name) = ports::exposed_as(document, &place.pending_wire()) else {
            continue;
        };
        let room = room_of_name(name);
        match place {
            PortRef::Input(_) => rect.min.x = rect.min.x.min(node.left() - room),
            PortRef::Output(_) => rect.max.x = rect.max.x.max(node.right() + room),
        }
    }
    Some(rect)
}

impl CanvasCamera {
    /// Begins a frame: restores the view of a graph that is shown again, and fits the view to a graph that is shown for the
    /// first time. Returns whether another graph is shown than in the last frame.
    pub(super) fn begin_frame(&mut self, document: &OpenDocument, panel: Rect) -> bool {
        self.panel = Some(panel);
        let path: Vec<NodeId> = navigation::breadcrumb(document).into_iter().map(|(id, _)| id).collect();
        let is_other = path != self.path;
        if is_other {
            let left = std::mem::replace(&mut self.path, path);
            self.views.insert(left, self.view);
            match self.views.get(&self.path) {
                Some(view) => self.view = *view,
                None => self.is_fitted = false,
            }
        }
        // A fitted view that was not moved since is fitted again when the panel has another size.
        let is_reshaped = |(view, size): (CanvasView, Vec2)| view == self.view && size != panel.size();
        if !self.is_fitted || !is_other && self.fitted.is_some_and(is_reshaped) {
            self.frame_all(document);
        }
        is_other
    }

    /// Zooms to all nodes and notes.
    pub(crate) fn frame_all(&mut self, document: &OpenDocument) {
        let graph = document.graph();
        let notes = graph.notes().values();
        let notes = notes.map(|note| Rect::from_min_size(note.pos.into(), approximate_size(note).into()));
        self.frame_rects(graph.ids().filter_map(|id| named_rect(document, id)).chain(notes));
        self.is_fitted = true;
        self.fitted = self.panel.map(|panel| (self.view, panel.size()));
    }

    /// Zooms to these nodes.
    pub(crate) fn frame_nodes<'i>(&mut self, document: &OpenDocument, ids: impl Iterator<Item = &'i NodeId>) {
        self.frame_rects(ids.filter_map(|id| node_rect(document, id)));
    }

    /// Moves the view to a node that was added outside of it, or to all nodes if these are the first ones.
    pub(crate) fn reveal(&mut self, document: &OpenDocument, id: &NodeId, are_first: bool) {
        let (Some(panel), Some(rect)) = (self.panel, node_rect(document, id)) else {
            return;
        };
        let seen = self.view.visible_rect(panel);
        let mut all = document.graph().ids().filter_map(|id| node_rect(document, id));
        if are_first && !all.all(|rect| seen.contains_rect(rect)) {
            self.frame_all(document);
        } else if !seen.intersects(rect) {
            self.view.pan_to(panel, rect);
        }
    }

    /// Nodes before an edit that places new ones where there is room, and moves others out of their way.
    pub(crate) fn before_addition(&self, document: &OpenDocument) -> NodesBefore {
        let seen = self.panel.map(|panel| self.view.visible_rect(panel));
        let ids = document.graph().ids().cloned();
        let (seen, others) = ids.partition(|id| {
            let rect = node_rect(document, id);
            seen.zip(rect).is_some_and(|(seen, rect)| seen.contains_rect(rect))
        });
        NodesBefore { seen, others }
    }

    /// If a node that was added since, or one that was in view before, is out of view, zooms to all of these.
    pub(crate) fn keep_in_view(&mut self, document: &OpenDocument, before: &NodesBefore) {
        let Some(panel) = self.panel else { return };
        let ids = || document.graph().ids();
        let is_new = |id: &NodeId| !before.seen.contains(id) && !before.others.contains(id);
        if !ids().any(is_new) {
            return;
        }
        let wanted = || ids().filter(|id| !before.others.contains(*id));
        let seen = self.view.visible_rect(panel);
        let mut rects = wanted().filter_map(|id| node_rect(document, id));
        if !rects.all(|rect| seen.contains_rect(rect)) {
            drop(rects);
            self.frame_nodes(document, wanted());
        }
    }

    fn frame_rects(&mut self, rects: impl Iterator<Item = Rect>) {
        let all = rects.fold(Rect::NOTHING, |all, rect| all.union(rect));
        if let Some(panel) = self.panel {
            self.view.frame(panel, all);
        }
    }

    /// Nodes in the panel, those near its center first.
    pub(crate) fn visible_nodes(&self, document: &OpenDocument) -> Vec<NodeId> {
        let Some(panel) = self.panel else {
            return Vec::new();
        };
        let shown = self.view.visible_rect(panel);
        let rects = document
            .graph()
            .ids()
            .filter_map(|id| Some((node_rect(document, id)?, id)));
        let mut visible: Vec<(f32, &NodeId)> = rects
            .filter(|(rect, _)| rect.intersects(shown))
            .map(|(rect, id)| (rect.center().distance(shown.center()), id))
            .collect();
        visible.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        visible.into_iter().map(|(_, id)| id.clone()).collect()
    }

    /// Place on the canvas at the center of the panel.
    pub(crate) fn center(&self) -> [f32; 2] {
        self.panel
            .map_or([0.0; 2], |panel| self.view.place(panel, panel.center()))
    }

    /// Place on the canvas at a place of the screen; `None` outside of the panel.
    pub(crate) fn place_at(&self, at: Pos2) -> Option<[f32; 2]> {
        let panel = self.panel.filter(|panel| panel.contains(at))?;
        Some(self.view.place(panel, at))
    }

    /// Place on the canvas for a new node: under the pointer, or at the center of the panel.
    pub(crate) fn place_for_new(&self, ui: &Ui) -> [f32; 2] {
        self.view.place(self.panel_or_unit(), self.screen_for_new(ui))
    }

    /// Place on the screen for a new node or a menu: the pointer, or the center of the panel.
    pub(super) fn screen_for_new(&self, ui: &Ui) -> Pos2 {
        let panel = self.panel_or_unit();
        let pointer = ui.input(|input| input.pointer.hover_pos());
        pointer.filter(|at| panel.contains(*at)).unwrap_or(panel.center())
    }

    /// Rectangle of the panel, or of one point before it was shown.
    fn panel_or_unit(&self) -> Rect {
        self.panel.unwrap_or(Rect::from_min_size(Pos2::ZERO, vec2(1.0, 1.0)))
    }

    /// Zooms and pans by the wheel and by touch gestures.
    pub(super) fn zoom_and_pan(&mut self, ui: &Ui, panel: Rect) {
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

    /// Scrolls the canvas while a drag is near an edge of the panel.
    pub(super) fn scroll_at_edge(&mut self, ui: &Ui, panel: Rect, pointer: Pos2) {
        let over = |at: f32, low: f32, high: f32| {
            let below = (low + SCROLL_EDGE - at).clamp(0.0, SCROLL_EDGE);
            let above = (at - high + SCROLL_EDGE).clamp(0.0, SCROLL_EDGE);
            (below - above) / SCROLL_EDGE
        };
        let direction = vec2(
            over(pointer.x, panel.left(), panel.right()),
            over(pointer.y, panel.top(), panel.bottom()),
        );
        if direction != egui::Vec2::ZERO {
            let seconds = ui.input(|input| input.stable_dt).min(0.1);
            self.view.pan += direction * SCROLL_SPEED * seconds;
            ui.ctx().request_repaint();
        }
    }
}
