#![no_main]

#[path = "../bodies/strokes.rs"]
mod strokes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| strokes::survives(bytes));
