//! The device: adapter choice, textures, pipelines, running a plan, readback.
//!
//! [`Gpu::open`] opens an adapter, or [`Gpu::adopt_device`] takes a window's device; [`run_plan`] runs a plan on a surface.
//!
//! Invariants:
//! * Only this crate and the viewport create pipelines; all earlier stages produce plain data.
//! * A lost device and exhausted memory are errors, never panics.
//! * What a run allocates stays within its budget in bytes, or the run fails and says so.
//! * Nothing here knows the document, files or the caller.
//!
//! ```no_run
//! use sabi_gpu::{AdapterChoice, Gpu};
//!
//! let gpu = Gpu::open(&AdapterChoice::Auto)?;
//! println!("{} ({})", gpu.summary().name, gpu.summary().driver);
//! # Ok::<(), sabi_gpu::GpuError>(())
//! ```

mod adapter;
mod anisotropy;
mod bindings;
mod blocks;
mod borders;
mod cache;
mod changes;
mod coverage;
mod device;
mod driver_errors;
mod error;
mod extents;
mod formats;
mod ghosts;
mod layer_rows;
mod leaps;
mod levels;
mod links;
mod made_map;
mod maps;
mod mirrors;
mod needed_steps;
mod normals;
mod pace;
mod pass_constants;
mod pipeline_cache;
mod pipelines;
mod plan_likeness;
mod pool;
mod rays;
mod readback;
mod result_key;
mod run;
mod run_options;
mod run_result;
mod shaders;
mod shares;
mod shown_maps;
mod shown_tiles;
mod source_canvas;
mod source_constants;
mod source_fill;
mod source_shader;
mod stencils;
mod surface;
mod survey;
mod tables;
mod texture_budget;
mod tile_set;
mod tiles;
mod uploads;
mod waiting;

pub use adapter::{AdapterChoice, AdapterKind, AdapterSummary, adapters, choose_adapter, device_descriptor};
pub use anisotropy::read_anisotropy;
pub use borders::{BorderGhost, BorderKind, Borders};
pub use cache::ResultCache;
pub use device::Gpu;
pub use error::GpuError;
pub use extents::{ValueExtent, result_extents, texture_extents};
pub use levels::{CellLevel, CoarseSurface, PointSurface, Surfaces};
pub use made_map::ResultsIdentity;
pub use maps::{DeviceMaps, MaterialSlots};
pub use mirrors::mirrors;
pub use normals::Normals;
pub use pipelines::shader_module;
pub use pool::{DEFAULT_BUDGET_BYTES, PoolReport};
pub use rays::{CasterChoice, DeviceHierarchy, Hits, RayScene};
pub use readback::bands::{BandData, read_slot_in_bands};
pub use readback::{PlaneData, read_layer, read_numbers, read_slot, read_texels};
pub use result_key::ResultKey;
pub use run::run_plan;
pub use run_options::{DEFAULT_KEEPS_FROM, DEFAULT_WRITES_OVER_FROM, RunOptions};
pub use run_result::{Run, RunReport, StepTime};
pub use shaders::fixed_modules;
pub use shares::{Mean, Shares};
pub use shown_maps::{Exported, ShownMaps};
pub use shown_tiles::ShownTiles;
pub use source_canvas::{DeviceTable, SourceCanvas, SourceDraw};
pub use source_constants::{
    COORDINATE_ROWS, COORDINATE_ROWS_WITH_TANGENTS, COPY_ROWS, CORNER_ROWS, DirectionConstants, ImageConstants,
    NO_CHANNEL, PictureConstants, ProjectionConstants, TextureConstants, TexturesConstants,
};
pub use source_fill::SourceFill;
pub use source_shader::{ImageShader, PartRows, PictureStorage, ProjectionWay, SourceShader, TEXTURES};
pub use surface::{GpuSurface, Measures};
pub use tables::SurfaceTables;
pub use texture_budget::TextureBudget;
pub use tile_set::{TileSet, tile_of};
