//! Pixels: results of the kernels of every node on the software adapter. Kinds are found by enumeration, so a new node file
//! is tested without being named here.

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
