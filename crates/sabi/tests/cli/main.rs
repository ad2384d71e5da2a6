//! Runs the real binary on real files, and checks its files, its messages and its exit code.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod bad_archives;
mod bad_graphs;
mod bad_models;
mod bad_places;
mod baking;
mod batches;
mod borders;
mod copies;
mod display;
mod documentation;
mod examples;
mod failures;
mod help;
mod hostile;
mod images;
mod info;
mod interruption;
mod log;
mod looking;
mod losses;
mod model_options;
mod nothing_lost;
mod outputs;
mod own_maps;
mod packed_models;
mod packed_places;
mod packing;
mod painting;
mod parts;
mod place;
mod planning;
mod presets;
mod progress;
mod rays;
mod reference;
mod rendering;
mod reproducing;
mod set_files;
mod settings;
mod standard_input;
mod told_at_once;
mod trust;
mod unwrapping;
mod window;
