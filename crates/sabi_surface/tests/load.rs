//! Tests of loading models: every layout, the message of every fault, and that no file causes a panic.

#![allow(clippy::unwrap_used, reason = "a test that cannot make its input has failed")]
#![allow(clippy::print_stdout, reason = "tests say what they left out")]

#[path = "load/arealess.rs"]
mod arealess;
#[path = "load/builder.rs"]
mod builder;
#[path = "load/completion.rs"]
mod completion;
#[path = "load/dae.rs"]
mod dae;
#[path = "load/draco.rs"]
mod draco;
#[path = "load/face_reversal.rs"]
mod face_reversal;
#[path = "load/far.rs"]
mod far;
#[path = "load/faults.rs"]
mod faults;
#[path = "load/fbx.rs"]
mod fbx;
#[path = "load/fbx_builder.rs"]
mod fbx_builder;
#[path = "load/fbx_looks.rs"]
mod fbx_looks;
#[path = "load/files.rs"]
mod files;
#[path = "load/fuzz.rs"]
mod fuzz;
#[path = "load/layouts.rs"]
mod layouts;
#[path = "load/materials.rs"]
mod materials;
#[path = "load/meshopt.rs"]
mod meshopt;
#[path = "load/numbers.rs"]
mod numbers;
#[path = "load/obj.rs"]
mod obj;
#[path = "load/obj_library.rs"]
mod obj_library;
#[path = "load/oracle.rs"]
mod oracle;
#[path = "load/origins.rs"]
mod origins;
#[path = "load/packed_quad.rs"]
mod packed_quad;
#[path = "load/parts.rs"]
mod parts;
#[path = "load/placement.rs"]
mod placement;
#[path = "load/ply.rs"]
mod ply;
#[path = "load/promises.rs"]
mod promises;
#[path = "load/quantized_uvs.rs"]
mod quantized_uvs;
#[path = "load/referenced_files.rs"]
mod referenced_files;
#[path = "load/repairs.rs"]
mod repairs;
#[path = "load/shared_data.rs"]
mod shared_data;
#[path = "load/skins.rs"]
mod skins;
#[path = "load/smoothing.rs"]
mod smoothing;
#[path = "load/stl.rs"]
mod stl;
#[path = "load/storage.rs"]
mod storage;
