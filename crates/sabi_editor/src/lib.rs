//! The window: a canvas for the graph, panels around it, and a viewport for the model.
//!
//! [`edit()`] opens it. [`Offscreen`] draws the same frames without a display, for benches.
//!
//! Invariants:
//! * A panel reads the document, the evaluation and the settings, and changes only its own state. For all other changes it
//!   returns an `Action`, and `app::perform` is the one place where actions are performed.
//! * All edits of the document are those of `sabi_editing`; no panel changes a graph itself.
//! * A frame waits for no evaluation, no export and no shader compilation: these run on threads of their own, and the window
//!   shows the last result until the next one arrives.
//! * A command has one name in settings, one title and one row in the table of keys. A command or action that is not handled
//!   does not compile.
//! * Only `canvas` names the canvas crate, and its types are drawn from a copy of the shown graph.
//! * A lost device loses no work: the session is handed over to the window on the next device.

mod action;
mod activity_text;
mod app;
mod bars;
mod brush;
mod brush_shelf;
mod builtin_models;
mod button_frames;
mod canvas;
mod choice_previews;
mod command;
mod context;
mod dock;
mod evaluation;
mod exports;
mod files;
mod flat_view;
mod gradient_picker;
mod import_options;
mod key_map;
mod kinds_reading;
mod knobs;
mod library;
mod model_row;
mod model_view;
mod model_warnings;
mod mouse;
mod node_brush_tip;
mod notices;
mod offscreen;
mod outdated_results;
mod pack_task;
mod panels;
mod paths;
mod pen;
mod remedies;
mod saved_pictures;
mod search;
mod settings;
mod shown_results;
mod task;
mod theme;
mod time_text;
mod type_ahead;
mod views;
mod window;
mod window_watcher;

pub use offscreen::{FrameTime, Offscreen};
pub use window::{EditRequest, edit};
