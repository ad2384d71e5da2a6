//! Any bytes are a whole model or a fault. What follows a line of five dashes is the material library.
#![no_main]

#[path = "../../crates/sabi_surface/tests/load/promises.rs"]
mod promises;

use libfuzzer_sys::fuzz_target;
use sabi_surface::load::{LoadOptions, load_bytes};

const BREAK: &[u8] = b"\n-----\n";

fuzz_target!(|bytes: &[u8]| {
    let cut = bytes.windows(BREAK.len()).position(|window| window == BREAK);
    let (file, library) = cut.map_or((bytes, &[][..]), |at| (&bytes[..at], &bytes[at + BREAK.len()..]));
    let mut resolve = |_: &str| Ok(library.to_vec());
    if let Ok(model) = load_bytes("model.obj", file, &mut resolve, &LoadOptions::default()) {
        promises::check(&model);
    }
});
