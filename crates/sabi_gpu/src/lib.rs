//! The device: choosing it, textures, pipelines, running a plan, readback.

mod blocks;
mod cache;
mod device;
mod error;
mod finish;
mod leaps;
mod levels;
mod links;
mod maps;
mod needs;
mod pipelines;
mod pool;
mod rays;
mod readback;
mod run;
mod shares;
mod surface;
mod survey;
mod tables;
mod tiles;
mod uploads;

pub use cache::{ResultCache, ResultKey};
pub use device::{AdapterChoice, AdapterKind, AdapterSummary, Gpu, adapters};
pub use error::GpuError;
pub use levels::{CoarseSurface, Surfaces};
pub use maps::{DeviceMaps, MaterialSlots};
pub use pool::{DEFAULT_BUDGET_BYTES, PoolReport};
pub use rays::{CasterChoice, DeviceHierarchy, Hits, RayScene};
pub use readback::PlaneData;
pub use run::{Run, RunOptions, RunReport, SourceFill, StepTime};
pub use shares::{Mean, Shares};
pub use surface::{GpuSurface, Measures};
pub use tables::SurfaceTables;
