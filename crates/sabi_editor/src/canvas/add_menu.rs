//! The menu at the pointer that adds or replaces a node.

use egui::{Area, Color32, FontId, Frame, Id, Key, Order, Pos2, Sense, Ui, vec2};
use egui_phosphor::regular as icon;
use sabi_editing::command::NodeCommand;
use sabi_editing::connections::PendingWire;
use sabi_editing::{OpenDocument, connections, nodes, wires};
use sabi_graph::{NodeId, OutputRef, SlotRef};

use super::body::elided;
use crate::action::Action;
use crate::search::{Candidate, found_alias, ranked};
use crate::theme::{Theme, space, type_size};

/// Size of the list, points.
const SIZE: [f32; 2] = [300.0, 360.0];
const ROW: f32 = 34.0;

/// Use of the chosen node.
#[derive(Clone, Debug, Default)]
pub(super) struct Purpose {
    /// Place on the canvas.
    pub(super) place: [f32; 2],
    /// Wire that is connected to it.
    pub(super) pending: Option<PendingWire>,
    /// Wire that it is inserted into.
    pub(super) into: Option<SlotRef>,
    /// Node that it replaces.
    pub(super) instead: Option<NodeId>,
    /// Output of the selected node, which it can be connected to.
    pub(super) selected: Option<OutputRef>,
}

/// The menu while it is open.
pub(super) struct AddMenu {
    at: Pos2,
    purpose: Purpose,
    query: String,
    chosen: usize,
    /// True if nodes that the wire does not fit are listed too.
    shows_all: bool,
    is_new: bool,
}

/// Result of a frame of the menu.
pub(super) enum MenuResult {
    Open,
    Closed,
    Chosen(Action),
}

impl AddMenu {
    pub(super) fn new(at: Pos2, purpose: Purpose) -> AddMenu {
        AddMenu {
            at,
            purpose,
            query: String::new(),
            chosen: 0,
            shows_all: false,
            is_new: true,
        }
    }

    pub(super) fn show(
        &mut self,
        ui: &Ui,
        document: &OpenDocument,
        theme: &Theme,
        candidates: &[Candidate],
    ) -> MenuResult {
        let mut result = MenuResult::Open;
        let area = Area::new(Id::new("add_menu"))
            .order(Order::Foreground)
            .current_pos(self.at)
            .constrain(true);
        let shown = area.show(ui.ctx(), |ui| {
            let frame = Frame::popup(ui.style()).fill(theme.panel).inner_margin(space::USUAL);
            frame.show(ui, |ui| {
                ui.set_width(SIZE[0]);
                result = self.contents(ui, document, theme, candidates);
            });
        });
        let is_outside = ui.input(|input| {
            let pressed = input.pointer.any_pressed();
            pressed
                && input
                    .pointer
                    .interact_pos()
                    .is_some_and(|at| !shown.response.rect.contains(at))
        });
        let is_left = ui.input(|input| input.key_pressed(Key::Escape));
        let is_over = matches!(result, MenuResult::Open) && (is_outside && !self.is_new || is_left);
        self.is_new = false;
        if is_over { MenuResult::Closed } else { result }
    }

    fn contents(
        &mut self,
        ui: &mut Ui,
        document: &OpenDocument,
        theme: &Theme,
        candidates: &[Candidate],
    ) -> MenuResult {
        let edit = egui::TextEdit::singleline(&mut self.query)
            .hint_text(format!("{} Find a node", icon::MAGNIFYING_GLASS))
            .desired_width(f32::INFINITY);
        let field = ui.add(edit);
        let is_other = field.changed();
        field.request_focus();
        field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "Find a node"));
        if field.changed() {
            self.chosen = 0;
        }
        let fitting: Vec<Candidate> = candidates
            .iter()
            .filter(|it| self.shows_all || self.fits(document, it))
            .cloned()
            .collect();
        let found = ranked(&fitting, &self.query);
        self.step(ui, found.len());
        self.offer_selected(ui, document, theme);
        if self.purpose.pending.is_some() && self.purpose.selected.is_none() || self.purpose.into.is_some() {
            ui.horizontal(|ui| {
                ui.colored_label(theme.quiet, "Nodes that fit the wire");
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    ui.checkbox(&mut self.shows_all, "All");
                });
            });
        }
        ui.add_space(space::TIGHT);
        let entered = ui.input(|input| input.key_pressed(Key::Enter)).then_some(self.chosen);
        let taken = self.list(ui, theme, &found, is_other).or(entered);
        match taken.and_then(|at| found.get(at)) {
            Some(candidate) => MenuResult::Chosen(self.action(document, candidate)),
            None => MenuResult::Open,
        }
    }

    /// Offers to connect the new node to the selected one: by a click, or by Tab in the field.
    fn offer_selected(&mut self, ui: &mut Ui, document: &OpenDocument, theme: &Theme) {
        let Some(selected) = self.purpose.selected.clone() else {
            return;
        };
        let mut is_connected = self.purpose.pending.is_some();
        // The key that opened the menu does not count.
        let is_toggled = !self.is_new && ui.input(|input| input.key_pressed(Key::Tab));
        let title = document.title(&selected.node);
        ui.horizontal(|ui| {
            let choice = ui.checkbox(&mut is_connected, format!("Connect to {title}"));
            choice.on_hover_text("Lists only nodes that take its result, and connects the chosen one.");
            ui.colored_label(theme.quiet, "Tab");
        });
        if is_toggled {
            is_connected = !is_connected;
        }
        if is_connected != self.purpose.pending.is_some() {
            self.chosen = 0;
        }
        self.purpose.pending = is_connected.then_some(PendingWire::From(selected));
    }

    /// Shows the list of nodes, in sections while nothing is searched, and scrolled to its top if the list `is_other`
    /// than before. Returns the index of the clicked node.
    fn list(&mut self, ui: &mut Ui, theme: &Theme, found: &[&Candidate], is_other: bool) -> Option<usize> {
        let is_sectioned = self.query.trim().is_empty();
        let mut area = egui::ScrollArea::vertical()
            .max_height(SIZE[1])
            // The popup offers only as much height as its last contents took.
            .min_scrolled_height(SIZE[1])
            // A shorter list leaves the field above it where it is, also near the lower end of the window.
            .auto_shrink(false);
        if is_other {
            area = area.vertical_scroll_offset(0.0);
        }
        let mut clicked = None;
        area.show(ui, |ui| {
            if found.is_empty() {
                ui.colored_label(theme.quiet, "No node is called that; try another word.");
            }
            let mut section = "";
            for (at, candidate) in found.iter().enumerate() {
                if is_sectioned && section != candidate.section {
                    section = &candidate.section;
                    ui.add_space(space::TIGHT);
                    ui.label(
                        egui::RichText::new(section.to_uppercase())
                            .size(type_size::SMALL)
                            .color(theme.quiet),
                    );
                }
                if self.row(ui, theme, candidate, at) {
                    clicked = Some(at);
                }
            }
        });
        clicked
    }

    /// Moves the choice by the arrow keys.
    fn step(&mut self, ui: &Ui, count: usize) {
        let (down, up) = ui.input(|input| (input.key_pressed(Key::ArrowDown), input.key_pressed(Key::ArrowUp)));
        if down {
            self.chosen += 1;
        }
        if up {
            self.chosen = self.chosen.saturating_sub(1);
        }
        self.chosen = self.chosen.min(count.saturating_sub(1));
    }

    fn row(&mut self, ui: &mut Ui, theme: &Theme, candidate: &Candidate, at: usize) -> bool {
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
        let interface = &candidate.interface;
        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &interface.label));
        let is_chosen = at == self.chosen;
        if is_chosen && ui.input(|input| input.key_pressed(Key::ArrowDown) || input.key_pressed(Key::ArrowUp)) {
            response.scroll_to_me(None);
        }
        if !ui.is_rect_visible(rect) {
            return response.clicked();
        }
        let fill = match (is_chosen, response.hovered()) {
            (true, _) => theme.accent.gamma_multiply(0.35),
            (false, true) => theme.hovered,
            (false, false) => Color32::TRANSPARENT,
        };
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        painter.rect_filled(rect, space::CORNER, fill);
        let mark = egui::Rect::from_min_size(rect.min + vec2(4.0, 6.0), vec2(4.0, ROW - 12.0));
        painter.rect_filled(mark, 2.0, theme.category(interface.category()));
        // The dots of the outputs are beside the name.
        let dots = 10.0 * interface.outputs.len().min(4) as f32;
        let text = |at: egui::Pos2, text: &str, size: f32, color: Color32| {
            let right = if size == type_size::BODY {
                dots + space::USUAL
            } else {
                space::TIGHT
            };
            let width = rect.right() - at.x - right;
            painter.galley(at, elided(ui, text, FontId::proportional(size), width, color), color);
        };
        let label = match found_alias(candidate, &self.query) {
            Some(alias) => format!("{} ({alias})", interface.label),
            None => interface.label.clone(),
        };
        text(rect.min + vec2(16.0, 2.0), &label, type_size::BODY, theme.text);
        text(
            rect.min + vec2(16.0, 18.0),
            &interface.summary,
            type_size::SMALL,
            theme.quiet,
        );
        let outputs = interface.outputs.iter().enumerate();
        for (at, port) in outputs.take(4) {
            let center = rect.right_top() + vec2(-10.0 - 10.0 * at as f32, 10.0);
            painter.circle_filled(center, 3.5, theme.port(port.ty));
        }
        response.on_hover_text(&interface.summary).clicked()
    }

    fn fits(&self, document: &OpenDocument, candidate: &Candidate) -> bool {
        let interface = &candidate.interface;
        if let Some(into) = &self.purpose.into {
            return wires::can_insert_new(document, interface, into);
        }
        match &self.purpose.pending {
            None => true,
            Some(PendingWire::From(from)) => interface
                .input_for(document.interfaces().carried(&document.body(), from))
                .is_some(),
            Some(PendingWire::Into(to)) => {
                connections::input(document, to).is_some_and(|input| interface.output_for(input).is_some())
            }
        }
    }

    fn action(&self, document: &OpenDocument, chosen: &Candidate) -> Action {
        let purpose = self.purpose.clone();
        let new = chosen.new.clone();
        // A node at the end of a dropped wire stays where the wire was dropped. For a node that is inserted into a
        // wire, other nodes make room.
        let is_dropped = purpose.into.is_some() || purpose.pending.is_some() && purpose.selected.is_none();
        match purpose.instead {
            Some(node) => Action::Replace { node, by: new },
            None => Action::edit(NodeCommand::Add {
                source: new,
                place: match is_dropped {
                    true => purpose.place,
                    false => nodes::uncovered(document, &chosen.interface, purpose.place),
                },
                pending: purpose.pending,
                into: purpose.into,
            }),
        }
    }
}
