//! Batches: a matrix of models, graphs and settings becomes a plan of bakes. Each bake is an item, and workers run the items in any order.

mod expansion;
mod inputs;
mod item;
mod matrix;
mod matrix_row;
mod options;
mod out_folders;
mod plan_file;
mod planning;
mod written_files;

pub use inputs::{InputHashes, ItemInput};
pub use item::{BakeItem, ItemMachine};
pub use plan_file::BakePlan;
pub use planning::{PlannedBakes, plan_bakes};
