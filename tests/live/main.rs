//! Events that a window receives about a graph while it is edited.

mod answers;
mod faults;
mod models;
mod thumbnails;
mod walk;
mod window;
