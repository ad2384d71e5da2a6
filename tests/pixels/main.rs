//! Pixels: what kernels make of every node, seen on the software adapter. Kinds are found by enumeration: a new node
//! file is held to everything here without being named.

mod broken_models;
mod fields;
mod golden;
mod groups;
mod library;
mod many_charts;
mod modes;
mod new_nodes;
mod painted_tiles;
mod param_masks;
mod pattern_outputs;
mod patterns;
mod promises;
mod resolution;
mod seams;
mod specimens;
mod units;
mod unwraps;
mod wild_nodes;
