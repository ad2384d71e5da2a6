#![no_main]

#[path = "../bodies/parts.rs"]
mod parts;
#[path = "../bodies/paths.rs"]
mod paths;
#[path = "../../crates/sabi_surface/tests/load/promises.rs"]
mod promises;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| paths::survives(bytes));
