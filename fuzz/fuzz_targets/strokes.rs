#![no_main]

#[path = "../bodies/square.rs"]
mod square;
#[path = "../bodies/strokes.rs"]
mod strokes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| strokes::survives(bytes));
