#![no_main]

#[path = "../bodies/recovery.rs"]
mod recovery;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| recovery::survives(bytes));
