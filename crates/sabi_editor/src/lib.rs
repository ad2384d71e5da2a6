//! The window: a canvas for the graph, panels around it, the model in the light.

mod action;
mod app;
mod canvas;
mod command;
mod dock;
mod errand;
mod files;
mod flat_view;
mod key_map;
mod knobs;
mod model_view;
mod mouse;
mod offscreen;
mod panels;
mod reading;
mod search;
mod settings;
mod stage;
mod theme;
mod watching;
mod window;

pub use offscreen::{FrameTime, Offscreen};
pub use window::{EditRequest, edit};
