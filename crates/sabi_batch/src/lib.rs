//! Batches: a matrix of models, graphs and settings becomes a plan of bakes, whose items are run in any order.
//!
//! [`plan_bakes`] expands a matrix into a [`BakePlan`]. Each [`BakeItem`] holds everything that a worker needs for its bake. [`running`]
//! runs items in processes of their own, and [`schedulers`] writes the text with which another program does so.
//!
//! Invariants:
//! * The same matrix and the same files give the same plan, in any folder and on any machine.
//! * The key of an item changes with everything that can change its maps, and with nothing else.
//! * No two items write into one folder.
//! * An item whose inputs differ from the plan is refused.
//! * Nothing here names a flag or prints: a front end says how its program is called, and shows what happens.

mod expansion;
mod inputs;
mod item;
mod matrix;
mod matrix_row;
mod options;
mod out_folders;
mod plan_file;
mod planning;
pub mod running;
pub mod schedulers;
pub mod shell_word;
mod written_files;

pub use inputs::{InputHashes, ItemInput};
pub use item::{BakeItem, ItemMachine};
pub use plan_file::BakePlan;
pub use planning::{PlannedBakes, plan_bakes};
