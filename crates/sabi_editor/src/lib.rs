//! The window: a canvas for the graph, panels around it, the model in the light.

mod desk;
mod theme;
