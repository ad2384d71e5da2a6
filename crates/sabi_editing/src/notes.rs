//! Texts on the canvas.

use sabi_graph::{Edit, Note};

use crate::frames::next_color;
use crate::open_document::OpenDocument;

/// Width of a new note, canvas points.
pub const NOTE_WIDTH: f32 = 240.0;
/// Minimum width of a note, canvas points.
pub const LEAST_NOTE_WIDTH: f32 = 80.0;
/// Approximate width of a letter and height of a line of a note, canvas points.
const LETTER: [f32; 2] = [7.0, 19.0];
/// Error about a note that does not exist.
const GONE: &str = "this note does not exist any more";

/// Adds a note at a place of the canvas.
pub fn add(document: &mut OpenDocument, pos: [f32; 2], text: String) -> bool {
    let notes = document.graph().notes();
    let taken = notes.keys().filter_map(|id| id.parse().ok()).collect();
    let id = document.new_id("note", &taken).to_string();
    let note = Note {
        text,
        pos,
        width: NOTE_WIDTH,
        ..Note::default()
    };
    set(document, "Add a note", &id, Some(note))
}

/// Changes a note.
pub fn change(document: &mut OpenDocument, id: &str, change: NoteChange) -> bool {
    let Some(mut note) = document.graph().notes().get(id).cloned() else {
        return document.refuse(GONE);
    };
    let step = match change {
        NoteChange::Text(text) => {
            note.text = text;
            "Write a note"
        }
        NoteChange::Move(pos) => {
            note.pos = pos;
            "Move a note"
        }
        NoteChange::Width(width) => {
            note.width = width.max(LEAST_NOTE_WIDTH);
            "Resize a note"
        }
        NoteChange::NextColor => {
            note.color = Some(next_color(note.color.as_deref()));
            "Color a note"
        }
    };
    set(document, step, id, Some(note))
}

/// Change of a note.
#[derive(Clone, Debug, PartialEq)]
pub enum NoteChange {
    /// Replace its text.
    Text(String),
    /// Move its upper left corner, canvas points.
    Move([f32; 2]),
    /// Set its width, canvas points.
    Width(f32),
    /// Give it the next color of the palette.
    NextColor,
}

/// Removes a note.
pub fn remove(document: &mut OpenDocument, id: &str) -> bool {
    if !document.graph().notes().contains_key(id) {
        return document.refuse(GONE);
    }
    set(document, "Delete a note", id, None)
}

fn set(document: &mut OpenDocument, step: &str, id: &str, note: Option<Note>) -> bool {
    let edit = Edit::SetNote {
        body: document.body(),
        id: id.to_owned(),
        note,
    };
    document.edit(step, vec![edit])
}

/// Returns the approximate size of a note on the canvas. Its lines are measured exactly only when they are drawn.
pub fn approximate_size(note: &Note) -> [f32; 2] {
    let letters = (note.width / LETTER[0]).max(1.0);
    let lines = note.text.split('\n');
    let rows: f32 = lines
        .map(|line| (line.chars().count() as f32 / letters).ceil().max(1.0))
        .sum();
    [note.width, (rows + 1.0) * LETTER[1]]
}
