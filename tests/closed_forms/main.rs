//! Closed forms: results whose value is known without running a kernel.

mod cells;
mod curves;
mod noise;
mod reexport;
mod relief;
mod relief_seams;
mod waves;
