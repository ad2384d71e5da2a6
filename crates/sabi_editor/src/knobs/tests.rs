//! Rows of parameters under test, whose requests are performed and logged.

mod colors;
mod curves;
mod drags;
mod inline;
mod keyboard;
mod numbers;
mod rows;
mod words;

use std::sync::LazyLock;

use egui::{Event, Key, Modifiers, PointerButton, Pos2, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use sabi_engine::Kinds;
use sabi_engine::catalog::{Catalog, Knob};
use sabi_graph::Value;

use super::{KnobEvent, KnobMemory, KnobRow, LengthUnits, ParamMask, knob_inline, knobs_ui};
use crate::theme::{ColorScheme, Theme};

const LENGTHS: LengthUnits = LengthUnits {
    model_units_per_working: 1.7,
    metres_per_model_unit: 1.0,
};

/// The built-in kinds, which take a moment to read.
static CATALOG: LazyLock<Catalog> = LazyLock::new(|| Catalog::new(&Kinds::builtin()));

/// A knob with the state that its row shows.
#[derive(Clone, Debug)]
struct TestKnob {
    knob: Knob,
    value: Option<Value>,
    wired: Option<&'static str>,
    mask: ParamMask<'static>,
    exposed: Option<&'static str>,
    differs: bool,
}

/// A knob of a built-in kind, such as `noise/simplex.size`.
fn knob(name: &str) -> TestKnob {
    let (kind, name) = name.split_once('.').expect("kind.knob");
    let entry = CATALOG.entry(kind).expect("a built-in kind");
    shown(entry.knob(name).expect("a documented parameter"))
}

fn shown(knob: &Knob) -> TestKnob {
    TestKnob {
        knob: knob.clone(),
        value: None,
        wired: None,
        mask: ParamMask::NotTaken,
        exposed: None,
        differs: false,
    }
}

struct TestState {
    rows: Vec<TestKnob>,
    memory: KnobMemory,
    theme: Theme,
    /// All events of knobs, except for lengths to show.
    log: Vec<KnobEvent>,
    /// The length that was shown last.
    length: Option<f64>,
    /// Zoom of the node that shows the rows; `None` for the panel.
    zoom: Option<f32>,
}

type Board = Harness<'static, TestState>;

fn board(rows: impl IntoIterator<Item = TestKnob>) -> Board {
    board_of(rows, ColorScheme::Dark, None, Vec2::new(320.0, 600.0))
}

fn board_of(rows: impl IntoIterator<Item = TestKnob>, shade: ColorScheme, zoom: Option<f32>, size: Vec2) -> Board {
    let state = TestState {
        rows: rows.into_iter().collect(),
        memory: KnobMemory::default(),
        theme: Theme::of(shade),
        log: Vec::new(),
        length: None,
        zoom,
    };
    let mut is_new = true;
    let show = move |ui: &mut egui::Ui, state: &mut TestState| {
        if std::mem::take(&mut is_new) {
            let mut fonts = egui::FontDefinitions::default();
            egui_phosphor::add_to_fonts(&mut fonts, egui_phosphor::Variant::Regular);
            ui.ctx().set_fonts(fonts);
            state.theme.apply(ui.ctx());
        }
        state.show(ui);
    };
    let mut board = Harness::builder()
        .with_size(size)
        .with_step_dt(1.0 / 60.0)
        .with_max_steps(100)
        .build_ui_state(show, state);
    board.run();
    board
}

/// Place of a widget.
fn middle(board: &Board, name: &str) -> Pos2 {
    board.get_by_label(name).rect().center()
}

fn press(board: &mut Board, at: Pos2) {
    board.hover_at(at);
    board.drag_at(at);
    board.run();
}

fn pull(board: &mut Board, to: Pos2) {
    board.hover_at(to);
    board.run();
}

fn release(board: &mut Board, at: Pos2) {
    board.event(Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed: false,
        modifiers: Modifiers::NONE,
    });
    board.run();
}

/// Drags from a place by an offset, in two steps.
fn drag(board: &mut Board, from: Pos2, way: Vec2) {
    press(board, from);
    pull(board, from + way * 0.5);
    pull(board, from + way);
    release(board, from + way);
}

fn click(board: &mut Board, name: &str) {
    board.get_by_label(name).click();
    board.run();
}

fn double_click(board: &mut Board, at: Pos2) {
    for _ in 0..2 {
        press(board, at);
        release(board, at);
    }
}

fn key(board: &mut Board, key: Key) {
    board.key_press(key);
    board.run();
}

/// Gives a widget the keyboard.
fn focus(board: &mut Board, name: &str) {
    board.get_by_label(name).focus();
    board.run();
}

/// Types into a bar in place of its value.
fn type_into(board: &mut Board, name: &str, text: &str) {
    focus(board, name);
    key(board, Key::Enter);
    board.event(Event::Text(text.to_owned()));
    board.run();
    key(board, Key::Enter);
}

fn set(knob: &str, value: impl Into<Value>) -> KnobEvent {
    KnobEvent::Set {
        knob: knob.to_owned(),
        value: value.into(),
    }
}

fn json(text: &str) -> Value {
    Value::from_json(text).expect("a value")
}

fn taken(board: &mut Board) -> Vec<KnobEvent> {
    std::mem::take(&mut board.state_mut().log)
}

/// Value of the only parameter.
fn current(board: &Board) -> Value {
    let row = &board.state().rows[0];
    row.value.clone().unwrap_or_else(|| row.knob.ty.default.clone())
}

fn number(board: &Board) -> f64 {
    current(board).as_number().expect("a number")
}

/// Returns whether a sentence that contains this text is shown.
fn says(board: &Board, part: &str) -> bool {
    board.query_by_label_contains(part).is_some()
}

impl TestState {
    fn show(&mut self, ui: &mut egui::Ui) {
        let rows: Vec<TestKnob> = self.rows.clone();
        let rows: Vec<KnobRow<'_>> = rows
            .iter()
            .map(|row| KnobRow {
                knob: &row.knob,
                value: row.value.as_ref(),
                wired: row.wired,
                mask: row.mask,
                exposed: row.exposed,
                differs: row.differs,
            })
            .collect();
        let events = match self.zoom {
            None => {
                let section = super::KnobSection {
                    title: None,
                    switch: None,
                    rows,
                };
                knobs_ui(ui, &self.theme, &mut self.memory, &[section], &LENGTHS)
            }
            Some(zoom) => {
                let inline = |row| knob_inline(ui, &self.theme, row, 160.0 * zoom, zoom);
                rows.iter().flat_map(inline).collect()
            }
        };
        for event in events {
            self.take(&event);
            match event {
                KnobEvent::ShowLength(length) => self.length = Some(length),
                event => self.log.push(event),
            }
        }
    }

    fn take(&mut self, event: &KnobEvent) {
        let (knob, value) = match event {
            KnobEvent::Set { knob, value } => (knob, Some(value.clone())),
            KnobEvent::Reset { knob } => (knob, None),
            _ => return,
        };
        for row in self.rows.iter_mut().filter(|row| row.knob.name == *knob) {
            row.value = value.clone();
            row.differs = false;
        }
    }
}
