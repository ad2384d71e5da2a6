//! Any bytes are a whole model or a fault. What follows a line of five dashes is the buffer beside a `.gltf`.
#![no_main]

#[path = "../../crates/sabi_surface/tests/load/promises.rs"]
mod promises;

use libfuzzer_sys::fuzz_target;
use sabi_surface::load::{LoadOptions, load_bytes};

const BREAK: &[u8] = b"\n-----\n";

fuzz_target!(|bytes: &[u8]| {
    let is_binary = bytes.starts_with(b"glTF");
    let cut = bytes.windows(BREAK.len()).position(|window| window == BREAK);
    let (file, beside) = match cut.filter(|_| !is_binary) {
        Some(at) => (&bytes[..at], &bytes[at + BREAK.len()..]),
        None => (bytes, &[][..]),
    };
    let name = if is_binary { "model.glb" } else { "model.gltf" };
    let mut resolve = |_: &str| Ok(beside.to_vec());
    if let Ok(model) = load_bytes(name, file, &mut resolve, &LoadOptions::default()) {
        promises::check(&model);
    }
});
