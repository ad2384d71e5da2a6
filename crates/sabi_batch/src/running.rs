//! Running of items, each in a process of its own.
//!
//! If a driver crashes or the system ends a process for lack of memory, only one item fails; the memory of an item is free
//! once it has ended. Starting a process and opening the device for each takes tenths of a second.

mod item_process;
mod item_status;
mod queue;
mod run_share;

pub use item_process::ProcessEnd;
pub use item_status::ItemStatus;
pub use queue::{ItemEvent, Queue};
pub use run_share::RunShare;
