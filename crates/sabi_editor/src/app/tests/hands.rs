//! Input of the tests: pointing, dragging and typing, and places in the window.

use std::path::Path;

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, Rect, TouchPhase, Vec2, pos2, vec2};
use egui_kittest::kittest::{NodeT, Queryable, by};
use sabi_editing::node_size::TITLE_HEIGHT;
use sabi_editing::{connections, node_size};
use sabi_graph::{NodeId, OutputRef, SlotRef};

use super::Window;
use crate::dock::Panel;

/// The pointer.
impl Window {
    /// Moves the pointer to a place.
    pub(super) fn point(&mut self, at: Pos2) {
        self.harness.event(Event::PointerMoved(at));
        self.harness.step();
    }

    /// Presses or releases modifier keys.
    pub(super) fn hold(&mut self, modifiers: Modifiers) {
        self.harness.input_mut().modifiers = modifiers;
        self.harness.step();
    }

    pub(super) fn button(&mut self, at: Pos2, button: PointerButton, pressed: bool) {
        self.queue_button(at, button, pressed);
        self.harness.step();
    }

    /// Presses or releases a button in the next frame, together with other events that are queued before it.
    pub(super) fn queue_button(&mut self, at: Pos2, button: PointerButton, pressed: bool) {
        let modifiers = self.harness.input().modifiers;
        self.harness.event(Event::PointerButton {
            pos: at,
            button,
            pressed,
            modifiers,
        });
    }

    pub(super) fn click_at(&mut self, at: Pos2) {
        self.click_with(at, PointerButton::Primary, Modifiers::NONE);
    }

    pub(super) fn click_with(&mut self, at: Pos2, button: PointerButton, modifiers: Modifiers) {
        // Waits, or two clicks would be a double click.
        self.pause();
        self.hold(modifiers);
        self.point(at);
        self.button(at, button, true);
        self.button(at, button, false);
        self.hold(Modifiers::NONE);
        self.settle();
    }

    pub(super) fn double_click(&mut self, at: Pos2) {
        self.pause();
        self.point(at);
        for pressed in [true, false, true, false] {
            self.button(at, PointerButton::Primary, pressed);
        }
        self.settle();
    }

    /// Waits half a second.
    pub(super) fn pause(&mut self) {
        let now = self.harness.ctx.input(|input| input.time);
        self.harness.input_mut().time = Some(now + 0.5);
        self.harness.step();
        self.harness.input_mut().time = None;
    }

    /// Presses a button and drags along places.
    pub(super) fn pull(&mut self, way: &[Pos2], button: PointerButton, modifiers: Modifiers) {
        self.pause();
        self.hold(modifiers);
        self.point(way[0]);
        self.button(way[0], button, true);
        for ends in way.windows(2) {
            for share in [0.34, 0.67, 1.0] {
                self.point(ends[0].lerp(ends[1], share));
            }
        }
    }

    /// Drags along places and releases the button at the last.
    pub(super) fn drag_along(&mut self, way: &[Pos2], button: PointerButton, modifiers: Modifiers) {
        self.pull(way, button, modifiers);
        let end = way[way.len() - 1];
        self.button(end, button, false);
        self.hold(Modifiers::NONE);
        self.settle();
    }

    pub(super) fn drag(&mut self, from: Pos2, to: Pos2, button: PointerButton, modifiers: Modifiers) {
        self.drag_along(&[from, to], button, modifiers);
    }

    pub(super) fn drag_from(&mut self, from: Pos2, to: Pos2) {
        self.drag_with(from, to, Modifiers::NONE);
    }

    pub(super) fn drag_with(&mut self, from: Pos2, to: Pos2, modifiers: Modifiers) {
        self.drag_along(&[from, to], PointerButton::Primary, modifiers);
    }

    /// Scrolls over a place, and waits until smooth scrolling has ended.
    pub(super) fn wheel(&mut self, at: Pos2, points: f32) {
        self.point(at);
        self.harness.event(Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta: vec2(0.0, points),
            phase: TouchPhase::Move,
            modifiers: Modifiers::NONE,
        });
        self.harness.run_steps(30);
    }
}

/// The keyboard.
impl Window {
    pub(super) fn key(&mut self, key: Key) {
        self.keys(Modifiers::NONE, key);
    }

    pub(super) fn keys(&mut self, modifiers: Modifiers, key: Key) {
        // Systems report copying and cutting as clipboard events in place of these keys.
        let told = match key {
            Key::C if modifiers == Modifiers::COMMAND => Some(Event::Copy),
            Key::X if modifiers == Modifiers::COMMAND => Some(Event::Cut),
            _ => None,
        };
        match told {
            Some(event) => self.harness.event_modifiers(event, modifiers),
            None => self.harness.key_press_modifiers(modifiers, key),
        }
        self.settle();
    }

    /// Drops a file or a folder on the window.
    pub(super) fn dropped(&mut self, path: &Path) {
        self.harness.input_mut().dropped_files.push(egui::DroppedFile {
            path: Some(path.to_owned()),
            ..egui::DroppedFile::default()
        });
        self.settle();
    }

    pub(super) fn typed(&mut self, text: &str) {
        self.harness.event(Event::Text(text.to_owned()));
        self.settle();
    }
}

/// Places in the window.
impl Window {
    /// Place on the screen in the canvas panel: `[0, 0]` is its upper left corner, `[1, 1]` the lower right one.
    pub(super) fn on_canvas(&self, share: [f32; 2]) -> Pos2 {
        let rect = self.editor().shell.dock.rects[&Panel::Canvas];
        rect.min + vec2(share[0] * rect.width(), share[1] * rect.height())
    }

    /// Zoom of the canvas.
    pub(super) fn zoom(&self) -> f32 {
        let middle = self.on_canvas([0.5, 0.5]);
        let place = |at| {
            self.editor()
                .views
                .canvas
                .camera
                .place_at(at)
                .expect("a place on the canvas")
        };
        let [one, other] = [place(middle), place(middle + vec2(100.0, 0.0))];
        100.0 / (other[0] - one[0])
    }

    /// Place on the screen of a place on the canvas.
    pub(super) fn screen(&self, place: [f32; 2]) -> Pos2 {
        let middle = self.on_canvas([0.5, 0.5]);
        let there = self
            .editor()
            .views
            .canvas
            .camera
            .place_at(middle)
            .expect("a place on the canvas");
        middle + vec2(place[0] - there[0], place[1] - there[1]) * self.zoom()
    }

    /// Rectangle of a node on the screen.
    pub(super) fn rect(&self, id: &NodeId) -> Rect {
        let pos = self.document().node(id).expect("a node").pos;
        let size = Vec2::from(node_size::of(self.document(), id)) * self.zoom();
        Rect::from_min_size(self.screen(pos), size)
    }

    /// Place of a node's title, at which it is dragged.
    pub(super) fn title(&self, id: &NodeId) -> Pos2 {
        let rect = self.rect(id);
        rect.center_top() + vec2(0.0, TITLE_HEIGHT / 2.0 * self.zoom())
    }

    /// Adds a node by the menu at a place of the canvas.
    pub(super) fn add(&mut self, share: [f32; 2], query: &str) -> NodeId {
        let at = self.on_canvas(share);
        self.point(at);
        self.key(Key::Tab);
        self.pick(query)
    }

    /// Chooses a node in the menu that is open.
    pub(super) fn pick(&mut self, query: &str) -> NodeId {
        self.typed(query);
        self.key(Key::Enter);
        let added = self.document().selected_one().cloned();
        added.unwrap_or_else(|| panic!("nothing is called '{query}'"))
    }

    /// Place on the screen of a node's input with this name, or of its output if no input has the name.
    pub(super) fn port(&self, node: &NodeId, name: &str) -> Pos2 {
        let interface = self.document().interface(node).expect("a node");
        let side = if interface.input(name).is_some() {
            "input"
        } else {
            "output"
        };
        self.port_at(node, side, name)
    }

    /// Place of a port, found by its accessible name.
    pub(super) fn port_at(&self, node: &NodeId, side: &str, name: &str) -> Pos2 {
        let document = self.document();
        let interface = document.interface(node).expect("a node");
        let port = match side {
            "input" => interface.input(name),
            _ => interface.output(Some(name)),
        };
        let port = port.expect("a port");
        let carries = port.ty.map_or("anything".to_owned(), |ty| ty.to_string());
        let said = format!("{}, {side} {}, {carries}", document.title(node), port.label);
        let near = self.rect(node).expand(20.0);
        let mut found = self.harness.query_all_by_label(&said).map(|node| node.rect().center());
        found
            .find(|at| near.contains(*at))
            .unwrap_or_else(|| panic!("no port '{said}'"))
    }

    /// Drags a wire from one port to another.
    pub(super) fn wire(&mut self, from: &NodeId, output: &str, to: &NodeId, input: &str) {
        let interface = self.document().interface(from).expect("a node");
        let side = if interface.output(Some(output)).is_some() {
            "output"
        } else {
            "input"
        };
        let ends = [self.port_at(from, side, output), self.port(to, input)];
        self.drag_from(ends[0], ends[1]);
    }

    pub(super) fn wire_into(&self, node: &NodeId, input: &str) -> Option<OutputRef> {
        let slot = SlotRef {
            node: node.clone(),
            name: input.to_owned(),
        };
        connections::wire_into(self.document(), &slot).cloned()
    }

    /// Output that an input reads, as files name it; empty where it is not connected.
    pub(super) fn reads(&self, node: &NodeId, input: &str) -> String {
        self.wire_into(node, input)
            .map_or_else(String::new, |from| from.to_string())
    }

    /// Clicks a button by its name; of several, the one that was drawn last.
    pub(super) fn press(&mut self, name: &str) {
        let found = self.harness.query_all(by().role(Role::Button).label(name));
        let at = found.map(|node| node.rect().center()).next_back();
        let at = at.unwrap_or_else(|| panic!("no button is called '{name}'"));
        self.click_at(at);
    }

    /// Clicks the tab of a panel.
    pub(super) fn open(&mut self, panel: Panel) {
        let tabs = self
            .harness
            .query_all(by().role(Role::Button).label_contains(panel.title()));
        let mut tabs = tabs.filter(|tab| tab.accesskit_node().label().is_some_and(|label| is_tab(&label, panel)));
        let at = tabs
            .next()
            .unwrap_or_else(|| panic!("no tab for {}", panel.title()))
            .rect()
            .center();
        drop(tabs);
        self.click_at(at);
        assert!(
            self.editor().shell.dock.rects.contains_key(&panel),
            "{} is shown",
            panel.title()
        );
    }

    /// Accessible names of everything that is shown.
    pub(super) fn labels(&self) -> Vec<String> {
        let nodes = self.harness.query_all(by().predicate(|_| true));
        let named = |node: egui_kittest::Node<'_>| node.accesskit_node().label().or(node.value());
        nodes.filter_map(named).collect()
    }
}

/// Returns whether a tab has the title of a panel, possibly with a count.
fn is_tab(label: &str, panel: Panel) -> bool {
    let rest = label.strip_prefix(panel.title());
    rest.is_some_and(|rest| rest.trim().chars().all(|letter| letter.is_ascii_digit()))
}

/// Parses an id.
pub(super) fn id(text: &str) -> NodeId {
    text.parse().expect("an id")
}

/// Place at an offset.
pub(super) fn beside(at: Pos2, way: [f32; 2]) -> Pos2 {
    at + Vec2::from(way)
}

/// The middle of two places.
pub(super) fn between(one: Pos2, other: Pos2) -> Pos2 {
    pos2((one.x + other.x) / 2.0, (one.y + other.y) / 2.0)
}

/// Rows of the panel of parameters.
impl Window {
    /// Place of a widget in the panel of parameters.
    pub(super) fn knob(&self, name: &str) -> Pos2 {
        let panel = self.editor().shell.dock.rects[&Panel::Parameters];
        let mut found = self.harness.query_all_by_label(name).map(|node| node.rect().center());
        found
            .find(|at| panel.contains(*at))
            .unwrap_or_else(|| panic!("no knob '{name}'"))
    }

    /// Types a number into a bar in place of its value.
    pub(super) fn set_number(&mut self, name: &str, text: &str) {
        self.click_at(self.knob(name));
        self.key(Key::Enter);
        self.typed(text);
        self.key(Key::Enter);
    }

    /// Rectangle of the widget with this accessible name.
    pub(super) fn area(&self, name: &str) -> Rect {
        self.harness.get_by_label(name).rect()
    }

    /// Types the code of a color.
    pub(super) fn set_color(&mut self, name: &str, code: &str) {
        self.click_at(self.knob(&format!("{name}: code")));
        self.typed(code);
        self.key(Key::Enter);
    }

    /// Value of a node's parameter as text.
    pub(super) fn param(&self, node: &NodeId, name: &str) -> Option<String> {
        let node = self.document().node(node).expect("a node");
        node.params.get(name).map(sabi_graph::Value::to_json)
    }
}
