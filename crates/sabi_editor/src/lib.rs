//! The window: a canvas for the graph, panels around it, the model in the light.

mod action;
mod app;
mod bars;
mod canvas;
mod command;
mod context;
mod dock;
mod evaluation;
mod exports;
mod files;
mod flat_view;
mod import_options;
mod key_map;
mod knobs;
mod library;
mod looks;
mod model_view;
mod mouse;
mod notices;
mod offscreen;
mod panels;
mod paths;
mod remedies;
mod saved_pictures;
mod search;
mod settings;
mod task;
mod theme;
mod time_text;
mod views;
mod watching;
mod window;

pub use offscreen::{FrameTime, Offscreen};
pub use window::{EditRequest, edit};
