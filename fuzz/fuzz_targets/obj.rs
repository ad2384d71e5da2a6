#![no_main]

#[path = "../bodies/model.rs"]
mod model;
#[path = "../bodies/parts.rs"]
mod parts;
#[path = "../../crates/sabi_surface/tests/load/promises.rs"]
mod promises;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| model::survives_as_obj(bytes));
