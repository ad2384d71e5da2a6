//! What a window is told of a graph while it is worked on.

mod answers;
mod faults;
mod models;
mod thumbnails;
mod walk;
mod window;
